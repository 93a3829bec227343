"""How much of each row of J is new, as the pivots of the Schur complement tell; see large.py."""

from mbsd.dynamics.projection import project
from mbsd.dynamics.schur import factor_schur
from mbsd.jit import kernel


@kernel
def factor_at(dyn, scratch, t, state):
    """Factor at the pose of a state; the part of each row that is new stays in factors.low[k, 1:3]."""
    project(dyn, scratch, t, state, 1)
    factor_schur(dyn.schur, dyn.metric, scratch.ws.jac, scratch.factors, 0.0)
