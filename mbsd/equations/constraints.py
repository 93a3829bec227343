"""Point constraint: markers i and j share one point.

Phi   = p_j - p_i                  2 rows
J     = [I, s_perp_j] on body j, -[I, s_perp_i] on body i
gamma = -(c_j - c_i)               c = -omega^2 s, the convective acceleration

Angle constraint: body j is turned by a fixed or driven angle against body i.

Phi   = theta_j - theta_i - offset - f(t)       1 row
J     = 1 on theta_j, -1 on theta_i
nu    = f',  gamma = f''

Slot constraint: the point of marker j lies on the x axis of marker i.

n     = u_perp_i, unit normal of the slot;   d = p_j - p_i;   n = R n_local, so n' = -omega_i u
Phi   = n . d                                             1 row
J     = [n, n . s_perp_j] on body j;  [-n, -u . d - n . s_perp_i] on body i
gamma = -( n . (c_j - c_i) - 2 omega_i u . d' - omega_i^2 n . d )

Coordinate constraint: how far marker j lies along the x axis of marker i.

u     = unit axis of marker i;   d = p_j - p_i;   n = u_perp;   u' = omega_i n
Phi   = u . d - f(t)                                      1 row
J     = [u, u . s_perp_j] on body j;  [-u, n . d - u . s_perp_i] on body i
gamma = -( u . (c_j - c_i) + 2 omega_i n . d' - omega_i^2 u . d ) + f''

Distance constraint: markers i and j stay a fixed or driven distance apart (a massless rod).

    d     = p_j - p_i,  l = |d|,  u = d / l
    Phi   = l - length - f(t)                                 1 row
    J     = [u, u . s_perp_j] on body j;  -[u, u . s_perp_i] on body i
    gamma = -( u . (c_j - c_i) + (|d'|^2 - (u . d')^2) / l ) + f''

The multiplier is the rod's pull: negative where the rod is in compression. l = 0 has no direction; the
model refuses a rod of zero length.
"""

from __future__ import annotations

import math

from mbsd.compiling.jit import inlined
from mbsd.equations.system import PLACE


@inlined
def point_rows(system, ws):
    """Fill residual (m) and Jacobian."""
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
def point_gamma(system, ws, gamma):
    """Fill the acceleration right-hand side (m/s^2)."""
    table = system.point
    for k in range(table.shape[0]):
        i = table[k, 0] & PLACE
        j = table[k, 1] & PLACE
        r = table[k, 2] & PLACE
        gamma[r] = ws.convective[i, 0] - ws.convective[j, 0]
        gamma[r + 1] = ws.convective[i, 1] - ws.convective[j, 1]


@inlined
def angle_rows(system, q, drive, ws):
    """Fill residual (rad) and Jacobian."""
    table = system.angle
    for k in range(table.shape[0]):
        r = table[k, 2]
        bi = 3 * system.marker_body[table[k, 0]]
        bj = 3 * system.marker_body[table[k, 1]]
        ws.phi[r] = q[bj + 2] - q[bi + 2] - system.angle_offset[k] - drive[table[k, 3], 0]
        ws.jac[r, 2] = -1.0
        ws.jac[r, 5] = 1.0


@inlined
def angle_gamma(system, gamma):
    """Fill the acceleration right-hand side (rad/s^2) without f''."""
    for k in range(system.angle.shape[0]):
        gamma[system.angle[k, 2]] = 0.0


@inlined
def slot_rows(system, ws):
    """Fill residual (m) and Jacobian."""
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
def slot_gamma(system, v, ws, gamma):
    """Fill the acceleration right-hand side (m/s^2)."""
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


@inlined
def along_rows(system, drive, ws):
    """Fill residual (m) and Jacobian."""
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
def along_gamma(system, v, ws, gamma):
    """Fill the acceleration right-hand side (m/s^2) without f''."""
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


@inlined
def distance_rows(system, drive, ws):
    """Fill residual (m) and Jacobian."""
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
def distance_gamma(system, ws, gamma):
    """Fill the acceleration right-hand side (m/s^2) without f''."""
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
