"""The loops of the integrators behind one name, by number; each but the usual one is compiled when it is first called.

In independent coordinates there is the usual one alone.
"""

from __future__ import annotations

from mbsd.compiling.alternatives import alternatives
from mbsd.compiling.jit import inlined, lazy
from mbsd.dynamics.embedding.arrays import Embedding
from mbsd.dynamics.integrators import baumgarte, generalized_alpha, rattle, rk4, symplectic
from mbsd.dynamics.integrators.dop853.loop import DOP853
from mbsd.dynamics.integrators.dop853.loop import advance as advance_dop853
from mbsd.dynamics.integrators.kind import Integrator
from mbsd.dynamics.integrators.radau import loop as radau
from mbsd.dynamics.reference.arrays import Dynamics

INTEGRATORS = (
    DOP853, rk4.RK4, baumgarte.BAUMGARTE, rattle.RATTLE, symplectic.SYMPLECTIC, generalized_alpha.GENERALIZED_ALPHA,
    radau.RADAU,
)  # fmt: skip
USUAL, BY_RK4, BY_BAUMGARTE, BY_RATTLE, BY_SYMPLECTIC, BY_GENERALIZED_ALPHA, BY_RADAU = range(len(INTEGRATORS))
PAUSED_ANYWHERE = (DOP853, rk4.RK4, baumgarte.BAUMGARTE)
"""Those whose steps are the same wherever they pause; the others begin their search for a matrix or a step anew."""

advance_rk4, advance_baumgarte, advance_rattle = rk4.advance, baumgarte.advance, rattle.advance
advance_symplectic, advance_alpha, advance_radau = symplectic.advance, generalized_alpha.advance, radau.advance


def number_of(integrator: Integrator) -> int | None:
    """The number of an integrator, or None where it has no loop here."""
    return INTEGRATORS.index(integrator) if integrator in INTEGRATORS else None


@lazy(int)
def later_rk4(dyn, scratch, state, out, settings, end, most):
    """``advance``."""
    return advance_rk4(dyn, scratch, state, out, settings, end, most)


@lazy(int)
def later_baumgarte(dyn, scratch, state, out, settings, end, most):
    """``advance``."""
    return advance_baumgarte(dyn, scratch, state, out, settings, end, most)


@lazy(int)
def later_rattle(dyn, scratch, state, out, settings, end, most):
    """``advance``."""
    return advance_rattle(dyn, scratch, state, out, settings, end, most)


@lazy(int)
def later_symplectic(dyn, scratch, state, out, settings, end, most):
    """``advance``."""
    return advance_symplectic(dyn, scratch, state, out, settings, end, most)


@lazy(int)
def later_alpha(dyn, scratch, state, out, settings, end, most):
    """``advance``."""
    return advance_alpha(dyn, scratch, state, out, settings, end, most)


@lazy(int)
def later_radau(dyn, scratch, state, out, settings, end, most):
    """``advance``."""
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


advance = alternatives({Dynamics: _by_number, Embedding: _usual})
"""advance(dyn, scratch, state, out, settings, end, most, method): as an integrator's own, with its number behind."""
