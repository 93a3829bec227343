"""Term `distance`: |d|, d = P_j - P_i, with its direction u.

J on j   force u, torque s_j x u;  on i the negative with s_i
gamma    -(u . (c_j - c_i) + (d' . d' - (u . d')^2) / |d|),  c = w x (w x s)
"""

from __future__ import annotations

import math

from mbsd.compiling.jit import lazy

SHORTEST = 1e-150
"""Distance (m) that keeps a direction finite."""


@lazy(None)
def measure_distances(system, ws):
    """Add phi and J of all distances."""
    for n in range(system.distance.shape[0]):
        row = system.distance[n, 0]
        first = system.distance[n, 1]
        second = system.distance[n, 2]
        weight = system.distance_weight[n]
        x = ws.place[second, 0] - ws.place[first, 0]
        y = ws.place[second, 1] - ws.place[first, 1]
        z = ws.place[second, 2] - ws.place[first, 2]
        length = math.sqrt(x * x + y * y + z * z)
        ws.phi[row] += weight * length
        inverse = weight / max(length, SHORTEST)
        x *= inverse
        y *= inverse
        z *= inverse
        for side in range(2):
            sign = 1.0 if side == 1 else -1.0
            s = ws.arm[system.distance[n, 1 + side]]
            c = system.distance[n, 3 + side]
            ws.jac[row, c] += sign * x
            ws.jac[row, c + 1] += sign * y
            ws.jac[row, c + 2] += sign * z
            ws.jac[row, c + 3] += sign * (s[1] * z - s[2] * y)
            ws.jac[row, c + 4] += sign * (s[2] * x - s[0] * z)
            ws.jac[row, c + 5] += sign * (s[0] * y - s[1] * x)


@lazy(None)
def bend_distances(system, ws, out):
    """Subtract from out (m,) the second derivatives of all distances at constant rates."""
    for n in range(system.distance.shape[0]):
        i = system.distance[n, 1]
        j = system.distance[n, 2]
        square = 0.0
        speed = 0.0
        lengthwise = 0.0
        bend = 0.0
        for k in range(3):
            d = ws.place[j, k] - ws.place[i, k]
            rate = ws.rate[j, k] - ws.rate[i, k]
            square += d * d
            speed += rate * rate
            lengthwise += d * rate
            bend += d * (ws.bend[j, k] - ws.bend[i, k])
        length = max(math.sqrt(square), SHORTEST)
        lengthwise /= length
        total = (bend + speed - lengthwise * lengthwise) / length
        out[system.distance[n, 0]] -= system.distance_weight[n] * total
