"""Steps that end where forces have kinks or jumps: how far a step goes until the first of them, and the step after it.

While a step is tried, each interaction stays on the side of its switch on which it began (switching.py), so that the
step is smooth and its error estimate is that of a smooth motion. Where one went beyond, the place is found on the dense
output, and the step is taken again up to there. An accepted step was never beyond by more than what rounding does, or
where it ends by what does not matter: then its force was what its law says. A switch that cannot be met, because it is
at the very start or moves while it is looked for, is passed with no interaction held, as methods without switches do.
"""

from __future__ import annotations

import math

from mbsd.compiling.jit import inlined, internal, lazy
from mbsd.dynamics.formulation import bends, derivative
from mbsd.dynamics.integrators.dop853.dense import interpolant, interpolate
from mbsd.dynamics.integrators.root_search import narrowed, next_part
from mbsd.dynamics.integrators.step_size import allowed
from mbsd.dynamics.state import EVALUATIONS, TIME
from mbsd.equations.interactions import switching

LANDED = 16
"""Row of the stages for the derivative right after a switch."""
WIDE = 1e-2
"""Part of the tolerance by which a step may end beyond a switch, in sizes, where that does not matter."""
SHORT = 1e-1
"""Part of the tolerance by which it may end before, in sizes."""
MATTERS = 1e-2
"""Part of the tolerance by which a jump of the force until then may change velocities."""
MOST_CUTS = 4
UNCLEAR_STEP = 0.7
WITHOUT = 0.5
"""How a step is shortened in which no interaction is held."""
MOST_LOOKS = 60
ROUNDING = 1e-15
"""Rounding, relative to the time: a switch is not found closer than this."""
UNSEEN = 1e3
"""Change of the velocity, in tolerances, in a first step that does not matter; its error is 1e-4 of it."""
REACH = 6.0
"""The step after a switch is this, times the eighth root of the tolerance, over the frequency felt along the motion."""


@inlined
def nearness(switch, settings):
    """Return how far (m) beyond a switch the next step may go."""
    if switch[0, switching.CUTS] == 1.0:
        return max(switching.TIGHT, WIDE * settings.relative) * switch[0, switching.SIZE]
    return switching.TIGHT * switch[0, switching.SIZE]


@inlined
def step_after(dyn, scratch, state, settings, t):
    """Step (s) that suits the stiffness felt along the motion, from the trial state, whose derivative is in row LANDED.

    Frequencies are those of accelerations that change with the way. Where a force begins with a power that is no whole
    number, the error estimate does not tell the first step's error, and the step is so short that it does not matter.
    """
    switch = dyn.loads.switch
    y = scratch.state
    trial = scratch.dense[7]
    gain = scratch.stages[LANDED]
    changed = scratch.stages[15]
    bend_of = scratch.dense[6, 0]
    bends(dyn, y, gain, bend_of)
    reach = REACH * settings.relative**0.125
    h = settings.longest
    wanted = h
    bend = 0.0
    for _ in range(4):
        way = 0.0
        bend = 0.0
        for c in range(3, y.shape[1]):
            trial[0, c] = y[0, c] + h * (gain[0, c] + 0.5 * h * bend_of[c])
            trial[1, c] = y[1, c] + h * gain[1, c]
            way += ((trial[0, c] - y[0, c]) / settings.absolute[0, c]) ** 2
        power = derivative(dyn, scratch, t + h, trial, changed, scratch.multipliers)
        state.count[EVALUATIONS] += 1
        for c in range(3, y.shape[1]):
            bend += ((changed[1, c] - gain[1, c]) / settings.absolute[1, c]) ** 2
        if power != power or not math.isfinite(bend):
            bend = 0.0
            h *= 0.1
            wanted = h
            continue
        wanted = settings.longest
        if bend > 0.0:
            wanted = min(wanted, reach * (way / bend) ** 0.25)
        if wanted > 0.5 * h:
            break
        h = max(wanted, 1e-4 * h)
    wanted = min(wanted, 2.0 * h)
    rough = 0.0
    for row in range(1, switch.shape[0]):
        if switch[row, switching.LOOSE] == 2.0 and switch[row, switching.VALUE] > 0.0:
            rough = max(rough, switch[row, switching.ROUGH])
    if rough > 0.0 and bend > 0.0:
        wanted = min(wanted, h * (UNSEEN / (math.sqrt(bend) * h)) ** (1.0 / (rough + 1.0)))
    return min(wanted, settings.longest)


