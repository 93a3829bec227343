"""Dormand-Prince of order 8(5,3) with variable step, each accepted step projected twice onto the constraints.

    k_s = f(t + c_s h, y + h sum A_sj k_j)        s = 1 .. 12
    y1  = y + h sum B_s k_s,   then q and v are projected
    err = h |e5|^2 / sqrt((|e5|^2 + 0.01 |e3|^2) n),   e5 = sum E5_s k_s,  e3 = sum E3_s k_s
    h  *= 0.7 err^(-0.117) err_0^0.04, within 0.2 .. 10;    err_0 of the step before

Outputs come from the method's own interpolant of order 7 (three evaluations more, in steps that hold an output), and
are projected too. A step whose projection does not contract is taken again with half the length.

Source: Hairer, Norsett, Wanner, Solving ODEs I, II.4 to II.6; the two projections: see projection.py.
"""

from __future__ import annotations

import math

from mbsd.compiling.jit import inlined, shared
from mbsd.dynamics import state as run_state
from mbsd.dynamics.formulation import accelerate, begin_run, derivative, project, rates, record_here, settle
from mbsd.dynamics.integrators.dop853.crossing import LANDED, crossing, nearness
from mbsd.dynamics.integrators.dop853.dense import interpolant, write_outputs
from mbsd.dynamics.integrators.dop853.sums import sum_stages, sum_step
from mbsd.dynamics.integrators.dop853.tableau import B, C
from mbsd.dynamics.integrators.kind import Integrator, register
from mbsd.dynamics.integrators.step_size import first_step
from mbsd.equations.interactions import switching

STAGES = 17
EXPONENT = 0.125
SAFETY, BETA = 0.7, 0.04
"""Constants of a cautious step-size control: a rejected step costs eleven evaluations, more than longer steps save."""
SMALL = -9.0
"""Logarithm of the least error that steers the next steps."""
UNCLEAR_STEP = 0.7
"""How a step is shortened within which independent coordinates have no clear pose."""
CONTRACTION = 0.1
"""The second projection must change the pose by less than this part of the first."""
ROUNDING = 1e-9
"""Changes below this (sizes, rad) are rounding in an ill-conditioned pose, and accepted."""


@inlined
def take_rates(state, scratch):
    """Keep derivative and multipliers at the end of the step."""
    for c in range(3, state.dy.shape[1]):
        state.dy[0, c] = scratch.stages[12, 0, c]
        state.dy[1, c] = scratch.stages[12, 1, c]
    for r in range(state.lam.shape[0]):
        state.lam[r] = scratch.multipliers[r]


@inlined
def take_state(state, scratch, reached, work):
    """Go on to the end of the step."""
    for part in range(2):
        for c in range(3, state.y.shape[1]):
            state.y[part, c] = scratch.state[part, c]
            scratch.stages[0, part, c] = state.dy[part, c]
    state.clock[run_state.TIME] = reached
    state.clock[run_state.WORK] += work
    state.clock[run_state.POWER] = scratch.power[12]
    scratch.power[0] = scratch.power[12]


@inlined
def choose_step(state, settings, h, error, rejected, last):
    """Choose the length of the next step from the errors of this one and the one before."""
    growth = 10.0
    if error > 0.0:
        growth = math.log(error)
        before = state.clock[run_state.ERROR] if state.clock[run_state.ERROR] < 0.0 else growth
        state.clock[run_state.ERROR] = max(growth, SMALL)
        growth = min(10.0, SAFETY * math.exp(BETA * before - (EXPONENT - 0.2 * BETA) * growth))
    if rejected:
        growth = min(growth, 1.0)
    if not last or growth < 1.0:
        state.clock[run_state.STEP] = min(h * growth, settings.longest)


@inlined
def start(dyn, scratch, state, out, settings, is_switching):
    """Evaluate the state at a start or restart, choose a first step, and write the outputs that stand at its time."""
    y = state.y
    k = scratch.stages
    switch = dyn.loads.switch
    switching.begin_sides(switch, state.clock[run_state.TIME], state.count[run_state.STARTED] != 0)
    begin_run(dyn, scratch, state)
    if is_switching and switch[0, switching.REMEMBERS] > 0.0 and switch[0, switching.FREE] > 0.0:
        derivative(dyn, scratch, state.clock[run_state.TIME], y, k[LANDED], scratch.multipliers)
        state.count[run_state.EVALUATIONS] += 1
        switching.note_begin(switch)
    if state.clock[run_state.STEP] == 0.0:
        state.clock[run_state.STEP] = first_step(dyn, scratch, state, settings, 0.125)
    while (
        state.count[run_state.NEXT] < out.t.shape[0]
        and out.t[state.count[run_state.NEXT]] <= state.clock[run_state.TIME]
    ):
        record_here(dyn, scratch, state, out)
    for c in range(3, y.shape[1]):
        k[0, 0, c] = state.dy[0, c]
        k[0, 1, c] = state.dy[1, c]
    scratch.power[0] = state.clock[run_state.POWER]


