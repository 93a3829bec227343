"""TRAIN: A pinned to K1, its angle a sum of known ones, as of wheels (kinematics/groups/trains.py)."""

from __future__ import annotations

import math

from mbsd.compiling.jit import lazy
from mbsd.kinematics.groups import carried
from mbsd.kinematics.groups.blocks import TRAIN
from mbsd.kinematics.groups.cases import angle_of, predicted
from mbsd.kinematics.groups.groups import FIRST, K1, K2, THIRD, Link, Made, Places

P1_X, P1_Y, PA_X, PA_Y, CONSTANT, CARRIES_ON = range(6)
"""P on K1, P on A, constant of the sum (rad), 1 if other groups stand on A."""
SHARE_2, SHARE_3, BODY_3 = range(5, 8)
"""In independent coordinates, where a sum has the angles of bodies K2 and THIRD: what they count, and that body."""
UNSURE = 1.0
"""Angle (rad) by which the prediction may miss: whole turns count here, for their share of one turns A."""


def train(at: Places, body: int, pin: Link, constant: float, shares: dict[int, float]) -> Made | None:
    """Return a group for columns of B; None where the angle is a sum of more than two."""
    if len(shares) > 2:
        return None
    (second, share_2), (third, share_3) = [*shares.items(), (0, 0.0), (0, 0.0)][:2]
    numbers = [*at.pin(pin), constant, share_2, share_3, float(third)]
    return TRAIN, (body, -1, pin.other, second), 0, numbers


@lazy(None)
def solve_train(bodies, n, train, body_of, share_of, qk, vk, ak, turn, point):
    """Fill positions and rates; train (2,): first share and count; the angle is their sum.

    See prp.solve_prp.
    """
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
    carried.carried(qk, vk, ak, turn, bodies[K1], n[P1_X], n[P1_Y], p)
    carried.hang(qk, vk, ak, turn, body, p, n[PA_X], n[PA_Y])


@lazy(int)
def embed_train(bodies, n, body, rate, base, coordinate):
    """Place the body and fill its columns of B. See prp.solve_prp."""
    a = bodies[FIRST]
    k1 = bodies[K1]
    k2 = bodies[K2]
    k3 = bodies[THIRD]
    columns = coordinate.shape[0] - 1
    second = angle_of(body, base, coordinate, k2)
    third = angle_of(body, base, coordinate, k3)
    if not abs(second - predicted(base, coordinate, k2)) <= UNSURE:
        return carried.DOUBTED
    if not abs(third - predicted(base, coordinate, k3)) <= UNSURE:
        return carried.DOUBTED
    angle = n[CONSTANT] + n[SHARE_2] * second + n[SHARE_3] * third
    body[a, carried.COS] = math.cos(angle)
    body[a, carried.SIN] = math.sin(angle)
    body[a, carried.OMEGA] = n[SHARE_2] * body[k2, carried.OMEGA] + n[SHARE_3] * body[k3, carried.OMEGA]
    px = carried.turned_x(body, k1, n[P1_X], n[P1_Y])
    py = carried.turned_y(body, k1, n[P1_X], n[P1_Y])
    cx = body[k1, carried.X] + px
    cy = body[k1, carried.Y] + py
    ax = carried.place_by_point(body, a, cx, cy, n[PA_X], n[PA_Y], 0)
    ay = carried.place_by_point(body, a, cx, cy, n[PA_X], n[PA_Y], 1)
    for j in range(columns + 1):
        cx = carried.carry_column(body, rate, columns, j, k1, px, py, 0)
        cy = carried.carry_column(body, rate, columns, j, k1, px, py, 1)
        omega = n[SHARE_2] * rate[k2, 3 * j + 2] + n[SHARE_3] * rate[k3, 3 * j + 2]
        carried.hang_column(body, rate, columns, j, a, cx, cy, omega, ax, ay)
    return carried.SOLVED
