"""SLIDE: A slides on K1 as far as a driver says, or a coordinate.

S = S_0 + f g; k the point S as K1 carries it:

    S' = k' + f' g,   S'' = k'' + 2 omega_K f' g_perp + f'' g
"""

from __future__ import annotations

import math

import numpy as np

from mbsd.compiling.jit import inlined, lazy
from mbsd.kinematics.groups.carrying.by_column import carry_column, hang_column, put, turn_as, turned_x, turned_y
from mbsd.kinematics.groups.carrying.columns import OMEGA, SPEED, VALUE, X, Y
from mbsd.kinematics.groups.carrying.places import point_of, put_on, turn_with
from mbsd.kinematics.groups.carrying.rates import SOLVED, carried, follow, hang
from mbsd.kinematics.groups.groups import COORDINATE, FIRST, K1, LAW, SLIDE
from mbsd.kinematics.groups.kind import GroupKind, Made
from mbsd.kinematics.groups.links import Link, Places, turned

S1_X, S1_Y, G_X, G_Y, ANGLE, SA_X, SA_Y = range(7)
"""S_0 on K1, g there, which is the way for each unit of the law, angle of A against K1, S on A."""
COS_A, SIN_A = ANGLE, 7
"""For columns of B: cosine and sine of that angle."""
ACROSS = 1e-9
"""Cosine of the angle between the slide and the driver below which it drives nothing."""


def driven_slide(at: Places, a: int, links: dict[str, Link]) -> Made | None:
    """A sliding body whose way along the slide is driven."""
    slide, drive = links["P"], links["A"]
    if drive.other != slide.other:
        return None
    point = at.arm(drive.here)
    x, y, ex, ey, angle = at.on_slide(slide, point)
    u = -turned(at.axis(drive.here), angle) if drive.first else np.array(at.axis(drive.there))
    along = float(u @ (ex, ey))
    if abs(along) < ACROSS:
        return None
    way = np.array([ex, ey]) / along
    base = np.array([x, y]) - way * float(u @ (np.array([x, y]) - at.arm(drive.there)))
    return SLIDE, (a, -1, slide.other, 0), drive.motion, [float(v) for v in (*base, *way, angle, *point)]


def _embedded(n: list[float]) -> list[float]:
    return [*n[:ANGLE], math.cos(n[ANGLE]), *n[SA_X:SIN_A], math.sin(n[ANGLE])]


KIND = GroupKind(SLIDE, "driven slide", _embedded, one=("AP",), of_one=driven_slide, angles=((0, ANGLE),))


@lazy(int)
def solve_slide(bodies, n, law, qk, vk, ak, turn, point):
    """Positions and rates; law (3,): f and its rates. See prp.solve_prp."""
    p = point[0]
    k1 = bodies[K1]
    gx = turn[k1, 0] * n[G_X] - turn[k1, 1] * n[G_Y]
    gy = turn[k1, 1] * n[G_X] + turn[k1, 0] * n[G_Y]
    carried(qk, vk, ak, turn, k1, n[S1_X] + law[0] * n[G_X], n[S1_Y] + law[0] * n[G_Y], p)
    spin = 2.0 * vk[3 * k1 + 2] * law[1]
    p[2] += law[1] * gx
    p[3] += law[1] * gy
    p[4] += law[2] * gx - spin * gy
    p[5] += law[2] * gy + spin * gx
    follow(qk, vk, ak, turn, bodies[FIRST], k1, n[ANGLE])
    hang(qk, vk, ak, turn, bodies[FIRST], p, n[SA_X], n[SA_Y])
    return SOLVED


@inlined
def place_slide(bodies, n, driven, turn_a, place, p):
    """Places alone; driven (2,): f first; turn_a (2,): cosine and sine of the angle. See rrr.place_rrr."""
    a = bodies[FIRST]
    k1 = bodies[K1]
    way = driven[0]
    point_of(place, k1, n[S1_X] + way * n[G_X], n[S1_Y] + way * n[G_Y], p)
    turn_with(place, a, k1, turn_a)
    put_on(place, a, p[0], p[1], n[SA_X], n[SA_Y])


@lazy(int)
def embed_slide(bodies, n, body, rate, coordinate, drive):
    """Positions and columns of B. See prp.embed_prp."""
    a = bodies[FIRST]
    k1 = bodies[K1]
    law = bodies[LAW]
    column = bodies[COORDINATE]
    columns = coordinate.shape[0] - 1
    gx = turned_x(body, k1, n[G_X], n[G_Y])
    gy = turned_y(body, k1, n[G_X], n[G_Y])
    way = coordinate[column, VALUE] if column >= 0 else drive[law, 0]
    px = turned_x(body, k1, n[S1_X], n[S1_Y]) + way * gx
    py = turned_y(body, k1, n[S1_X], n[S1_Y]) + way * gy
    turn_as(body, a, k1, n[COS_A], n[SIN_A])
    cx = body[k1, X] + px
    cy = body[k1, Y] + py
    ax = put(body, a, cx, cy, n[SA_X], n[SA_Y], 0)
    ay = put(body, a, cx, cy, n[SA_X], n[SA_Y], 1)
    body[a, OMEGA] = body[k1, OMEGA]
    for j in range(columns + 1):
        cx = carry_column(body, rate, columns, j, k1, px, py, 0)
        cy = carry_column(body, rate, columns, j, k1, px, py, 1)
        slip = 0.0
        if j == column:
            slip = 1.0
        elif law > 0 and j == columns - 1:
            slip = drive[law, 1]
        elif j == columns:
            slip = drive[law, 2]
            twice = 2.0 * body[k1, OMEGA] * (coordinate[column, SPEED] if column >= 0 else drive[law, 1])
            cx -= twice * gy
            cy += twice * gx
        hang_column(body, rate, columns, j, a, cx + slip * gx, cy + slip * gy, rate[k1, 3 * j + 2], ax, ay)
    return SOLVED
