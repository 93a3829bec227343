"""WELDED: body A fixed to K1."""

from __future__ import annotations

import numpy as np

from mbsd.kinematics.groups import carried
from mbsd.kinematics.groups.cases import columns_of, formula
from mbsd.kinematics.groups.groups import FIRST, K1, WELDED, GroupKind, Link, Made, Places, own_angle

P1_X, P1_Y, PA_X, PA_Y, ANGLE = range(5)
"""P on K1, P on A; angle of A against K1 (rad)."""
COS_A, SIN_A = ANGLE, 5
"""In a row of Groups.row: its cosine and sine."""


def welded(at: Places, body: int, links: dict[str, Link]) -> Made:
    """Return a body with a weld."""
    weld = links["W"]
    return WELDED, (body, -1, weld.other, 0), 0, [*at.pin(weld), own_angle(weld)]


def _row(n: np.ndarray) -> list[np.ndarray]:
    return [*n[:ANGLE], np.cos(n[ANGLE]), np.sin(n[ANGLE])]


KIND = GroupKind(WELDED, "welded", _row, one=("W",), of_one=welded, follows=((0, ANGLE, K1),))


@formula
def solve_welded(case, e):
    """Place the body of group e and fill its rates. See prp.solve_prp."""
    bodies = case.group[e]
    n = case.number[e]
    body = case.body
    a = bodies[FIRST]
    k1 = bodies[K1]
    columns = columns_of(case)
    px = carried.turned_x(body, k1, n[P1_X], n[P1_Y])
    py = carried.turned_y(body, k1, n[P1_X], n[P1_Y])
    carried.turn_as(body, a, k1, n[COS_A], n[SIN_A])
    cx = body[k1, carried.X] + px
    cy = body[k1, carried.Y] + py
    ax = carried.place_by_point(body, a, cx, cy, n[PA_X], n[PA_Y], 0)
    ay = carried.place_by_point(body, a, cx, cy, n[PA_X], n[PA_Y], 1)
    body[a, carried.OMEGA] = body[k1, carried.OMEGA]
    for j in range(columns + 1):
        cx = carried.carry_column(body, case.rate, columns, j, k1, px, py, 0)
        cy = carried.carry_column(body, case.rate, columns, j, k1, px, py, 1)
        carried.hang_column(body, case.rate, columns, j, a, cx, cy, case.rate[k1, 3 * j + 2], ax, ay)
    return carried.SOLVED