@inlined
def stages(dyn, scratch, state, settings, t, h, reached):
    """Evaluate a step; its end is left in scratch.state, projected.

    Returns the part of h that the next try may have (1 where the step stands), the error relative to what is allowed,
    and the work of loads and drivers (J).
    """
    y = state.y
    k = scratch.stages
    trial = scratch.state
    error = 0.0
    work = 0.0
    shorter = 1.0
    for s in range(1, 13):
        if s < 12:
            sum_stages(y, k, s, h, trial)
        else:
            for j in range(12):
                work += h * B[j] * scratch.power[j]
            error = sum_step(y, k, h, settings, trial)
            if not error < 1.0:
                shorter = max(0.2, SAFETY * error**-EXPONENT) if math.isfinite(error) else 0.2
                break
            project(dyn, scratch, reached, trial, 2)
            if not scratch.report[2] <= max(CONTRACTION * scratch.report[1], ROUNDING):
                shorter = 0.5
                break
        rates(dyn, trial[0], trial[1], k[s, 0])
        state.count[run_state.EVALUATIONS] += 1
        at = t + C[s] * h if s < 12 else reached
        scratch.power[s] = accelerate(dyn, scratch, at, trial, k[s, 1], scratch.multipliers)
        if scratch.power[s] != scratch.power[s]:
            shorter = UNCLEAR_STEP
            break
    return shorter, error, work


@inlined
def outputs_passed(dyn, scratch, state, out, h, reached):
    """Write the outputs within the step; returns whether their poses are clear."""
    trial = scratch.state
    waiting = scratch.dense[7]  # recording uses scratch.state, so that the end of the step waits here
    for part in range(2):
        for c in range(3, trial.shape[1]):
            waiting[part, c] = state.y[part, c] + scratch.dense[0, part, c]
    clear = write_outputs(dyn, scratch, state, out, h, reached)
    for part in range(2):
        for c in range(3, trial.shape[1]):
            trial[part, c] = waiting[part, c]
    return clear


@shared
def advance(dyn, scratch, state, out, settings, end, max_steps):
    """Go on to ``end`` (s), ``max_steps`` accepted steps at most, writing the outputs passed. Returns a status."""
    switch = dyn.loads.switch
    is_switching = switch[0, switching.SWITCHING] > 0.0
    start(dyn, scratch, state, out, settings, is_switching)
    accepted = 0
    rejected = False
    while state.clock[run_state.TIME] < end:
        if accepted == max_steps:
            return run_state.PAUSED
        t = state.clock[run_state.TIME]
        h = min(state.clock[run_state.STEP], settings.longest)
        last = t + h >= end
        if last:
            h = end - t
        elif h < settings.smallest:
            return run_state.STEP_TOO_SMALL
        reached = end if last else t + h
        if is_switching:
            switching.hold(switch, nearness(switch, settings))
        shorter, error, work = stages(dyn, scratch, state, settings, t, h, reached)
        landed = False
        if is_switching:
            switch[0, switching.HELD] = 0.0
            if shorter == 1.0 and (switch[0, switching.BEYOND] < math.inf or switch[0, switching.CUTS] > 0.0):
                shorter = crossing(dyn, scratch, state, settings, h, reached, work)
                switch[0, switching.HELD] = 0.0
            landed = shorter > 1.0
            switching.note_end(switch)
        margin = scratch.report[0]
        fresh = True
        if shorter >= 1.0:
            take_rates(state, scratch)
            following = state.count[run_state.NEXT]
            if following < out.t.shape[0] and out.t[following] < reached:
                fresh = False
                state.count[run_state.EVALUATIONS] += 3
                if is_switching:
                    switch[0, switching.HELD] = 1.0
                interpolant(dyn, scratch, state, h, work)
                switch[0, switching.HELD] = 0.0
                if scratch.dense_work[3] != scratch.dense_work[3]:
                    shorter = UNCLEAR_STEP
                elif not outputs_passed(dyn, scratch, state, out, h, reached):
                    return run_state.UNCLEAR
        if shorter < 1.0:
            if h < settings.smallest:
                return run_state.NOT_FINITE
            state.clock[run_state.STEP] = h * shorter
            state.count[run_state.REJECTED] += 1
            rejected = True
            continue
        if is_switching:
            switching.accept(switch, reached)
            if landed:
                scratch.power[12] = scratch.power[LANDED]
                for c in range(3, state.y.shape[1]):
                    state.dy[1, c] = scratch.stages[LANDED, 1, c]
        take_state(state, scratch, reached, work)
        scratch.report[0] = margin
        following = state.count[run_state.NEXT]
        if following < out.t.shape[0] and out.t[following] <= reached:
            record_here(dyn, scratch, state, out)
            fresh = False
        other = settle(dyn, scratch, reached, scratch.state, fresh)
        choose_step(state, settings, h, error, rejected, last)
        if landed:
            state.clock[run_state.STEP] = switch[0, switching.RATE]
            state.clock[run_state.ERROR] = 0.0
        rejected = False
        accepted += 1
        state.count[run_state.ACCEPTED] += 1
        if other:
            return run_state.CHOOSE
    return run_state.REACHED


DOP853 = register(
    Integrator(
        "dop853", advance, STAGES, order=8, fixed_step=False, independent=True, general=True, meets_switches=True
    )
)
