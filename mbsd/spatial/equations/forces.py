"""Forces: rows that nothing holds push by what they measure.

F = amount + law(t) - stiffness (x - free) - damping x',    x' = J v,    Q += J^T F

Forces by functions: calls.py.
"""

from __future__ import annotations

from mbsd.compiling.jit import internal, lazy
from mbsd.equations.laws import law_at
from mbsd.spatial.equations.calls import apply_calls


@internal
def along_row(system, ws, row, v):
    """Return a row of J times velocities v (3 + 6 n,), w in the world."""
    out = 0.0
    for side in range(system.row_body.shape[1]):
        b = system.row_body[row, side]
        if b > 0:
            for k in range(6):
                out += ws.jac[row, 6 * side + k] * v[6 * b - 3 + k]
    return out


@internal
def push_row(system, ws, row, size, load):
    """Add a row of J^T, ``size`` times, to a load (3 + 6 n,), torques in the world."""
    for side in range(system.row_body.shape[1]):
        b = system.row_body[row, side]
        if b > 0:
            for k in range(6):
                load[6 * b - 3 + k] += size * ws.jac[row, 6 * side + k]


@lazy(float)
def apply_forces(system, laws, t, q, v, ws, load, lam):
    """Add all forces to load (3 + 6 n,); lam (m,) of their rows gets -F. Returns their power (W)."""
    power = 0.0
    if system.call.shape[0] > 0:
        power = apply_calls(system, t, q, v, ws, load)
    for n in range(system.force.shape[0]):
        row = system.force[n, 0]
        rate = along_row(system, ws, row, v)
        push = system.push[n, 3] - system.push[n, 0] * (ws.phi[row] - system.push[n, 1]) - system.push[n, 2] * rate
        if system.force[n, 1] > 0:
            law_at(laws, system.force[n, 1], t, ws.law)
            push += ws.law[0]
        push_row(system, ws, row, push, load)
        lam[row] = -push
        power += push * rate
    return power
