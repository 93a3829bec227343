"""YOKE: A slides on K1, point Q of K2 runs in a slot of A.

n . (Q - S_0 - s e) = 0, n the normal of the slot; k the point Q as K1 carries it:

    s' n.e = n . (q' - k'),   s'' n.e = n . (q'' - k'' - 2 omega_K (q' - k')_perp)
"""

from __future__ import annotations

import numpy as np

from mbsd.kinematics.groups import carried
from mbsd.kinematics.groups.cases import columns_of, formula, speed_of
from mbsd.kinematics.groups.groups import FIRST, K1, K2, YOKE, GroupKind, Link, Made, Places, cross, turned

S1_X, S1_Y, E_X, E_Y, N_X, N_Y, Q2_X, Q2_Y, ANGLE, SA_X, SA_Y = range(11)
"""S_0, e and n on K1, Q on K2, angle of A against K1, the slot's point on A."""
COS_A, SIN_A = ANGLE, 11
"""In a row of Groups.row: cosine and sine of that angle."""
PARALLEL = 1e-9
"""Sine of the angle between slide and slot below which they make no group."""


def yoke(at: Places, a: int, links: dict[str, Link]) -> Made | None:
    """Return a sliding body in whose slot a point of a known body runs."""
    slide, slot = links["P"], links["S"]
    if not slot.first:
        return None
    slot_on_a = at.arm(slot.here)
    x, y, e_x, e_y, angle = at.on_slide(slide, slot_on_a)
    u = turned(at.axis(slot.here), angle)
    if abs(cross(u, np.array([e_x, e_y]))) < PARALLEL:
        return None
    numbers = [x, y, e_x, e_y, -u[1], u[0], *at.arm(slot.there), angle, *slot_on_a]
    return YOKE, (a, -1, slide.other, slot.other), 0, [float(number) for number in numbers]


def _row(n: np.ndarray) -> list[np.ndarray]:
    return [*n[:ANGLE], np.cos(n[ANGLE]), *n[SA_X:SIN_A], np.sin(n[ANGLE])]


KIND = GroupKind(YOKE, "yoke", _row, one=("PS",), of_one=yoke, follows=((0, ANGLE, K1),), watched=1)


@formula
def solve_yoke(case, e):
    """Place the body of group e and fill its rates. See prp.solve_prp."""
    bodies = case.group[e]
    n = case.number[e]
    body = case.body
    rate = case.rate
    a = bodies[FIRST]
    k1 = bodies[K1]
    k2 = bodies[K2]
    columns = columns_of(case)
    px = carried.turned_x(body, k1, n[S1_X], n[S1_Y])
    py = carried.turned_y(body, k1, n[S1_X], n[S1_Y])
    ex = carried.turned_x(body, k1, n[E_X], n[E_Y])
    ey = carried.turned_y(body, k1, n[E_X], n[E_Y])
    nx = carried.turned_x(body, k1, n[N_X], n[N_Y])
    ny = carried.turned_y(body, k1, n[N_X], n[N_Y])
    qx = carried.turned_x(body, k2, n[Q2_X], n[Q2_Y])
    qy = carried.turned_y(body, k2, n[Q2_X], n[Q2_Y])
    dx = body[k2, carried.X] + qx - body[k1, carried.X] - px
    dy = body[k2, carried.Y] + qy - body[k1, carried.Y] - py
    inverse = 1.0 / (nx * ex + ny * ey)
    slide = (nx * dx + ny * dy) * inverse
    sx = px + slide * ex
    sy = py + slide * ey
    gx = px + dx
    gy = py + dy
    carried.turn_as(body, a, k1, n[COS_A], n[SIN_A])
    tx = body[k1, carried.X] + sx
    ty = body[k1, carried.Y] + sy
    ax = carried.place_by_point(body, a, tx, ty, n[SA_X], n[SA_Y], 0)
    ay = carried.place_by_point(body, a, tx, ty, n[SA_X], n[SA_Y], 1)
    spin = body[k1, carried.OMEGA]
    body[a, carried.OMEGA] = spin
    sliding = 0.0
    past_x = 0.0
    past_y = 0.0
    for j in range(columns + 1):
        fx = carried.carry_column(body, rate, columns, j, k2, qx, qy, 0) - carried.carry_column(
            body, rate, columns, j, k1, gx, gy, 0
        )
        fy = carried.carry_column(body, rate, columns, j, k2, qx, qy, 1) - carried.carry_column(
            body, rate, columns, j, k1, gx, gy, 1
        )
        tx = carried.carry_column(body, rate, columns, j, k1, sx, sy, 0)
        ty = carried.carry_column(body, rate, columns, j, k1, sx, sy, 1)
        if j == columns:
            fx += 2.0 * spin * past_y
            fy -= 2.0 * spin * past_x
            tx -= 2.0 * spin * sliding * ey
            ty += 2.0 * spin * sliding * ex
        slip = (nx * fx + ny * fy) * inverse
        if j < columns:
            sliding += slip * speed_of(case, j)
            past_x += fx * speed_of(case, j)
            past_y += fy * speed_of(case, j)
        carried.hang_column(body, rate, columns, j, a, tx + slip * ex, ty + slip * ey, rate[k1, 3 * j + 2], ax, ay)
    return carried.SOLVED
