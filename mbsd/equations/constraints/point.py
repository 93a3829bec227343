"""Point constraint: markers i and j share one point.

Phi   = p_j - p_i                  2 rows
J     = [I, s_perp_j] on body j, -[I, s_perp_i] on body i
gamma = -(c_j - c_i)               c = -omega^2 s, the convective acceleration
"""

from __future__ import annotations

from mbsd.compiling.jit import inlined
from mbsd.equations.system import PLACE


@inlined
def rows(system, ws):
    """Residual (m) and Jacobian."""
    table = system.point
    phi = ws.phi
    jac = ws.jac
    for k in range(table.shape[0]):
        i = table[k, 0] & PLACE
        j = table[k, 1] & PLACE
        r = table[k, 2] & PLACE
        phi[r] = ws.position[j, 0] - ws.position[i, 0]
        phi[r + 1] = ws.position[j, 1] - ws.position[i, 1]
        jac[r, 0] = -1.0
        jac[r, 2] = ws.arm[i, 1]
        jac[r + 1, 1] = -1.0
        jac[r + 1, 2] = -ws.arm[i, 0]
        jac[r, 3] = 1.0
        jac[r, 5] = -ws.arm[j, 1]
        jac[r + 1, 4] = 1.0
        jac[r + 1, 5] = ws.arm[j, 0]


@inlined
def gamma_rows(system, ws, gamma):
    """Acceleration right-hand side (m/s^2)."""
    table = system.point
    for k in range(table.shape[0]):
        i = table[k, 0] & PLACE
        j = table[k, 1] & PLACE
        r = table[k, 2] & PLACE
        gamma[r] = ws.convective[i, 0] - ws.convective[j, 0]
        gamma[r + 1] = ws.convective[i, 1] - ws.convective[j, 1]
