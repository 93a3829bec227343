"""Points on bodies, and bodies on points, for the columns 0 .. C - 1 of B and the last one.

P' = r' + omega s_perp,   in the last column also - omega^2 s: the convective accelerations

B: the rates of all bodies for each independent coordinate (mbsd/dynamics/independent/arrays.py).
"""

from __future__ import annotations

from mbsd.compiling.jit import internal
from mbsd.kinematics.groups.carrying.columns import COS, OMEGA, SIN, X, Y


@internal
def turned_x(body, b, x, y):
    """World x of a vector (x, y) in the axes of body b."""
    return body[b, COS] * x - body[b, SIN] * y


@internal
def turned_y(body, b, x, y):
    """World y of a vector (x, y) in the axes of body b."""
    return body[b, SIN] * x + body[b, COS] * y


@internal
def carry_column(body, rate, columns, j, b, x, y, part):
    """Rate (part 0: x, 1: y) in column j of a point with arm (x, y) in world axes that body b carries."""
    omega = rate[b, 3 * j + 2]
    out = rate[b, 3 * j] - omega * y if part == 0 else rate[b, 3 * j + 1] + omega * x
    if j == columns:
        square = body[b, OMEGA] * body[b, OMEGA]
        out -= square * (x if part == 0 else y)
    return out


@internal
def hang_column(body, rate, columns, j, b, vx, vy, omega, x, y):
    """Set the rate in column j of body b, which turns with omega and has a point with velocity (vx, vy).

    The point's arm (x, y) is in world axes.
    """
    rate[b, 3 * j] = vx + omega * y
    rate[b, 3 * j + 1] = vy - omega * x
    rate[b, 3 * j + 2] = omega
    if j == columns:
        square = body[b, OMEGA] * body[b, OMEGA]
        rate[b, 3 * j] += square * x
        rate[b, 3 * j + 1] += square * y


@internal
def turn_as(body, b, leader, c, s):
    """Turn b as its leader, and by the angle of (c, s) more."""
    body[b, COS] = body[leader, COS] * c - body[leader, SIN] * s
    body[b, SIN] = body[leader, SIN] * c + body[leader, COS] * s


@internal
def put(body, b, x, y, lx, ly, part):
    """Put b, whose turn is known, so that its point (lx, ly) is at (x, y); returns the arm in world axes."""
    ax = turned_x(body, b, lx, ly)
    ay = turned_y(body, b, lx, ly)
    body[b, X] = x - ax
    body[b, Y] = y - ay
    return ax if part == 0 else ay
