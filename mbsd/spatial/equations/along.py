"""Term `along`: a . d, an axis a of body i and d = P_j - P_i.

J on j   force a, torque s_j x a;  on i  -a, a x (d + s_i)
gamma    -(a . (c_j - c_i) + 2 a' . d' + a'' . d),  c = w x (w x s)
"""

from __future__ import annotations

from mbsd.compiling.jit import internal


@internal
def measure_alongs(system, ws):
    """Add phi and J of all places along an axis."""
    for n in range(system.along.shape[0]):
        row = system.along[n, 0]
        a = ws.axis[system.along[n, 1]]
        first = system.along[n, 2]
        second = system.along[n, 3]
        weight = system.along_weight[n]
        i = system.along[n, 4]
        j = system.along[n, 5]
        total = 0.0
        for k in range(3):
            total += a[k] * (ws.place[second, k] - ws.place[first, k])
            ws.jac[row, j + k] += weight * a[k]
            ws.jac[row, i + k] -= weight * a[k]
        ws.phi[row] += weight * total
        s = ws.arm[second]
        x = ws.place[second, 0] - ws.place[first, 0] + ws.arm[first, 0]
        y = ws.place[second, 1] - ws.place[first, 1] + ws.arm[first, 1]
        z = ws.place[second, 2] - ws.place[first, 2] + ws.arm[first, 2]
        ws.jac[row, j + 3] += weight * (s[1] * a[2] - s[2] * a[1])
        ws.jac[row, j + 4] += weight * (s[2] * a[0] - s[0] * a[2])
        ws.jac[row, j + 5] += weight * (s[0] * a[1] - s[1] * a[0])
        ws.jac[row, i + 3] += weight * (a[1] * z - a[2] * y)
        ws.jac[row, i + 4] += weight * (a[2] * x - a[0] * z)
        ws.jac[row, i + 5] += weight * (a[0] * y - a[1] * x)


@internal
def bend_alongs(system, ws, out):
    """Subtract from out (m,) the second derivatives of all places along an axis at constant rates."""
    for n in range(system.along.shape[0]):
        axis = system.along[n, 1]
        i = system.along[n, 2]
        j = system.along[n, 3]
        total = 0.0
        for k in range(3):
            total += (
                ws.axis[axis, k] * (ws.bend[j, k] - ws.bend[i, k])
                + 2.0 * ws.axis_rate[axis, k] * (ws.rate[j, k] - ws.rate[i, k])
                + ws.axis_bend[axis, k] * (ws.place[j, k] - ws.place[i, k])
            )
        out[system.along[n, 0]] -= system.along_weight[n] * total
