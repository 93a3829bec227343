"""The compiled evaluation: residual, Jacobian, velocity and acceleration right-hand sides of all constraints.

Phi(q, t) = 0,   J v = nu,   J a = gamma
"""

from __future__ import annotations

from mbsd.constraints import along, angle, distance, point, slot
from mbsd.jit import inlined, kernel
from mbsd.markers import place


@inlined
def evaluate_position(system, q, drive, ws):
    """Fill ws.phi and ws.jac at q (3 nb,). ``drive`` is (motions, 3): f, f', f'' now; row 0 is zero."""
    place(system, q, ws)
    point.rows(system, ws)
    angle.rows(system, q, drive, ws)
    slot.rows(system, ws)
    along.rows(system, drive, ws)
    distance.rows(system, drive, ws)


@inlined
def evaluate_nu(system, drive, ws):
    """Fill ws.right with nu: f' in driven rows, else zero."""
    for r in range(ws.right.shape[0]):
        ws.right[r] = 0.0
    for table in (system.angle, system.along, system.distance):
        for k in range(table.shape[0]):
            ws.right[table[k, 2]] = drive[table[k, 3], 1]


@inlined
def evaluate_gamma(system, v, drive, ws):
    """Fill ws.right with gamma at velocities v (3 nb,), after evaluate_position at the same pose."""
    point.gamma_rows(system, v, ws)
    angle.gamma_rows(system, ws)
    slot.gamma_rows(system, v, ws)
    along.gamma_rows(system, v, ws)
    distance.gamma_rows(system, v, ws)
    for table in (system.angle, system.along, system.distance):
        for k in range(table.shape[0]):
            ws.right[table[k, 2]] += drive[table[k, 3], 2]


@kernel
def residual_and_jacobian(system, q, drive, ws):
    """evaluate_position as a function of its own, for callers outside the compiled loops."""
    evaluate_position(system, q, drive, ws)
