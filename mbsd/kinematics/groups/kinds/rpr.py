"""RPR: A pinned to K1 at P, B to K2 at Q, B slides on A; or Q of K2 in a slot of A (B: -1).

|Q - P|^2 = t^2 + offset^2; d = Q - P, e the axis of the slide:

    omega d_perp + s' e = q' - p'
    alpha d_perp + s'' e = q'' - p'' + omega^2 d - 2 omega s' e_perp
    D = |Q - P|^2 - offset^2;   D' = 2 (Q - P) . (q' - p')
"""

from __future__ import annotations

import math

import numpy as np

from mbsd.kinematics.groups import carried, groups
from mbsd.kinematics.groups.cases import branch_of, columns_of, formula, note_change, reached, speed_of, too_short
from mbsd.kinematics.groups.groups import Bodies, GroupKind, Link, Made, Places, Vector, own_angle, turned

P1_X, P1_Y, PA_X, PA_Y, E_X, E_Y, OFFSET, Q2_X, Q2_Y, ANGLE, QB_X, QB_Y, BRANCH = range(13)
"""P on K1, P on A, e on A, offset of Q from it, Q on K2, angle of B against A, Q on B, sign of the root."""
COS_B, SIN_B = ANGLE, BRANCH
"""In a row of Groups.row: cosine and sine of that angle."""


def in_own_slot(at: Places, a: int, links: dict[str, Link]) -> Made | None:
    """Return a pinned body in whose slot a point of a known one runs."""
    pin, slot = links["R"], links["S"]
    if not slot.first:
        return None
    start = np.array(at.arm(slot.here)) - at.arm(pin.here)
    return _group(
        at, (a, -1, pin.other, slot.other), pin, at.axis(slot.here), start, at.arm(slot.there), 0.0, [0.0, 0.0]
    )


def on_each_other(at: Places, a: int, b: int, pin: Link, slide: Link, outer: Link) -> Made:
    """Return two pinned bodies of which one slides on the other."""
    angle = -own_angle(slide)
    axis = at.axis(slide.here) if slide.first else turned(at.axis(slide.there), angle)
    q_on_b = at.arm(outer.here)
    reach = turned(np.array(q_on_b) - at.arm(slide.there), angle)
    start = np.array(at.arm(slide.here)) - at.arm(pin.here) + reach
    return _group(at, (a, b, pin.other, outer.other), pin, axis, start, at.arm(outer.there), angle, q_on_b)


def _group(
    at: Places,
    bodies: Bodies,
    pin: Link,
    axis: Vector | np.ndarray,
    start: np.ndarray,
    q_on_k2: list[float],
    angle: float,
    q_on_b: list[float],
) -> Made:
    a, _, _, k2 = bodies
    offset = axis[0] * start[1] - axis[1] * start[0]
    numbers = [float(x) for x in (*at.pin(pin), *axis, offset, *q_on_k2, angle, *q_on_b)]
    reach = at.world(k2, q_on_k2) - at.world(a, numbers[PA_X:E_X])
    branch = math.copysign(1.0, float(np.dot(reach, at.along(a, axis))))
    return groups.RPR, bodies, 0, [*numbers, branch]


def _row(n: np.ndarray) -> list[np.ndarray]:
    return [*n[:ANGLE], np.cos(n[ANGLE]), *n[QB_X:BRANCH], np.sin(n[ANGLE])]


KIND = GroupKind(
    groups.RPR,
    "RPR",
    _row,
    one=("RS",),
    of_one=in_own_slot,
    two=("RPR",),
    of_two=on_each_other,
    branch=BRANCH,
    follows=((1, ANGLE, groups.FIRST),),
    watched=1,
)


@formula
def solve_rpr(case, e):
    """Place the bodies of group e and fill their rates. See prp.solve_prp."""
    bodies = case.group[e]
    n = case.number[e]
    body = case.body
    rate = case.rate
    a = bodies[groups.FIRST]
    b = bodies[groups.SECOND]
    k1 = bodies[groups.K1]
    k2 = bodies[groups.K2]
    columns = columns_of(case)
    px = carried.turned_x(body, k1, n[P1_X], n[P1_Y])
    py = carried.turned_y(body, k1, n[P1_X], n[P1_Y])
    qx = carried.turned_x(body, k2, n[Q2_X], n[Q2_Y])
    qy = carried.turned_y(body, k2, n[Q2_X], n[Q2_Y])
    cx = body[k1, carried.X] + px
    cy = body[k1, carried.Y] + py
    tx = body[k2, carried.X] + qx
    ty = body[k2, carried.Y] + qy
    dx = tx - cx
    dy = ty - cy
    square = dx * dx + dy * dy
    left = square - n[OFFSET] * n[OFFSET]
    n[carried.SINE] = left / square if square > 0.0 else 0.0
    state = reached(case, n)
    if too_short(case, left):
        state = min(state, carried.MEETING)
    if state != carried.SOLVED:
        return state
    root = math.sqrt(left)
    sign = branch_of(case, n, a, n[E_X], n[E_Y], dx, dy, root)
    if sign == 0.0:
        return carried.DOUBTED
    root *= sign
    # the axis and its normal in the group's frame: d = root e + offset e_perp
    inverse = 1.0 / square
    ex = (root * dx + n[OFFSET] * dy) * inverse
    ey = (root * dy - n[OFFSET] * dx) * inverse
    body[a, carried.COS] = ex * n[E_X] + ey * n[E_Y]
    body[a, carried.SIN] = ey * n[E_X] - ex * n[E_Y]
    ax = carried.place_by_point(body, a, cx, cy, n[PA_X], n[PA_Y], 0)
    ay = carried.place_by_point(body, a, cx, cy, n[PA_X], n[PA_Y], 1)
    bx = 0.0
    by = 0.0
    if b >= 0:
        carried.turn_as(body, b, a, n[COS_B], n[SIN_B])
        bx = carried.place_by_point(body, b, tx, ty, n[QB_X], n[QB_Y], 0)
        by = carried.place_by_point(body, b, tx, ty, n[QB_X], n[QB_Y], 1)
    inverse = 1.0 / root
    turning = 0.0
    sliding = 0.0
    for j in range(columns + 1):
        cx = carried.carry_column(body, rate, columns, j, k1, px, py, 0)
        cy = carried.carry_column(body, rate, columns, j, k1, px, py, 1)
        tx = carried.carry_column(body, rate, columns, j, k2, qx, qy, 0)
        ty = carried.carry_column(body, rate, columns, j, k2, qx, qy, 1)
        fx = tx - cx
        fy = ty - cy
        if j == columns:
            body[a, carried.OMEGA] = turning
            if b >= 0:
                body[b, carried.OMEGA] = turning
            note_change(case, n, 2.0 * n[OFFSET] * n[OFFSET] * sliding * root / (square * square))
            fx += turning * turning * dx + 2.0 * turning * sliding * ey
            fy += turning * turning * dy - 2.0 * turning * sliding * ex
        omega = (ex * fy - ey * fx) * inverse
        if j < columns:
            turning += omega * speed_of(case, j)
            sliding += (dx * fx + dy * fy) * inverse * speed_of(case, j)
        carried.hang_column(body, rate, columns, j, a, cx, cy, omega, ax, ay)
        if b >= 0:
            carried.hang_column(body, rate, columns, j, b, tx, ty, omega, bx, by)
    return carried.SOLVED
