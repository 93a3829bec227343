"""Coordinate constraint: how far marker j lies along the x axis of marker i.

u     = unit axis of marker i;   d = p_j - p_i;   n = u_perp;   u' = omega_i n
Phi   = u . d - f(t)                                      1 row
J     = [u, u . s_perp_j] on body j;  [-u, n . d - u . s_perp_i] on body i
gamma = -( u . (c_j - c_i) + 2 omega_i n . d' - omega_i^2 u . d ) + f''
"""

from __future__ import annotations

from mbsd.compiling.jit import inlined


@inlined
def rows(system, drive, ws):
    """Residual (m) and Jacobian."""
    table = system.along
    jac = ws.jac
    for k in range(table.shape[0]):
        i = table[k, 0]
        j = table[k, 1]
        r = table[k, 2]
        ux = ws.axis[i, 0]
        uy = ws.axis[i, 1]
        dx = ws.position[j, 0] - ws.position[i, 0]
        dy = ws.position[j, 1] - ws.position[i, 1]
        ws.phi[r] = ux * dx + uy * dy - drive[table[k, 3], 0]
        jac[r, 0] = -ux
        jac[r, 1] = -uy
        jac[r, 2] = -uy * dx + ux * dy - (-ux * ws.arm[i, 1] + uy * ws.arm[i, 0])
        jac[r, 3] = ux
        jac[r, 4] = uy
        jac[r, 5] = -ux * ws.arm[j, 1] + uy * ws.arm[j, 0]


@inlined
def gamma_rows(system, v, ws, gamma):
    """Acceleration right-hand side (m/s^2) without f''."""
    table = system.along
    for k in range(table.shape[0]):
        i = table[k, 0]
        j = table[k, 1]
        r = table[k, 2]
        ux = ws.axis[i, 0]
        uy = ws.axis[i, 1]
        omega = v[3 * system.marker_body[i] + 2]
        reach = ux * (ws.position[j, 0] - ws.position[i, 0]) + uy * (ws.position[j, 1] - ws.position[i, 1])
        across = -uy * (ws.velocity[j, 0] - ws.velocity[i, 0]) + ux * (ws.velocity[j, 1] - ws.velocity[i, 1])
        bend = ux * (ws.convective[j, 0] - ws.convective[i, 0]) + uy * (ws.convective[j, 1] - ws.convective[i, 1])
        gamma[r] = -(bend + 2.0 * omega * across - omega * omega * reach)
