"""Advance a state by the integrator of a number, with steps that end where loads or laws jump.

Each integrator but the usual one is compiled when it is first called; in independent coordinates there is the usual one
alone. A step ends right before a jump, and the next one begins right after it (prepare/stops.py).
"""

from __future__ import annotations

from mbsd.compiling.alternatives import alternatives
from mbsd.compiling.jit import inlined, internal, lazy
from mbsd.dynamics.independent.arrays import Embedding
from mbsd.dynamics.integrators import generalized_alpha, radau, rattle, rk4
from mbsd.dynamics.integrators.dop853.loop import DOP853
from mbsd.dynamics.integrators.dop853.loop import advance as advance_dop853
from mbsd.dynamics.integrators.kind import Integrator
from mbsd.dynamics.state import ACCEPTED, PAUSED, REACHED, STARTED, STEP, TIME

INTEGRATORS = (
    DOP853, rk4.RK4, rk4.BAUMGARTE, rattle.RATTLE, rattle.SYMPLECTIC, generalized_alpha.GENERALIZED_ALPHA,
    radau.RADAU,
)  # fmt: skip
USUAL, BY_RK4, BY_BAUMGARTE, BY_RATTLE, BY_SYMPLECTIC, BY_GENERALIZED_ALPHA, BY_RADAU = range(len(INTEGRATORS))
PAUSED_ANYWHERE = (DOP853, rk4.RK4, rk4.BAUMGARTE)
"""Integrators whose steps are the same wherever they pause; others look for a matrix or a step anew."""

advance_rk4, advance_baumgarte = rk4.advance, rk4.advance_baumgarte
advance_rattle, advance_symplectic = rattle.advance, rattle.advance_symplectic
advance_alpha, advance_radau = generalized_alpha.advance, radau.advance


def number_of(integrator: Integrator) -> int | None:
    """Return the number of an integrator, or None where it has no loop here."""
    return INTEGRATORS.index(integrator) if integrator in INTEGRATORS else None


@lazy(int)
def later_rk4(dyn, scratch, state, out, settings, end, most):
    """Advance by this method, compiled when it is first called."""
    return advance_rk4(dyn, scratch, state, out, settings, end, most)


@lazy(int)
def later_baumgarte(dyn, scratch, state, out, settings, end, most):
    """Advance by this method, compiled when it is first called."""
    return advance_baumgarte(dyn, scratch, state, out, settings, end, most)


@lazy(int)
def later_rattle(dyn, scratch, state, out, settings, end, most):
    """Advance by this method, compiled when it is first called."""
    return advance_rattle(dyn, scratch, state, out, settings, end, most)


@lazy(int)
def later_symplectic(dyn, scratch, state, out, settings, end, most):
    """Advance by this method, compiled when it is first called."""
    return advance_symplectic(dyn, scratch, state, out, settings, end, most)


@lazy(int)
def later_alpha(dyn, scratch, state, out, settings, end, most):
    """Advance by this method, compiled when it is first called."""
    return advance_alpha(dyn, scratch, state, out, settings, end, most)


@lazy(int)
def later_radau(dyn, scratch, state, out, settings, end, most):
    """Advance by this method, compiled when it is first called."""
    return advance_radau(dyn, scratch, state, out, settings, end, most)


@inlined
def _by_number(dyn, scratch, state, out, settings, end, most, method):
    if method == BY_RK4:
        ended = later_rk4(dyn, scratch, state, out, settings, end, most)
    elif method == BY_BAUMGARTE:
        ended = later_baumgarte(dyn, scratch, state, out, settings, end, most)
    elif method == BY_RATTLE:
        ended = later_rattle(dyn, scratch, state, out, settings, end, most)
    elif method == BY_SYMPLECTIC:
        ended = later_symplectic(dyn, scratch, state, out, settings, end, most)
    elif method == BY_GENERALIZED_ALPHA:
        ended = later_alpha(dyn, scratch, state, out, settings, end, most)
    elif method == BY_RADAU:
        ended = later_radau(dyn, scratch, state, out, settings, end, most)
    else:
        ended = advance_dop853(dyn, scratch, state, out, settings, end, most)
    return ended


@inlined
def _usual(dyn, scratch, state, out, settings, end, most, method):
    return advance_dop853(dyn, scratch, state, out, settings, end, most)


advance = alternatives({Embedding: _usual}, _by_number)
"""advance(dyn, scratch, state, out, settings, end, most, method): as an integrator's own, with its number behind."""


NO_LIMIT = 10**12


@internal
def next_stop(before, t):
    """Return the number of the first jump after the time t (s); as many as there are if there is none."""
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
def advance_past_jumps(dyn, scratch, state, out, settings, end, steps, before, after, method):
    """Call ``advance`` from jump to jump, by the integrator of this number (INTEGRATORS)."""
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
