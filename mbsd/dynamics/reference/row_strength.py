"""How much of each row of J is new, as the pivots of the Schur complement tell; see large.py."""

from mbsd.compiling.jit import kernel
from mbsd.dynamics.reference.projection import project
from mbsd.dynamics.reference.schur import factor_schur


@kernel
def factor_at(dyn, scratch, t, state):
    """Factor at the pose of a state; the part of each row that is new stays in factors.low[k, 1:3]."""
    project(dyn, scratch, t, state, 1)
    factor_schur(dyn.schur, dyn.metric, scratch.ws.jac, scratch.factors, 0.0)
