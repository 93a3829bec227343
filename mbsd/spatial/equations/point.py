"""Term `point`: d = P_j - P_i, three rows in axes of the world.

J on j   force e_k, torque s_j x e_k;  on i the negative with s_i
gamma    -(c_j - c_i),  c = w x (w x s)
"""

from __future__ import annotations

from mbsd.compiling.jit import inlined, internal


@inlined
def _push(jac, row, column, s, sign):
    for k in range(3):
        jac[row + k, column + k] = sign
    jac[row, column + 4] = sign * s[2]
    jac[row, column + 5] = -sign * s[1]
    jac[row + 1, column + 3] = -sign * s[2]
    jac[row + 1, column + 5] = sign * s[0]
    jac[row + 2, column + 3] = sign * s[1]
    jac[row + 2, column + 4] = -sign * s[0]


@internal
def measure_points(system, ws):
    """Fill phi and J of all points."""
    for n in range(system.point.shape[0]):
        row = system.point[n, 0]
        i = system.point[n, 1]
        j = system.point[n, 2]
        for k in range(3):
            ws.phi[row + k] += ws.place[j, k] - ws.place[i, k]
        _push(ws.jac, row, system.point[n, 3], ws.arm[i], -1.0)
        _push(ws.jac, row, system.point[n, 4], ws.arm[j], 1.0)


@internal
def bend_points(system, ws, out):
    """Subtract from out (m,) the second derivatives of all points at constant rates."""
    for n in range(system.point.shape[0]):
        row = system.point[n, 0]
        for k in range(3):
            out[row + k] -= ws.bend[system.point[n, 2], k] - ws.bend[system.point[n, 1], k]
