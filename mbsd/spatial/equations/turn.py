"""Term `turn`: the angle of x_j against x_i about z_i, with its whole turns.

    theta    atan2(sine, cosine),  sine = y_i . x_j,  cosine = x_i . x_j,  n = sine^2 + cosine^2
    J on j   torque x_j x (cosine y_i - sine x_i) / n;  on i the negative
    gamma    -((cosine sine'' - sine cosine'') / n - theta' n' / n),  derivatives of dot products as in dot.py

This is exact at any pose; where the z axes agree, J is z_i. The whole turns are those nearest to the guess.
"""

from __future__ import annotations

import math

from mbsd.compiling.jit import lazy
from mbsd.spatial.equations.dot import second_derivative
from mbsd.spatial.equations.vectors import dot

TURN = 2.0 * math.pi


@lazy(None)
def measure_turns(system, ws):
    """Add phi and J of all turns."""
    for n in range(system.turn.shape[0]):
        row = system.turn[n, 0]
        weight = system.turn_weight[n]
        x = ws.axis[system.turn[n, 1]]
        y = ws.axis[system.turn[n, 2]]
        b = ws.axis[system.turn[n, 3]]
        i = system.turn[n, 4] + 3
        j = system.turn[n, 5] + 3
        cosine = dot(x, b)
        sine = dot(y, b)
        theta = math.atan2(sine, cosine)
        theta += TURN * math.floor((ws.guess[n] - theta) / TURN + 0.5)
        ws.turn[n] = theta
        ws.phi[row] += weight * theta
        scale = weight / (cosine * cosine + sine * sine)
        first = scale * (cosine * y[0] - sine * x[0])
        second = scale * (cosine * y[1] - sine * x[1])
        third = scale * (cosine * y[2] - sine * x[2])
        ws.jac[row, j] += b[1] * third - b[2] * second
        ws.jac[row, j + 1] += b[2] * first - b[0] * third
        ws.jac[row, j + 2] += b[0] * second - b[1] * first
        ws.jac[row, i] -= b[1] * third - b[2] * second
        ws.jac[row, i + 1] -= b[2] * first - b[0] * third
        ws.jac[row, i + 2] -= b[0] * second - b[1] * first


@lazy(None)
def bend_turns(system, ws, out):
    """Subtract from out (m,) the second derivatives of all turns at constant rates, and fill ws.turn_rate."""
    for n in range(system.turn.shape[0]):
        x = system.turn[n, 1]
        y = system.turn[n, 2]
        b = system.turn[n, 3]
        cosine = dot(ws.axis[x], ws.axis[b])
        sine = dot(ws.axis[y], ws.axis[b])
        cosine_rate = dot(ws.axis_rate[x], ws.axis[b]) + dot(ws.axis[x], ws.axis_rate[b])
        sine_rate = dot(ws.axis_rate[y], ws.axis[b]) + dot(ws.axis[y], ws.axis_rate[b])
        size = cosine * cosine + sine * sine
        rate = (cosine * sine_rate - sine * cosine_rate) / size
        second = (cosine * second_derivative(ws, y, b) - sine * second_derivative(ws, x, b)) / size
        second -= rate * 2.0 * (cosine * cosine_rate + sine * sine_rate) / size
        ws.turn_rate[n] = rate
        out[system.turn[n, 0]] -= system.turn_weight[n] * second
