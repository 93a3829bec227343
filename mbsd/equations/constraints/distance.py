"""Distance constraint: markers i and j stay a fixed or driven distance apart (a massless rod).

    d     = p_j - p_i,  l = |d|,  u = d / l
    Phi   = l - length - f(t)                                 1 row
    J     = [u, u . s_perp_j] on body j;  -[u, u . s_perp_i] on body i
    gamma = -( u . (c_j - c_i) + (|d'|^2 - (u . d')^2) / l ) + f''

The multiplier is the rod's push: positive where the rod is in compression. l = 0 has no direction; the
model refuses a rod of zero length.
"""

from __future__ import annotations

import math

from mbsd.compiling.jit import inlined


@inlined
def rows(system, drive, ws):
    """Residual (m) and Jacobian."""
    table = system.distance
    jac = ws.jac
    for k in range(table.shape[0]):
        i = table[k, 0]
        j = table[k, 1]
        r = table[k, 2]
        dx = ws.position[j, 0] - ws.position[i, 0]
        dy = ws.position[j, 1] - ws.position[i, 1]
        length = math.sqrt(dx * dx + dy * dy)
        ux = dx / length
        uy = dy / length
        ws.phi[r] = length - system.distance_length[k] - drive[table[k, 3], 0]
        jac[r, 0] = -ux
        jac[r, 1] = -uy
        jac[r, 2] = ux * ws.arm[i, 1] - uy * ws.arm[i, 0]
        jac[r, 3] = ux
        jac[r, 4] = uy
        jac[r, 5] = -ux * ws.arm[j, 1] + uy * ws.arm[j, 0]


@inlined
def gamma_rows(system, ws, gamma):
    """Acceleration right-hand side (m/s^2) without f''."""
    table = system.distance
    for k in range(table.shape[0]):
        i = table[k, 0]
        j = table[k, 1]
        r = table[k, 2]
        dx = ws.position[j, 0] - ws.position[i, 0]
        dy = ws.position[j, 1] - ws.position[i, 1]
        length = math.sqrt(dx * dx + dy * dy)
        ux = dx / length
        uy = dy / length
        across = ux * (ws.velocity[j, 1] - ws.velocity[i, 1]) - uy * (ws.velocity[j, 0] - ws.velocity[i, 0])
        bend = ux * (ws.convective[j, 0] - ws.convective[i, 0]) + uy * (ws.convective[j, 1] - ws.convective[i, 1])
        gamma[r] = -(bend + across * across / length)
