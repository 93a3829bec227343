"""Angle constraint: body j is turned by a fixed or driven angle against body i.

Phi   = theta_j - theta_i - offset - f(t)       1 row
J     = 1 on theta_j, -1 on theta_i
nu    = f',  gamma = f''
"""

from __future__ import annotations

from mbsd.compiling.jit import inlined


@inlined
def rows(system, q, drive, ws):
    """Residual (rad) and Jacobian."""
    table = system.angle
    for k in range(table.shape[0]):
        r = table[k, 2]
        bi = 3 * system.marker_body[table[k, 0]]
        bj = 3 * system.marker_body[table[k, 1]]
        ws.phi[r] = q[bj + 2] - q[bi + 2] - system.angle_offset[k] - drive[table[k, 3], 0]
        ws.jac[r, 2] = -1.0
        ws.jac[r, 5] = 1.0


@inlined
def gamma_rows(system, gamma):
    """Acceleration right-hand side (rad/s^2) without f''."""
    for k in range(system.angle.shape[0]):
        gamma[system.angle[k, 2]] = 0.0
