"""Projection of a state onto its constraints, and rows of J one by one.

It is the smallest change in the metric of the masses:

    q -= W^-1 J^T S^-1 Phi          v -= W^-1 J^T S^-1 (J v - nu),     S = J W^-1 J^T

Velocities and forces along rows, and those that events switch measured alone:

    along   J_r u              push   force += size J_r^T

J is kept by rows: three entries for the body of each of a row's two sides.

Source: Eich 1993, SIAM J. Numer. Anal. 30 (projection after each step); Hairer, Wanner, Solving ODEs II, VII.2.
"""

from __future__ import annotations

from mbsd.compiling.jit import apart, internal, kernel, merged, shared
from mbsd.dynamics.reference.pins import change_by_pins, factor_pins
from mbsd.dynamics.reference.schur import factor_schur, solve_schur, subtract_forces, times_jacobian
from mbsd.equations.assembly import evaluate_nu, evaluate_position, position
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


LIFT = 1e-11
"""Lift of the diagonal of S, relative: where joints nearly depend (singular poses), rounding in Phi is not blown up."""


@shared
def project(dyn, scratch, t, state, passes):
    """Project coordinates and velocities of a state (2, 3 nb) in place, ``passes`` times.

    The largest changes of coordinates in the first and last pass (sizes, rad) go to scratch.report[1:3].
    """
    system = dyn.system
    schur = dyn.schur
    ws = scratch.ws
    factors = scratch.factors
    drive = scratch.drive
    change = scratch.change
    y = factors.side
    nu = ws.right[1]
    n3 = state.shape[1]
    if drive.shape[0] > 1:
        evaluate_laws(dyn.laws, drive.shape[0], t, drive)
    evaluate_nu(system, drive, nu)
    for step in range(passes):
        if schur.pins.shape[0] > 0:
            factor_pins(schur, factors, ws.cos_sin, system.marker_arm, state[0], state[1], dyn.metric, LIFT)
            change_by_pins(schur, factors, state[0], state[1], change)
        else:
            evaluate_position(system, state[0], drive, ws)
            factor_schur(schur, dyn.metric, ws.jac, factors, LIFT)
            for k in range(schur.rows.shape[0]):
                for s in range(2):
                    r = schur.rows[k, s]
                    y[k, s, 0] = ws.phi[r] if r >= 0 else 0.0
                    y[k, s, 1] = times_jacobian(factors, schur, k, s, state[1]) - nu[r] if r >= 0 else 0.0
            solve_schur(schur, factors, 2)
            for c in range(n3):
                change[0, c] = 0.0
                change[1, c] = 0.0
            subtract_forces(factors, schur, 0, change[0])
            subtract_forces(factors, schur, 1, change[1])
        largest = 0.0
        for c in range(3, n3):
            moved = dyn.metric[c] * change[0, c]
            state[0, c] += moved
            state[1, c] += dyn.metric[c] * change[1, c]
            largest = max(largest, abs(moved) * dyn.per_size[c]) if moved == moved else moved
        scratch.report[2] = largest
        if step == 0:
            scratch.report[1] = largest


@apart
def measure(dyn, scratch, t, q):
    """Fill scratch.ws.phi and scratch.ws.jac at q (3 nb,) and t (s)."""
    if scratch.drive.shape[0] > 1:
        evaluate_laws(dyn.laws, scratch.drive.shape[0], t, scratch.drive)
    position(dyn.system, q, scratch.drive, scratch.ws)


@kernel
def factor_at(dyn, scratch, t, state):
    """Factor at the pose of a state; the part of each row that is new stays in factors.low[k, 1:3]."""
    project(dyn, scratch, t, state, 1)
    factor_schur(dyn.schur, dyn.metric, scratch.ws.jac, scratch.factors, 0.0)
