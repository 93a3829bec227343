"""Tolerances of a state's entries, and the first step: what methods with an error estimate share.

Source: Hairer, Norsett, Wanner, Solving ODEs I, II.4.
"""

from __future__ import annotations

import math

from mbsd.compiling.jit import apart, inlined
from mbsd.dynamics.formulation import derivative
from mbsd.dynamics.state import EVALUATIONS, TIME

WITHIN = 1e-3
"""The first step, as part of one that leads to where forces are not finite."""

SHORTEST = 1e-9
"""Part of the longest step that the first trial has at least: coordinates near zero tell nothing of a length."""


@inlined
def allowed(settings, before, after, part, c):
    """Return the tolerance of one entry of the state."""
    return settings.absolute[part, c] + settings.growing[part, c] * max(abs(before[part, c]), abs(after[part, c]))


@apart
def first_step(dyn, scratch, state, settings, exponent):
    """Step (s) that suits the first two derivatives; ``exponent`` is one by the order of the estimate plus one."""
    y = state.y
    trial = scratch.state
    n3 = y.shape[1]
    size = 0.0
    speed = 0.0
    for part in range(2):
        for c in range(3, n3):
            scale = allowed(settings, y, y, part, c)
            size += (y[part, c] / scale) ** 2
            speed += (state.dy[part, c] / scale) ** 2
    count = max(2 * (n3 - 3), 1)
    size = math.sqrt(size / count)
    speed = math.sqrt(speed / count)
    h = 1e-4 * settings.longest
    if size > 1e-5 and speed > 1e-5:
        h = min(max(0.01 * size / speed, SHORTEST * settings.longest), settings.longest)
    for part in range(2):
        for c in range(3, n3):
            trial[part, c] = y[part, c] + h * state.dy[part, c]
    derivative(dyn, scratch, state.clock[TIME] + h, trial, scratch.stages[0], scratch.multipliers)
    state.count[EVALUATIONS] += 1
    bend = 0.0
    for part in range(2):
        for c in range(3, n3):
            bend += ((scratch.stages[0, part, c] - state.dy[part, c]) / allowed(settings, y, y, part, c)) ** 2
    if not math.isfinite(bend):
        return min(WITHIN * h, settings.longest)
    steepest = max(speed, math.sqrt(bend / count) / h)
    step = (0.01 / steepest) ** exponent if steepest > 1e-15 else 100.0 * h
    return min(step if step == step else h, 100.0 * h, settings.longest)
