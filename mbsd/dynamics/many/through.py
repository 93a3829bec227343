"""Steps from stop to stop: they end where loads or laws jump, and go on after, as prepare/stops.py has it."""

from __future__ import annotations

from mbsd.compiling.jit import internal
from mbsd.dynamics.many.methods import advance
from mbsd.dynamics.state import ACCEPTED, PAUSED, REACHED, STARTED, STEP, TIME

NO_LIMIT = 10**12


@internal
def next_stop(before, t):
    """The first stop after the time t; as many as there are if there is none."""
    low = 0
    high = before.shape[0]
    while low < high:
        middle = (low + high) // 2
        if before[middle] <= t:
            low = middle + 1
        else:
            high = middle
    return low


@internal
def copy_state(target, source):
    """Make ``target`` the state ``source``."""
    for part in range(2):
        for c in range(source.y.shape[1]):
            target.y[part, c] = source.y[part, c]
            target.dy[part, c] = source.dy[part, c]
            target.memory[part, c] = source.memory[part, c]
    for r in range(source.lam.shape[0]):
        target.lam[r] = source.lam[r]
    for i in range(source.clock.shape[0]):
        target.clock[i] = source.clock[i]
        target.count[i] = source.count[i]


@internal
def cross(state, before, after):
    """Go on after the jump right before which the state stands, if it stands there."""
    t = state.clock[TIME]
    k = next_stop(before, t) - 1
    if k >= 0 and before[k] == t and t < after[k]:
        state.clock[TIME] = after[k]
        state.clock[STEP] = 0.0
        state.count[STARTED] = 0


@internal
def through(dyn, scratch, state, out, settings, end, steps, before, after, method):
    """``advance`` from stop to stop, by the integrator of this number (methods.py)."""
    while True:
        if state.clock[TIME] < end:
            cross(state, before, after)
        k = next_stop(before, state.clock[TIME])
        if k == before.shape[0] or before[k] >= end:
            return advance(dyn, scratch, state, out, settings, end, steps, method)
        taken = state.count[ACCEPTED]
        ended = advance(dyn, scratch, state, out, settings, before[k], steps, method)
        steps -= state.count[ACCEPTED] - taken
        if ended != REACHED or steps <= 0:
            return PAUSED if ended == REACHED else ended
