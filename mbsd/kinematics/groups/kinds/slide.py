"""SLIDE: A slides on K1 as far as a driver says, or a coordinate.

S = S_0 + f g; k the point S as K1 carries it:

    S' = k' + f' g,   S'' = k'' + 2 omega_K f' g_perp + f'' g
"""

from __future__ import annotations

import numpy as np

from mbsd.kinematics.groups import carried
from mbsd.kinematics.groups.cases import columns_of, formula, law_rate, speed_of, value_of
from mbsd.kinematics.groups.groups import COORDINATE, FIRST, K1, LAW, SLIDE, GroupKind, Link, Made, Places, turned

S1_X, S1_Y, G_X, G_Y, ANGLE, SA_X, SA_Y = range(7)
"""S_0 on K1, g there, which is the way for each unit of the law, angle of A against K1, S on A."""
COS_A, SIN_A = ANGLE, 7
"""In a row of Groups.row: cosine and sine of that angle."""
ACROSS = 1e-9
"""Cosine of the angle between the slide and the driver below which it drives nothing."""


def driven_slide(at: Places, a: int, links: dict[str, Link]) -> Made | None:
    """Return a sliding body whose way along the slide is driven."""
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


def _row(n: np.ndarray) -> list[np.ndarray]:
    return [*n[:ANGLE], np.cos(n[ANGLE]), *n[SA_X:SIN_A], np.sin(n[ANGLE])]


KIND = GroupKind(SLIDE, "driven slide", _row, one=("AP",), of_one=driven_slide, follows=((0, ANGLE, K1),))


@formula
def solve_slide(case, e):
    """Place the body of group e and fill its rates. See prp.solve_prp."""
    bodies = case.group[e]
    n = case.number[e]
    body = case.body
    rate = case.rate
    a = bodies[FIRST]
    k1 = bodies[K1]
    law = bodies[LAW]
    column = bodies[COORDINATE]
    columns = columns_of(case)
    gx = carried.turned_x(body, k1, n[G_X], n[G_Y])
    gy = carried.turned_y(body, k1, n[G_X], n[G_Y])
    way = value_of(case, e, law, column)
    px = carried.turned_x(body, k1, n[S1_X], n[S1_Y]) + way * gx
    py = carried.turned_y(body, k1, n[S1_X], n[S1_Y]) + way * gy
    carried.turn_as(body, a, k1, n[COS_A], n[SIN_A])
    cx = body[k1, carried.X] + px
    cy = body[k1, carried.Y] + py
    ax = carried.place_by_point(body, a, cx, cy, n[SA_X], n[SA_Y], 0)
    ay = carried.place_by_point(body, a, cx, cy, n[SA_X], n[SA_Y], 1)
    body[a, carried.OMEGA] = body[k1, carried.OMEGA]
    sliding = 0.0
    for j in range(columns + 1):
        cx = carried.carry_column(body, rate, columns, j, k1, px, py, 0)
        cy = carried.carry_column(body, rate, columns, j, k1, px, py, 1)
        slip = 0.0
        if j == column:
            slip = 1.0
        elif law > 0 and j == columns - 1:
            slip = law_rate(case, law, 1)
        elif j == columns:
            slip = law_rate(case, law, 2)
            twice = 2.0 * body[k1, carried.OMEGA] * sliding
            cx -= twice * gy
            cy += twice * gx
        if j < columns:
            sliding += slip * speed_of(case, j)
        carried.hang_column(body, rate, columns, j, a, cx + slip * gx, cy + slip * gy, rate[k1, 3 * j + 2], ax, ay)
    return carried.SOLVED
