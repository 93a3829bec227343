"""Points carried by bodies, for the closed forms, and when a step between two poses is doubted.

p = r + s,   p' = r' + omega s_perp,   p'' = r'' + alpha s_perp - omega^2 s;   s_perp = (-s_y, s_x)

The sign of a group's root is that of the start as long as the squared sine D of the angle between its two links stays
above zero, at the poses and between them. Between two poses D is the cubic through both ends with their rates: where it
has a minimum there and falls by more than half, a pose at the minimum decides. Bodies turn by less than ``WOUND`` from
pose to pose, so whole turns are counted, and the quintic through both ends is the motion between them.

Functions with ``column`` in their names do the same for columns 0 .. C - 1 of B, the rates of all bodies for each
independent coordinate (mbsd/dynamics/independent/arrays.py), and for a last one, which takes convective accelerations:

P' = r' + omega s_perp,   in the last column also - omega^2 s
"""

from __future__ import annotations

import math

from mbsd.compiling.jit import internal

X, Y, COS, SIN, OMEGA, MASS, INERTIA = range(7)
"""Columns of EmbeddingScratch.body: place of the centre of mass, turn, rate of turning; kg, kg m^2."""
NUMBERS = 21
SIGN, NEAR, SINE, AVOID, CHANGE = range(16, 21)
"""Columns of Groups.row that change: branch, whether it may change within a step, squared sine of its angle; the
squared sine below which the pose is unclear, a number of the run; the rate of the squared sine (1/s)."""
THETA, BEND, TURNS = 0, 1, 2
"""Columns of EmbeddingScratch.base: angle, convective acceleration, then the rates of turning."""
VALUE, SPEED, BASE = 0, 1, 2
"""Columns of EmbeddingScratch.coordinate."""


SOLVED, DOUBTED, OPEN, MEETING = 0, 1, 2, 3
"""Solved; a pose between is needed; out of reach; the two branches meet within rounding."""
DEEP = 0.5
"""Part of the lower end below which the squared sine must not fall between two poses."""
WOUND = 1.0
"""Angle (rad) by which a body may turn from pose to pose."""
UNEXPLAINED = 0.02
"""Part of it (rad) that the rates at both ends may leave unexplained."""


@internal
def carried(q, v, a, turn, b, x, y, out):
    """Fill out (8,) with place, velocity, acceleration and world arm of the point (x, y) of body b."""
    c = turn[b, 0]
    s = turn[b, 1]
    sx = c * x - s * y
    sy = s * x + c * y
    at = 3 * b
    omega = v[at + 2]
    alpha = a[at + 2]
    square = omega * omega
    out[0] = q[at] + sx
    out[1] = q[at + 1] + sy
    out[2] = v[at] - omega * sy
    out[3] = v[at + 1] + omega * sx
    out[4] = a[at] - alpha * sy - square * sx
    out[5] = a[at + 1] + alpha * sx - square * sy
    out[6] = sx
    out[7] = sy


@internal
def hang(q, v, a, turn, b, p, x, y):
    """Place body b, whose turn, omega and alpha are known, so that its point with arm (x, y) is p (8,)."""
    c = turn[b, 0]
    s = turn[b, 1]
    sx = c * x - s * y
    sy = s * x + c * y
    at = 3 * b
    omega = v[at + 2]
    alpha = a[at + 2]
    square = omega * omega
    q[at] = p[0] - sx
    q[at + 1] = p[1] - sy
    v[at] = p[2] + omega * sy
    v[at + 1] = p[3] - omega * sx
    a[at] = p[4] + alpha * sy + square * sx
    a[at + 1] = p[5] - alpha * sx + square * sy


@internal
def follow(q, v, a, turn, b, leader, angle):
    """Turn body b with its leader, at a fixed angle to it."""
    q[3 * b + 2] = q[3 * leader + 2] + angle
    v[3 * b + 2] = v[3 * leader + 2]
    a[3 * b + 2] = a[3 * leader + 2]
    turn[b, 0] = math.cos(q[3 * b + 2])
    turn[b, 1] = math.sin(q[3 * b + 2])


@internal
def wound(q, last, v, v_last, a, a_last, h, c):
    """Return True if angle c turns too far, or unexplained, for the pose and rates h seconds before."""
    turned = q[c] - last[c]
    gap = turned - h * (0.5 * (v[c] + v_last[c]) - h / 12.0 * (a[c] - a_last[c]))
    return not (abs(turned) <= WOUND and abs(gap) <= UNEXPLAINED)


@internal
def dip(fall, before, rise, after):
    """Return the part of the step at which the squared sine has a low minimum; 0 if nowhere.

    ``fall`` and ``rise``: its rates at both ends times the step. Source: cubic Hermite interpolation.
    """
    if not (fall < 0.0 and rise > 0.0):
        return 0.0
    change = after - before
    second = 3.0 * change - 2.0 * fall - rise
    third = fall + rise - 2.0 * change
    s = -fall / (second + math.sqrt(max(second * second - 3.0 * third * fall, 0.0)))
    low = before + s * (fall + s * (second + s * third))
    if low > DEEP * min(before, after):
        return 0.0
    return min(max(s, 1e-6), 1.0 - 1e-6)


@internal
def turned_x(body, b, x, y):
    """Return world x of a vector (x, y) in the axes of body b."""
    return body[b, COS] * x - body[b, SIN] * y


@internal
def turned_y(body, b, x, y):
    """Return world y of a vector (x, y) in the axes of body b."""
    return body[b, SIN] * x + body[b, COS] * y


@internal
def carry_column(body, rate, columns, j, b, x, y, part):
    """Return the rate (part 0: x, 1: y) in column j of the point with world arm (x, y) on body b."""
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
def place_by_point(body, b, x, y, lx, ly, part):
    """Put b, whose turn is known, so that its point (lx, ly) is at (x, y); returns the arm in world axes."""
    ax = turned_x(body, b, lx, ly)
    ay = turned_y(body, b, lx, ly)
    body[b, X] = x - ax
    body[b, Y] = y - ay
    return ax if part == 0 else ay
