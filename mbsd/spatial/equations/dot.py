"""Term `dot`: a . b, an axis a of body i and an axis b of body j.

J on j   torque b x a;  on i the negative
gamma    -(a'' . b + 2 a' . b' + a . b''),  a' = w x a, a'' = w x a'
"""

from __future__ import annotations

from mbsd.compiling.jit import inlined, internal
from mbsd.spatial.equations.vectors import dot


@inlined
def second_derivative(ws, a, b):
    """Return that of a . b at constant rates."""
    return (
        dot(ws.axis_bend[a], ws.axis[b])
        + 2.0 * dot(ws.axis_rate[a], ws.axis_rate[b])
        + dot(ws.axis[a], ws.axis_bend[b])
    )


@internal
def measure_dots(system, ws):
    """Add phi and J of all dots."""
    for n in range(system.dot.shape[0]):
        row = system.dot[n, 0]
        a = ws.axis[system.dot[n, 1]]
        b = ws.axis[system.dot[n, 2]]
        weight = system.dot_weight[n]
        i = system.dot[n, 3] + 3
        j = system.dot[n, 4] + 3
        ws.phi[row] += weight * dot(a, b)
        x = weight * (b[1] * a[2] - b[2] * a[1])
        y = weight * (b[2] * a[0] - b[0] * a[2])
        z = weight * (b[0] * a[1] - b[1] * a[0])
        ws.jac[row, j] += x
        ws.jac[row, j + 1] += y
        ws.jac[row, j + 2] += z
        ws.jac[row, i] -= x
        ws.jac[row, i + 1] -= y
        ws.jac[row, i + 2] -= z


@internal
def bend_dots(system, ws, out):
    """Subtract from out (m,) the second derivatives of all dots at constant rates."""
    for n in range(system.dot.shape[0]):
        second = second_derivative(ws, system.dot[n, 1], system.dot[n, 2])
        out[system.dot[n, 0]] -= system.dot_weight[n] * second
