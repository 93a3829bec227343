"""PRP: A slides on K1, pinned at C to B, which slides on K2; or C of A in a slot of K2 (B: -1).

C = C_1 + s_1 e_1 = C_2 + s_2 e_2 where two slides cross; c_i the point C as K_i carries it:

    s_1' e_1 - s_2' e_2 = c_2' - c_1'
    s_1'' e_1 - s_2'' e_2 = c_2'' + 2 omega_2 s_2' e_2_perp - c_1'' - 2 omega_1 s_1' e_1_perp
"""

from __future__ import annotations

import numpy as np

from mbsd.kinematics.groups import carried
from mbsd.kinematics.groups.cases import columns_of, formula, note_change, reached, speed_of
from mbsd.kinematics.groups.groups import FIRST, K1, K2, PRP, SECOND, GroupKind, Link, Made, Places

C1_X, C1_Y, E1_X, E1_Y, ANGLE_A, CA_X, CA_Y, C2_X, C2_Y, E2_X, E2_Y, ANGLE_B, CB_X, CB_Y = range(14)
"""C_1 and e_1 on K1, angle of A against K1, C on A; C_2 and e_2 on K2, angle of B against K2, C on B."""
COS_A, SIN_A, COS_B, SIN_B = ANGLE_A, 14, ANGLE_B, 15
"""In a row of Groups.row: cosines and sines of these angles."""
PARALLEL = 1e-6
"""Sine of the angle between two slides below which they do not cross."""
NEARLY_PARALLEL = 1e-3
"""The same below which their crossing is in doubt, where it is not solved with rates."""


def in_slot(at: Places, a: int, links: dict[str, Link]) -> Made | None:
    """Return a sliding body whose point runs in a slot of a known one."""
    slide, slot = links["P"], links["S"]
    if slot.first:
        return None
    return _group(
        at, a, -1, slide, at.arm(slot.here), slot.other, [*at.arm(slot.there), *at.axis(slot.there), 0.0, 0.0, 0.0]
    )


def two_slides(at: Places, a: int, b: int, slide: Link, inner: Link, second: Link) -> Made:
    """Return two sliding bodies pinned to each other."""
    arm = at.arm(inner.there)
    return _group(at, a, b, slide, at.arm(inner.here), second.other, [*at.on_slide(second, arm), *arm])


def _group(at: Places, a: int, b: int, slide: Link, arm: list[float], k2: int, second: list[float]) -> Made:
    numbers = [*at.on_slide(slide, arm), *arm, *second]
    return PRP, (a, b, slide.other, k2), 0, [float(number) for number in numbers]


def _row(n: np.ndarray) -> list[np.ndarray]:
    a, b = n[ANGLE_A], n[ANGLE_B]
    return [*n[:ANGLE_A], np.cos(a), *n[CA_X:ANGLE_B], np.cos(b), *n[CB_X:SIN_A], np.sin(a), np.sin(b)]


KIND = GroupKind(
    PRP,
    "PRP",
    _row,
    one=("PS",),
    of_one=in_slot,
    two=("PRP",),
    of_two=two_slides,
    follows=((0, ANGLE_A, K1), (1, ANGLE_B, K2)),
    watched=1,
)


@formula
def solve_prp(case, e):
    """Place the bodies of group e and fill their rates; return SOLVED, or why not.

    ``case`` says what for: a record of cases.py, with the tables of all groups and bodies. ``body`` takes
    poses and ``rate`` the rates for each column, of which the last are accelerations. ``number[e, SINE]`` takes the
    squared sine that vanishes where the two poses of the group meet.
    """
    bodies = case.group[e]
    n = case.number[e]
    body = case.body
    rate = case.rate
    a = bodies[FIRST]
    b = bodies[SECOND]
    k1 = bodies[K1]
    k2 = bodies[K2]
    columns = columns_of(case)
    px = carried.turned_x(body, k1, n[C1_X], n[C1_Y])
    py = carried.turned_y(body, k1, n[C1_X], n[C1_Y])
    ex = carried.turned_x(body, k1, n[E1_X], n[E1_Y])
    ey = carried.turned_y(body, k1, n[E1_X], n[E1_Y])
    qx = carried.turned_x(body, k2, n[C2_X], n[C2_Y])
    qy = carried.turned_y(body, k2, n[C2_X], n[C2_Y])
    fx = carried.turned_x(body, k2, n[E2_X], n[E2_Y])
    fy = carried.turned_y(body, k2, n[E2_X], n[E2_Y])
    sine = fx * ey - fy * ex
    n[carried.SINE] = sine * sine
    state = reached(case, n)
    if state != carried.SOLVED:
        return state
    inverse = 1.0 / sine
    dx = body[k2, carried.X] + qx - body[k1, carried.X] - px
    dy = body[k2, carried.Y] + qy - body[k1, carried.Y] - py
    first = (fx * dy - fy * dx) * inverse
    second = (ex * dy - ey * dx) * inverse
    px += first * ex
    py += first * ey
    qx += second * fx
    qy += second * fy
    carried.turn_as(body, a, k1, n[COS_A], n[SIN_A])
    tx = body[k1, carried.X] + px
    ty = body[k1, carried.Y] + py
    ax = carried.place_by_point(body, a, tx, ty, n[CA_X], n[CA_Y], 0)
    ay = carried.place_by_point(body, a, tx, ty, n[CA_X], n[CA_Y], 1)
    body[a, carried.OMEGA] = body[k1, carried.OMEGA]
    bx = 0.0
    by = 0.0
    if b >= 0:
        carried.turn_as(body, b, k2, n[COS_B], n[SIN_B])
        bx = carried.place_by_point(body, b, tx, ty, n[CB_X], n[CB_Y], 0)
        by = carried.place_by_point(body, b, tx, ty, n[CB_X], n[CB_Y], 1)
        body[b, carried.OMEGA] = body[k2, carried.OMEGA]
    note_change(case, n, 2.0 * sine * (fx * ex + fy * ey) * (body[k1, carried.OMEGA] - body[k2, carried.OMEGA]))
    slip1 = 0.0
    slip2 = 0.0
    for j in range(columns + 1):
        cx = carried.carry_column(body, rate, columns, j, k1, px, py, 0)
        cy = carried.carry_column(body, rate, columns, j, k1, px, py, 1)
        tx = carried.carry_column(body, rate, columns, j, k2, qx, qy, 0)
        ty = carried.carry_column(body, rate, columns, j, k2, qx, qy, 1)
        if j == columns:
            twice = 2.0 * body[k1, carried.OMEGA] * slip1
            cx -= twice * ey
            cy += twice * ex
            twice = 2.0 * body[k2, carried.OMEGA] * slip2
            tx -= twice * fy
            ty += twice * fx
        dx = tx - cx
        dy = ty - cy
        along = (fx * dy - fy * dx) * inverse
        if j < columns:
            slip1 += along * speed_of(case, j)
            slip2 += (ex * dy - ey * dx) * inverse * speed_of(case, j)
        gx = cx + along * ex
        gy = cy + along * ey
        carried.hang_column(body, rate, columns, j, a, gx, gy, rate[k1, 3 * j + 2], ax, ay)
        if b >= 0:
            carried.hang_column(body, rate, columns, j, b, gx, gy, rate[k2, 3 * j + 2], bx, by)
    return carried.SOLVED
