"""Rows of J one by one: velocities and forces along them, and the rows that events switch, measured alone.

    along   J_r u              push   force += size J_r^T

J is kept by rows: three entries for the body of each of a row's two sides.
"""

from __future__ import annotations

from mbsd.compiling.jit import internal, merged
from mbsd.equations.laws import evaluate_laws
from mbsd.equations.relative.equation import relative_rows
from mbsd.equations.system import place

OPENED_BY = 1e-7
"""Residuals (sizes, rad) above which a row that does not hold counts as open."""


@internal
def along(dyn, scratch, row, u):
    """Return a row of J times u (3 nb,), where scratch.ws.jac is."""
    out = 0.0
    for side in range(2):
        at = 3 * dyn.system.row_body[row, side]
        for c in range(3):
            out += scratch.ws.jac[row, 3 * side + c] * u[at + c]
    return out


@internal
def push(dyn, scratch, row, size, force):
    """Add a row of J^T, ``size`` times, to a force (3 nb,)."""
    for side in range(2):
        at = 3 * dyn.system.row_body[row, side]
        for c in range(3):
            force[at + c] += size * scratch.ws.jac[row, 3 * side + c]


@merged
def measure_gaps(dyn, scratch, t, q):
    """Fill scratch.ws.phi and scratch.ws.jac of the constraints of relative pose, which are all that events switch."""
    if scratch.drive.shape[0] > 1:
        evaluate_laws(dyn.laws, scratch.drive.shape[0], t, scratch.drive)
    place(dyn.system, q, scratch.ws)
    relative_rows(dyn.system, q, scratch.drive, scratch.ws)
