"""Points carried by bodies, for the closed forms, and when a step is doubted.

p = r + s,   p' = r' + omega s_perp,   p'' = r'' + alpha s_perp - omega^2 s;   s_perp = (-s_y, s_x)
"""

from __future__ import annotations

import math

from mbsd.jit import internal

SOLVED, DOUBTED, OPEN = 0, 1, 2
NEAR = 0.25
"""Part of the angle to the other branch by which the extrapolated motion may be missed."""
FLAT = 1e-10
"""Discriminant over squared lengths at which branches meet."""
JUMP = 0.25
"""Part of a law's step that its rates may leave unexplained."""


@internal
def carried(q, v, a, turn, b, x, y, out):
    """Point with arm (x, y) of body b into out (8,): place, velocity, acceleration, arm in world axes."""
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
def aim(turn, q, before, b, x, y, lx, ly):
    """Turn body b so that its direction (lx, ly) points along (x, y); the angle goes on from ``before``."""
    scale = 1.0 / math.sqrt((x * x + y * y) * (lx * lx + ly * ly))
    c = (x * lx + y * ly) * scale
    s = (y * lx - x * ly) * scale
    turn[b, 0] = c
    turn[b, 1] = s
    angle = math.atan2(s, c)
    q[3 * b + 2] = angle + 2.0 * math.pi * math.floor((before - angle) / (2.0 * math.pi) + 0.5)


@internal
def follow(q, v, a, turn, b, leader, angle):
    """Body b turns with its leader, at a fixed angle to it."""
    q[3 * b + 2] = q[3 * leader + 2] + angle
    v[3 * b + 2] = v[3 * leader + 2]
    a[3 * b + 2] = a[3 * leader + 2]
    turn[b, 0] = math.cos(q[3 * b + 2])
    turn[b, 1] = math.sin(q[3 * b + 2])


@internal
def doubtful(q, last, v, a, h, c, square):
    """Whether angle c of pose q strays from the motion before (last, v, a) as if on the way to the other branch.

    ``square``: squared sine of half the angle between the branches.
    """
    miss = q[c] - (last[c] + h * (v[c] + 0.5 * h * a[c]))
    return not miss * miss < NEAR * NEAR * square


@internal
def jumps(law, before, h):
    """Whether a law's value (3,) is not where its rates lead from the value h seconds before: it jumps."""
    step = law[0] - before[0]
    gap = step - h * (0.5 * (law[1] + before[1]) - h / 12.0 * (law[2] - before[2]))
    return not abs(gap) <= JUMP * abs(step) + 1e-9