@internal
def _land(dyn, scratch, state, settings, reached, end):
    """Choose the sides on which the next step begins, where the step ends at a switch; the state is the one before."""
    switch = dyn.loads.switch
    trial = scratch.state
    k = scratch.stages
    tight = switching.TIGHT * switch[0, switching.SIZE]
    for row in range(1, switch.shape[0]):
        side = switch[row, switching.KEPT]
        value = switch[row, switching.VALUE]
        switch[row, switching.BEFORE] = side
        if side != 0.0 and -side * value >= min(end, 0.0):
            switch[row, switching.LOOSE] = 2.0
        switch[row, switching.KEPT] = 0.0
        if switch[row, switching.LOOSE] < 2.0 and abs(value) > tight:
            switch[row, switching.KEPT] = math.copysign(1.0, value)
    switch[0, switching.HELD] = 1.0
    switch[0, switching.RATE] = step_after(dyn, scratch, state, settings, reached)
    switch[0, switching.HELD] = 0.0
    for row in range(1, switch.shape[0]):
        switch[row, switching.KEPT] = switch[row, switching.BEFORE]
    derivative(dyn, scratch, reached, trial, k[LANDED], scratch.multipliers)
    state.count[EVALUATIONS] += 1


@internal
def _return_to_end(dyn, scratch, state, reached):
    """Evaluate the end of the step, at ``reached`` (s), once more."""
    trial = scratch.state
    for row in range(2):
        for column in range(3, trial.shape[1]):
            trial[row, column] = state.y[row, column] + scratch.dense[0, row, column]
    derivative(dyn, scratch, reached, trial, scratch.stages[LANDED], scratch.multipliers)
    state.count[EVALUATIONS] += 1
    dyn.loads.switch[0, switching.CUTS] = 0.0


@lazy(float)
def crossing(dyn, scratch, state, settings, h, reached, work):
    """Return the part below 1 of the tried step that is to be taken again; 1: all is well; 2: it ends at a switch.

    The state evaluated last is the step's end, before and, for 1 and 2, after.
    """
    switch = dyn.loads.switch
    trial = scratch.state
    k = scratch.stages
    n3 = trial.shape[1]
    t = state.clock[TIME]
    if h < settings.smallest:
        return 1.0
    end = switching.farthest(switch, switching.VALUE)
    first = switch[0, switching.BEYOND]
    cuts = switch[0, switching.CUTS]
    if cuts > 0.0 and first == math.inf:
        if end < -max(switching.TIGHT, SHORT * settings.relative) * switch[0, switching.SIZE]:
            return 1.0
        switch[0, switching.HELD] = 0.0
        scratch.power[LANDED] = derivative(dyn, scratch, reached, trial, k[LANDED], scratch.multipliers)
        state.count[EVALUATIONS] += 1
        jump = 0.0
        for c in range(3, n3):
            jump = max(jump, abs(k[LANDED, 1, c] - k[12, 1, c]) / allowed(settings, state.y, trial, 1, c))
        if end <= 0.0 or jump * end <= MATTERS * switch[0, switching.RATE]:
            _land(dyn, scratch, state, settings, reached, end)
            return 2.0
        first = reached
    if cuts >= MOST_CUTS:
        switch[0, switching.FREE] = 1.0
        switch[0, switching.CUTS] = 0.0
        return WITHOUT
    switch[0, switching.CUTS] = cuts + 1.0
    aim = 0.5 * nearness(switch, settings)
    if end > 0.0:
        aim = min(aim, 0.5 * end)
    switch[0, switching.HELD] = 1.0
    interpolant(dyn, scratch, state, h, work)
    state.count[EVALUATIONS] += 3
    if scratch.dense_work[3] != scratch.dense_work[3]:
        return UNCLEAR_STEP
    # between a and b lies the switch, c is the place before; Chandrupatla 1997, Adv. Eng. Softw. 28, 145
    a = 0.0
    fa = switching.farthest(switch, switching.HERE) - aim
    b = 1.0
    fb = end - aim
    looking = first < reached
    part = (first - t) / h
    if not looking:
        part = fa / (fa - fb)
    c = a
    fc = fa
    landing = -1.0
    for _ in range(MOST_LOOKS):
        x = a + part * (b - a)
        interpolate(scratch.dense, scratch.dense_work, state.y, x, trial)
        power = derivative(dyn, scratch, t + x * h, trial, k[LANDED], scratch.multipliers)
        state.count[EVALUATIONS] += 1
        if power != power:
            return UNCLEAR_STEP
        f = switching.farthest(switch, switching.VALUE) - aim
        if looking and not f > 0.0 and not fb > 0.0:  # a stage alone was beyond, not the motion
            _return_to_end(dyn, scratch, state, reached)
            return 1.0
        looking = False
        a, fa, b, fb, c, fc = narrowed(a, fa, b, fb, x, f)
        if abs(f) <= 0.9 * aim:
            landing = a
            break
        if abs(b - a) * h <= ROUNDING * abs(t):
            landing = a if fa > 0.0 else b
            break
        part = min(max(next_part(a, fa, b, fb, c, fc), 1e-9), 1.0 - 1e-9)
    switch[0, switching.RATE] = abs((fa - fc) / ((a - c) * h))
    if not 0.0 < landing < 1.0 or landing * h < max(settings.smallest, ROUNDING * abs(t)):
        switch[0, switching.FREE] = 1.0
        switch[0, switching.CUTS] = 0.0
        return WITHOUT
    return landing
