"""Dormand-Prince of order 8(5,3) with variable step, each accepted step projected twice onto the constraints.

    k_s = f(t + c_s h, y + h sum A_sj k_j)        s = 1 .. 12
    y1  = y + h sum B_s k_s,   then q and v are projected
    err = h |e5|^2 / sqrt((|e5|^2 + 0.01 |e3|^2) n),   e5 = sum E5_s k_s,  e3 = sum E3_s k_s
    h  *= 0.9 err^(-1/8), within 0.2 .. 10

Outputs come from the method's own interpolant of order 7 (three evaluations more, in steps that hold an output), and
are projected too. A step whose projection does not contract is taken again with half the length.

Source: Hairer, Norsett, Wanner, Solving ODEs I, II.4 to II.6; the two projections: see projection.py.
"""

from __future__ import annotations

import math

from mbsd.dynamics.acceleration import accelerate, derivative
from mbsd.dynamics.projection import project
from mbsd.integrators.dop853_tableau import E3, E5, A, B, C, D
from mbsd.integrators.kind import Integrator, register
from mbsd.integrators.state import (
    ACCEPTED,
    EVALUATIONS,
    NEXT,
    NOT_FINITE,
    PAUSED,
    POWER,
    REACHED,
    REJECTED,
    STEP,
    STEP_TOO_SMALL,
    TIME,
    WORK,
    begin,
    record,
    record_here,
)
from mbsd.integrators.step_size import allowed, first_step
from mbsd.jit import inlined, kernel

STAGES = 16
SMALLEST_STEP = 1e-13
"""Part of the longest step at which a run gives up."""

CONTRACTION = 0.1
"""The second projection must change the pose by less than this part of the first."""
ROUNDING = 1e-9
"""Changes below this (sizes, rad) are rounding in an ill-conditioned pose, and accepted."""


@kernel
def _interpolant(dyn, scratch, state, h, work):
    """Coefficients of the dense output of the step that ends in scratch.state and does ``work`` (J)."""
    power = scratch.power
    k = scratch.stages
    dense = scratch.dense
    n3 = state.y.shape[1]
    t = state.clock[TIME]
    for part in range(2):
        for c in range(3, n3):
            rise = scratch.state[part, c] - state.y[part, c]
            dense[0, part, c] = rise
            dense[1, part, c] = h * k[0, part, c] - rise
            dense[2, part, c] = 2.0 * rise - h * (k[12, part, c] + k[0, part, c])
    for s in range(13, 16):
        for part in range(2):
            for c in range(3, n3):
                change = 0.0
                for j in range(s):
                    change += A[s, j] * k[j, part, c]
                dense[7, part, c] = state.y[part, c] + h * change
        power[s] = derivative(dyn, scratch, t + C[s] * h, dense[7], k[s], scratch.ws.right[1])
    for row in range(4):
        for part in range(2):
            for c in range(3, n3):
                change = 0.0
                for j in range(16):
                    change += D[row, j] * k[j, part, c]
                dense[3 + row, part, c] = h * change
        change = 0.0
        for j in range(16):
            change += D[row, j] * power[j]
        scratch.dense_work[3 + row] = h * change
    scratch.dense_work[0] = work
    scratch.dense_work[1] = h * power[0] - work
    scratch.dense_work[2] = 2.0 * work - h * (power[12] + power[0])


@inlined
def _interpolate(scratch, state, x):
    """scratch.state at the part x of the step whose coefficients stand in scratch.dense; returns the work so far."""
    dense = scratch.dense
    for part in range(2):
        for c in range(3, state.y.shape[1]):
            value = 0.0
            for row in range(6, -1, -1):
                value += dense[row, part, c]
                value *= x if row % 2 == 0 else 1.0 - x
            scratch.state[part, c] = state.y[part, c] + value
    work = 0.0
    for row in range(6, -1, -1):
        work = (work + scratch.dense_work[row]) * (x if row % 2 == 0 else 1.0 - x)
    return work


