"""Slot constraint: the point of marker j lies on the x axis of marker i.

n     = u_perp_i, unit normal of the slot;   d = p_j - p_i;   n = R n_local, so n' = -omega_i u
Phi   = n . d                                             1 row
J     = [n, n . s_perp_j] on body j;  [-n, -u . d - n . s_perp_i] on body i
gamma = -( n . (c_j - c_i) - 2 omega_i u . d' - omega_i^2 n . d )
"""

from __future__ import annotations

from mbsd.compiling.jit import inlined


@inlined
def rows(system, ws):
    """Residual (m) and Jacobian."""
    table = system.slot
    jac = ws.jac
    for k in range(table.shape[0]):
        i = table[k, 0]
        j = table[k, 1]
        r = table[k, 2]
        ux = ws.axis[i, 0]
        uy = ws.axis[i, 1]
        nx = -uy
        ny = ux
        dx = ws.position[j, 0] - ws.position[i, 0]
        dy = ws.position[j, 1] - ws.position[i, 1]
        ws.phi[r] = nx * dx + ny * dy
        jac[r, 0] = -nx
        jac[r, 1] = -ny
        jac[r, 2] = -(ux * dx + uy * dy) - (-nx * ws.arm[i, 1] + ny * ws.arm[i, 0])
        jac[r, 3] = nx
        jac[r, 4] = ny
        jac[r, 5] = -nx * ws.arm[j, 1] + ny * ws.arm[j, 0]


@inlined
def gamma_rows(system, v, ws, gamma):
    """Acceleration right-hand side (m/s^2)."""
    table = system.slot
    for k in range(table.shape[0]):
        i = table[k, 0]
        j = table[k, 1]
        r = table[k, 2]
        ux = ws.axis[i, 0]
        uy = ws.axis[i, 1]
        omega = v[3 * system.marker_body[i] + 2]
        across = -uy * (ws.position[j, 0] - ws.position[i, 0]) + ux * (ws.position[j, 1] - ws.position[i, 1])
        sliding = ux * (ws.velocity[j, 0] - ws.velocity[i, 0]) + uy * (ws.velocity[j, 1] - ws.velocity[i, 1])
        bend = -uy * (ws.convective[j, 0] - ws.convective[i, 0]) + ux * (ws.convective[j, 1] - ws.convective[i, 1])
        gamma[r] = -(bend - 2.0 * omega * sliding - omega * omega * across)
