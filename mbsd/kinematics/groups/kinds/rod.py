"""ROD: A pinned to K1 at P, a rod or actuator holds the distance l from C of A to Q of K2.

C where the circles about P and Q meet; u = C - P, w = C - Q, |w| = l:

    omega w . u_perp = l l' + w . (q' - p')
    alpha w . u_perp = l'^2 + l l'' - |w'|^2 + w . (q'' - p'' + omega^2 u)
"""

from __future__ import annotations

import math

import numpy as np

from mbsd.kinematics.groups import carried
from mbsd.kinematics.groups.cases import (
    branch_of,
    columns_of,
    formula,
    law_rate,
    note_change,
    reached,
    speed_of,
    value_of,
)
from mbsd.kinematics.groups.groups import FIRST, K1, K2, LAW, ROD, GroupKind, Link, Made, Places, line

P1_X, P1_Y, PA_X, PA_Y, CA_X, CA_Y, Q2_X, Q2_Y, LENGTH, BRANCH = range(10)
"""P on K1, P on A, C on A, Q on K2, constant length beside the law's, sign of the root."""
UA_X, UA_Y, SQUARE = CA_X, CA_Y, BRANCH
"""In a row of Groups.row: u / a^2 on A, a^2; a = |u|."""


def rod(at: Places, a: int, links: dict[str, Link]) -> Made:
    """Return a pinned body held by a rod or an actuator."""
    pin, held = links["R"], links["L"]
    numbers = [*at.pin(pin), *at.arm(held.here), *at.arm(held.there), held.offset]
    p, q = at.world(a, numbers[PA_X:CA_X]), at.world(held.other, numbers[Q2_X:LENGTH])
    branch = at.side_of(p, q, at.world(a, numbers[CA_X:Q2_X]))
    return ROD, (a, -1, pin.other, held.other), held.motion, [*numbers, branch]


def _row(n: np.ndarray) -> list[np.ndarray]:
    on_a, square = line(n[CA_X] - n[PA_X], n[CA_Y] - n[PA_Y])
    return [*n[:CA_X], *on_a, *n[Q2_X:BRANCH], square]


KIND = GroupKind(ROD, "rod", _row, one=("LR",), of_one=rod, branch=BRANCH, watched=1)


@formula
def solve_rod(case, e):
    """Place the body of group e and fill its rates. See prp.solve_prp."""
    bodies = case.group[e]
    n = case.number[e]
    body = case.body
    rate = case.rate
    a = bodies[FIRST]
    k1 = bodies[K1]
    k2 = bodies[K2]
    law = bodies[LAW]
    columns = columns_of(case)
    px = carried.turned_x(body, k1, n[P1_X], n[P1_Y])
    py = carried.turned_y(body, k1, n[P1_X], n[P1_Y])
    qx = carried.turned_x(body, k2, n[Q2_X], n[Q2_Y])
    qy = carried.turned_y(body, k2, n[Q2_X], n[Q2_Y])
    cx = body[k1, carried.X] + px
    cy = body[k1, carried.Y] + py
    dx = body[k2, carried.X] + qx - cx
    dy = body[k2, carried.Y] + qy - cy
    rod = n[LENGTH] + value_of(case, e, law, -1)
    square = dx * dx + dy * dy
    half = 0.5 * (square + n[SQUARE] - rod * rod)
    left = n[SQUARE] * square - half * half
    scale = n[SQUARE] * rod * rod
    n[carried.SINE] = left / scale
    state = reached(case, n)
    if state != carried.SOLVED:
        return state
    cross = math.sqrt(left)
    sign = branch_of(case, n, a, n[SQUARE] * n[UA_X], n[SQUARE] * n[UA_Y], -dy, dx, cross)
    if sign == 0.0:
        return carried.DOUBTED
    cross *= sign
    ux = (half * dx - cross * dy) / square
    uy = (half * dy + cross * dx) / square
    wx = ux - dx
    wy = uy - dy
    body[a, carried.COS] = ux * n[UA_X] + uy * n[UA_Y]
    body[a, carried.SIN] = uy * n[UA_X] - ux * n[UA_Y]
    ax = carried.place_by_point(body, a, cx, cy, n[PA_X], n[PA_Y], 0)
    ay = carried.place_by_point(body, a, cx, cy, n[PA_X], n[PA_Y], 1)
    lever = 1.0 / (wy * ux - wx * uy)
    turning = 0.0
    past_x = 0.0
    past_y = 0.0
    for j in range(columns + 1):
        cx = carried.carry_column(body, rate, columns, j, k1, px, py, 0)
        cy = carried.carry_column(body, rate, columns, j, k1, px, py, 1)
        fx = carried.carry_column(body, rate, columns, j, k2, qx, qy, 0) - cx
        fy = carried.carry_column(body, rate, columns, j, k2, qx, qy, 1) - cy
        change = 0.0
        if j == columns:
            body[a, carried.OMEGA] = turning
            growing = rod * law_rate(case, law, 1)
            approach = dx * past_x + dy * past_y
            note_change(
                case,
                n,
                (2.0 * n[SQUARE] * approach - 2.0 * half * (approach - growing)) / scale
                - 2.0 * n[carried.SINE] * growing / (rod * rod),
            )
            past_x = -turning * uy - past_x
            past_y = turning * ux - past_y
            fx += turning * turning * ux
            fy += turning * turning * uy
            change = law_rate(case, law, 1) * law_rate(case, law, 1) + rod * law_rate(case, law, 2)
            change -= past_x * past_x + past_y * past_y
        elif j == columns - 1 and law > 0:
            change = rod * law_rate(case, law, 1)
        omega = (change + wx * fx + wy * fy) * lever
        if j < columns:
            turning += omega * speed_of(case, j)
            past_x += fx * speed_of(case, j)
            past_y += fy * speed_of(case, j)
        carried.hang_column(body, rate, columns, j, a, cx, cy, omega, ax, ay)
    return carried.SOLVED