@kernel
def advance(dyn, scratch, state, out, settings, end, max_steps):
    """Go on to ``end`` (s), ``max_steps`` accepted steps at most, writing the outputs passed. Returns a status."""
    y = state.y
    k = scratch.stages
    trial = scratch.state
    n3 = y.shape[1]
    count = max(2 * (n3 - 3), 1)
    begin(dyn, scratch, state)
    if state.clock[STEP] == 0.0:
        state.clock[STEP] = first_step(dyn, scratch, state, settings, 0.125)
    while state.count[NEXT] < out.t.shape[0] and out.t[state.count[NEXT]] <= state.clock[TIME]:
        record_here(scratch, state, out)
    for c in range(3, n3):
        k[0, 0, c] = state.dy[0, c]
        k[0, 1, c] = state.dy[1, c]
    scratch.power[0] = state.clock[POWER]
    accepted = 0
    rejected = False
    while state.clock[TIME] < end:
        if accepted == max_steps:
            return PAUSED
        t = state.clock[TIME]
        h = min(state.clock[STEP], settings.longest)
        last = t + h >= end
        if last:
            h = end - t
        elif h < SMALLEST_STEP * settings.longest:
            return STEP_TOO_SMALL
        for s in range(1, 12):
            for part in range(2):
                for c in range(3, n3):
                    trial[part, c] = A[s, 0] * k[0, part, c]
                for j in range(1, s):
                    factor = A[s, j]
                    if factor != 0.0:
                        for c in range(3, n3):
                            trial[part, c] += factor * k[j, part, c]
                for c in range(3, n3):
                    trial[part, c] = y[part, c] + h * trial[part, c]
            for c in range(3, n3):
                k[s, 0, c] = trial[1, c]
            scratch.power[s] = accelerate(dyn, scratch, t + C[s] * h, trial, k[s, 1], scratch.ws.right[1])
        work = 0.0
        for s in range(12):
            work += h * B[s] * scratch.power[s]
        fifth = 0.0
        third = 0.0
        for part in range(2):
            for c in range(3, n3):
                change = 0.0
                e5 = 0.0
                e3 = 0.0
                for s in range(12):
                    change += B[s] * k[s, part, c]
                    e5 += E5[s] * k[s, part, c]
                    e3 += E3[s] * k[s, part, c]
                trial[part, c] = y[part, c] + h * change
                scale = allowed(settings, y, trial, part, c)
                fifth += (e5 / scale) ** 2
                third += (e3 / scale) ** 2
        error = 0.0
        if fifth > 0.0 or third > 0.0:
            error = h * fifth / math.sqrt((fifth + 0.01 * third) * count)
        state.count[EVALUATIONS] += 11
        if not error < 1.0:
            if h < SMALLEST_STEP * settings.longest:
                return NOT_FINITE
            state.clock[STEP] = h * (max(0.2, 0.9 * error**-0.125) if math.isfinite(error) else 0.2)
            state.count[REJECTED] += 1
            rejected = True
            continue
        project(dyn, scratch, t + h, trial, 2)
        if not scratch.report[2] <= max(CONTRACTION * scratch.report[1], ROUNDING):
            if h < SMALLEST_STEP * settings.longest:
                return NOT_FINITE
            state.clock[STEP] = 0.5 * h
            state.count[REJECTED] += 1
            rejected = True
            continue
        reached = end if last else t + h
        scratch.power[12] = derivative(dyn, scratch, reached, trial, k[12], state.lam)
        state.count[EVALUATIONS] += 1
        margin = scratch.report[0]
        for c in range(3, n3):
            state.dy[0, c] = k[12, 0, c]
            state.dy[1, c] = k[12, 1, c]
        following = state.count[NEXT]
        if following < out.t.shape[0] and out.t[following] < reached:
            _interpolant(dyn, scratch, state, h, work)
            state.count[EVALUATIONS] += 3
            for part in range(2):  # record and the interpolant use trial: the end of the step waits in dense[7]
                for c in range(3, n3):
                    scratch.dense[7, part, c] = y[part, c] + scratch.dense[0, part, c]
            while following < out.t.shape[0] and out.t[following] < reached:
                x = (out.t[following] - t) / h
                so_far = _interpolate(scratch, state, x)
                record(dyn, scratch, out, following, state.clock[WORK] + so_far)
                following += 1
                state.count[NEXT] = following
            for part in range(2):
                for c in range(3, n3):
                    trial[part, c] = scratch.dense[7, part, c]
        for part in range(2):
            for c in range(3, n3):
                y[part, c] = trial[part, c]
                k[0, part, c] = state.dy[part, c]
        state.clock[TIME] = reached
        state.clock[WORK] += work
        state.clock[POWER] = scratch.power[12]
        scratch.power[0] = scratch.power[12]
        scratch.report[0] = margin
        if following < out.t.shape[0] and out.t[following] <= reached:
            record_here(scratch, state, out)
        growth = min(10.0, 0.9 * error**-0.125) if error > 0.0 else 10.0
        if rejected:
            growth = min(growth, 1.0)
        if not last or growth < 1.0:
            state.clock[STEP] = min(h * growth, settings.longest)
        rejected = False
        accepted += 1
        state.count[ACCEPTED] += 1
    return REACHED


DOP853 = register(Integrator("dop853", advance, STAGES, order=8, fixed_step=False))
