"""TRAIN: A pinned to K1, its angle a sum of known angles, as of wheels (mbsd/kinematics/groups/trains.py)."""

from __future__ import annotations

import math

from mbsd.compiling.jit import lazy
from mbsd.kinematics.groups.carrying.rates import carried, hang
from mbsd.kinematics.groups.groups import FIRST, K1

P1_X, P1_Y, PA_X, PA_Y, CONSTANT, CARRIES_ON = range(6)
"""P on K1, P on A, constant of the sum (rad), 1 if other groups stand on A."""


@lazy(None)
def solve_train(bodies, n, train, body_of, share_of, qk, vk, ak, turn, point):
    """Positions and rates; train (2,): first share and how many; the angle is their sum. See prp.solve_prp."""
    p = point[0]
    body = bodies[FIRST]
    angle = n[CONSTANT]
    omega = 0.0
    alpha = 0.0
    for i in range(train[0], train[0] + train[1]):
        c = 3 * body_of[i] + 2
        angle += share_of[i] * qk[c]
        omega += share_of[i] * vk[c]
        alpha += share_of[i] * ak[c]
    at = 3 * body + 2
    qk[at] = angle
    vk[at] = omega
    ak[at] = alpha
    turn[body, 0] = math.cos(angle)
    turn[body, 1] = math.sin(angle)
    carried(qk, vk, ak, turn, bodies[K1], n[P1_X], n[P1_Y], p)
    hang(qk, vk, ak, turn, body, p, n[PA_X], n[PA_Y])
