"""Term `roll`: a ball, disc or ring of frame j rolls without slip on the plane x, y of frame i; three rows.

    u = (n - (n . a) a) / s,  s = |..|     n: normal z_i,  a: axis z_j;  radii R of the ring, r of its tube (ball: R 0)
    phi      n . d - R s - r;  0;  0       the last two hold rates alone: no place says how far it has rolled
    J on j   force e, torque (s_j + rho) x e;  on i  -e, -(s_i + d + rho) x e;   e = n, x_i, y_i,  rho = -(R u + r n)
    gamma    -(e' . V + e . V'),  V = c_j' - c_i' + w_j x rho - w_i x (d + rho) without w', rho' = -(R u' + r n')

V is the velocity of the lowest point of j against i.

Source: Neimark, Fufaev 1972, Dynamics of Nonholonomic Systems, ch. 1.
"""

from __future__ import annotations

import math

from mbsd.compiling.jit import internal, lazy
from mbsd.spatial.equations.vectors import cross, dot

ROW, X_I, Y_I, Z_I, X_J, Y_J, Z_J, PLACE_I, PLACE_J, COLUMN_I, COLUMN_J = range(11)
RING, TUBE = range(2)
FLAT = 1e-12
"""Sine of the lean below which a disc lies flat and has no lowest point."""
RHO, RHO_RATE, REACH, V, W_I, W_J, U, P = range(8)
"""Rows of Workspace.roll."""


@internal
def _reach(system, ws, n):
    """Fill rho and d + rho of a roll; returns s."""
    term = system.roll[n]
    normal = ws.axis[term[Z_I]]
    axis = ws.axis[term[Z_J]]
    k = dot(normal, axis)
    u = ws.roll[U]
    for c in range(3):
        u[c] = normal[c] - k * axis[c]
    s = math.sqrt(dot(u, u))
    for c in range(3):
        u[c] /= max(s, FLAT)
        ws.roll[RHO, c] = -(system.roll_number[n, RING] * u[c] + system.roll_number[n, TUBE] * normal[c])
        ws.roll[REACH, c] = ws.place[term[PLACE_J], c] - ws.place[term[PLACE_I], c] + ws.roll[RHO, c]
    return s


@lazy(None)
def measure_rolls(system, ws):
    """Add phi and J of all rolls."""
    for n in range(system.roll.shape[0]):
        term = system.roll[n]
        s = _reach(system, ws, n)
        row = term[ROW]
        height = dot(ws.axis[term[Z_I]], ws.roll[REACH]) - dot(ws.axis[term[Z_I]], ws.roll[RHO])
        ws.phi[row] += height - system.roll_number[n, RING] * s - system.roll_number[n, TUBE]
        for side in range(2):
            sign = 1.0 if side == 1 else -1.0
            arm = ws.arm[term[PLACE_I + side]]
            reach = ws.roll[RHO if side == 1 else REACH]
            x = arm[0] + reach[0]
            y = arm[1] + reach[1]
            z = arm[2] + reach[2]
            c = term[COLUMN_I + side]
            for k in range(3):
                e = ws.axis[term[Z_I if k == 0 else X_I + k - 1]]
                jac = ws.jac[row + k]
                jac[c] += sign * e[0]
                jac[c + 1] += sign * e[1]
                jac[c + 2] += sign * e[2]
                jac[c + 3] += sign * (y * e[2] - z * e[1])
                jac[c + 4] += sign * (z * e[0] - x * e[2])
                jac[c + 5] += sign * (x * e[1] - y * e[0])


@internal
def _spin(ws, x, out):
    """Fill out (3,) with the angular velocity of axes x, x + 1, x + 2 of ``x``: half the sum of a x a'."""
    for c in range(3):
        out[c] = 0.0
    for k in range(3):
        a = ws.axis[x[k]]
        rate = ws.axis_rate[x[k]]
        out[0] += 0.5 * (a[1] * rate[2] - a[2] * rate[1])
        out[1] += 0.5 * (a[2] * rate[0] - a[0] * rate[2])
        out[2] += 0.5 * (a[0] * rate[1] - a[1] * rate[0])


@lazy(None)
def bend_rolls(system, ws, out):
    """Subtract from out (m,) the second derivatives of all rolls at constant rates."""
    for n in range(system.roll.shape[0]):
        term = system.roll[n]
        s = _reach(system, ws, n)
        roll = ws.roll
        _spin(ws, term[X_I : Z_I + 1], roll[W_I])
        _spin(ws, term[X_J : Z_J + 1], roll[W_J])
        normal = ws.axis[term[Z_I]]
        axis = ws.axis[term[Z_J]]
        normal_rate = ws.axis_rate[term[Z_I]]
        axis_rate = ws.axis_rate[term[Z_J]]
        k = dot(normal, axis)
        k_rate = dot(normal_rate, axis) + dot(normal, axis_rate)
        for c in range(3):
            roll[P, c] = (normal_rate[c] - k_rate * axis[c] - k * axis_rate[c]) / max(s, FLAT)
        along = dot(roll[U], roll[P])
        for c in range(3):
            rate = roll[P, c] - roll[U, c] * along
            roll[RHO_RATE, c] = -(system.roll_number[n, RING] * rate + system.roll_number[n, TUBE] * normal_rate[c])
        i = term[PLACE_I]
        j = term[PLACE_J]
        cross(roll[W_J], roll[RHO], roll[V])
        cross(roll[W_I], roll[REACH], roll[P])
        for c in range(3):
            roll[V, c] += ws.rate[j, c] - ws.rate[i, c] - roll[P, c]
        cross(roll[W_J], roll[RHO_RATE], roll[U])
        for c in range(3):  # what d + rho changes by
            roll[REACH, c] = ws.rate[j, c] - ws.rate[i, c] + roll[RHO_RATE, c]
        cross(roll[W_I], roll[REACH], roll[P])
        for c in range(3):
            roll[U, c] += ws.bend[j, c] - ws.bend[i, c] - roll[P, c]
        for r in range(3):
            e = term[Z_I if r == 0 else X_I + r - 1]
            out[term[ROW] + r] -= dot(ws.axis_rate[e], roll[V]) + dot(ws.axis[e], roll[U])
