"""WELDED: body A fixed to K1."""

from __future__ import annotations

import math

from mbsd.compiling.jit import inlined, lazy, merged
from mbsd.kinematics.groups.carrying.by_column import carry_column, hang_column, put, turn_as, turned_x, turned_y
from mbsd.kinematics.groups.carrying.columns import OMEGA, X, Y
from mbsd.kinematics.groups.carrying.places import point_of, put_on, turn_with
from mbsd.kinematics.groups.carrying.rates import SOLVED, carried, follow, hang
from mbsd.kinematics.groups.groups import FIRST, K1, WELDED
from mbsd.kinematics.groups.kind import GroupKind, Made
from mbsd.kinematics.groups.links import Link, Places, own_angle

P1_X, P1_Y, PA_X, PA_Y, ANGLE = range(5)
"""P on K1, P on A; angle of A against K1 (rad)."""
COS_A, SIN_A = ANGLE, 5
"""For columns of B: its cosine and sine."""


def welded(at: Places, body: int, links: dict[str, Link]) -> Made:
    """A body with a weld."""
    weld = links["W"]
    return WELDED, (body, -1, weld.other, 0), 0, [*at.pin(weld), own_angle(weld)]


def _embedded(n: list[float]) -> list[float]:
    return [*n[:ANGLE], math.cos(n[ANGLE]), math.sin(n[ANGLE])]


KIND = GroupKind(WELDED, "welded", _embedded, one=("W",), of_one=welded, angles=((0, ANGLE),))


@merged
def solve_welded(bodies, n, qk, vk, ak, turn, point):
    """Positions and rates. See prp.solve_prp."""
    body = bodies[FIRST]
    k1 = bodies[K1]
    p = point[0]
    follow(qk, vk, ak, turn, body, k1, n[ANGLE])
    carried(qk, vk, ak, turn, k1, n[P1_X], n[P1_Y], p)
    hang(qk, vk, ak, turn, body, p, n[PA_X], n[PA_Y])


@inlined
def place_welded(bodies, n, turn_a, place, p):
    """Places alone; turn_a (2,): cosine and sine of the angle. See rrr.place_rrr."""
    a = bodies[FIRST]
    k1 = bodies[K1]
    point_of(place, k1, n[P1_X], n[P1_Y], p)
    turn_with(place, a, k1, turn_a)
    put_on(place, a, p[0], p[1], n[PA_X], n[PA_Y])


@lazy(int)
def embed_welded(bodies, n, body, rate, coordinate):
    """Positions and columns of B. See prp.embed_prp."""
    a = bodies[FIRST]
    k1 = bodies[K1]
    columns = coordinate.shape[0] - 1
    px = turned_x(body, k1, n[P1_X], n[P1_Y])
    py = turned_y(body, k1, n[P1_X], n[P1_Y])
    turn_as(body, a, k1, n[COS_A], n[SIN_A])
    cx = body[k1, X] + px
    cy = body[k1, Y] + py
    ax = put(body, a, cx, cy, n[PA_X], n[PA_Y], 0)
    ay = put(body, a, cx, cy, n[PA_X], n[PA_Y], 1)
    body[a, OMEGA] = body[k1, OMEGA]
    for j in range(columns + 1):
        cx = carry_column(body, rate, columns, j, k1, px, py, 0)
        cy = carry_column(body, rate, columns, j, k1, px, py, 1)
        hang_column(body, rate, columns, j, a, cx, cy, rate[k1, 3 * j + 2], ax, ay)
    return SOLVED
