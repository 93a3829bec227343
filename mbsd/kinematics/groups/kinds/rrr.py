"""RRR: A pinned to K1 at P, B to K2 at Q, A to B at C, where the circles about P and Q meet.

u = C - P, w = C - Q:

    omega_A u_perp - omega_B w_perp = q' - p'
    alpha_A u_perp - alpha_B w_perp = q'' - p'' + omega_A^2 u - omega_B^2 w
    D = 4 a^2 b^2 - m^2,  m = a^2 + b^2 - |Q - P|^2;   D' = 4 m (Q - P) . (q' - p')     a = |u|, b = |w|

In columns of B  u x w = s |C - P| |C - Q|.
"""

from __future__ import annotations

import math

import numpy as np

from mbsd.compiling.jit import merged
from mbsd.kinematics.groups import carried
from mbsd.kinematics.groups.cases import branch_of, columns_of, note_change, reached, speed_of
from mbsd.kinematics.groups.groups import FIRST, K1, K2, RRR, SECOND, GroupKind, Link, Made, Places, line

P1_X, P1_Y, PA_X, PA_Y, CA_X, CA_Y, Q2_X, Q2_Y, QB_X, QB_Y, CB_X, CB_Y, BRANCH = range(13)
"""P on K1, P on A, C on A, Q on K2, Q on B, C on B, sign of the root."""
UA_X, UA_Y, WB_X, WB_Y = CA_X, CA_Y, CB_X, CB_Y
SQUARE, DIFFERENCE, PER_SQUARES = range(12, 15)
"""In a row of Groups.row: u / a^2 on A, w / b^2 on B, a^2, a^2 - b^2, 1 / (a^2 b^2)."""


def two_pinned(at: Places, a: int, b: int, outer_a: Link, inner: Link, outer_b: Link) -> Made:
    """Return two bodies pinned to known ones and to each other."""
    numbers = [*at.pin(outer_a), *at.arm(inner.here), *at.pin(outer_b), *at.arm(inner.there)]
    p, q = at.world(a, numbers[PA_X:CA_X]), at.world(b, numbers[QB_X:CB_X])
    branch = at.side_of(p, q, at.world(a, numbers[CA_X:Q2_X]))
    return RRR, (a, b, outer_a.other, outer_b.other), 0, [*numbers, branch]


def _row(n: np.ndarray) -> list[np.ndarray]:
    on_a, first = line(n[CA_X] - n[PA_X], n[CA_Y] - n[PA_Y])
    on_b, second = line(n[CB_X] - n[QB_X], n[CB_Y] - n[QB_Y])
    return [*n[:CA_X], *on_a, *n[Q2_X:CB_X], *on_b, first, first - second, 1.0 / (first * second)]


KIND = GroupKind(RRR, "RRR", _row, two=("RRR",), of_two=two_pinned, branch=BRANCH, watched=2)


@merged
def solve_rrr(case, e):
    """Place the bodies of group e and fill their rates. See prp.solve_prp.

    The rates are written out in full, as no other group is as common.
    """
    bodies = case.group[e]
    n = case.number[e]
    body = case.body
    a = bodies[FIRST]
    b = bodies[SECOND]
    k1 = bodies[K1]
    k2 = bodies[K2]
    columns = columns_of(case)
    px = carried.turned_x(body, k1, n[P1_X], n[P1_Y])
    py = carried.turned_y(body, k1, n[P1_X], n[P1_Y])
    qx = carried.turned_x(body, k2, n[Q2_X], n[Q2_Y])
    qy = carried.turned_y(body, k2, n[Q2_X], n[Q2_Y])
    cx = body[k1, carried.X] + px
    cy = body[k1, carried.Y] + py
    ex = body[k2, carried.X] + qx
    ey = body[k2, carried.Y] + qy
    dx = ex - cx
    dy = ey - cy
    square = dx * dx + dy * dy
    half = 0.5 * (square + n[DIFFERENCE])
    cross = n[SQUARE] * square - half * half
    n[carried.SINE] = cross * n[PER_SQUARES]
    state = reached(case, n)
    if state != carried.SOLVED:
        return state
    inverse = 1.0 / square
    cross = math.sqrt(cross)
    sign = branch_of(case, n, a, n[SQUARE] * n[UA_X], n[SQUARE] * n[UA_Y], -dy, dx, cross)
    if sign == 0.0:
        return carried.DOUBTED
    cross *= sign
    det = 1.0 / cross
    along = half * inverse
    cross *= inverse
    ux = along * dx - cross * dy
    uy = along * dy + cross * dx
    wx = ux - dx
    wy = uy - dy
    body[a, carried.COS] = ux * n[UA_X] + uy * n[UA_Y]
    body[a, carried.SIN] = uy * n[UA_X] - ux * n[UA_Y]
    ax = carried.place_by_point(body, a, cx, cy, n[PA_X], n[PA_Y], 0)
    ay = carried.place_by_point(body, a, cx, cy, n[PA_X], n[PA_Y], 1)
    body[b, carried.COS] = wx * n[WB_X] + wy * n[WB_Y]
    body[b, carried.SIN] = wy * n[WB_X] - wx * n[WB_Y]
    bx = carried.place_by_point(body, b, ex, ey, n[QB_X], n[QB_Y], 0)
    by = carried.place_by_point(body, b, ex, ey, n[QB_X], n[QB_Y], 1)
    if columns >= 0:
        fx, fy = rates_of_rrr(case, bodies, columns, (px, py, qx, qy), (ax, ay, bx, by), (ux, uy, wx, wy, det))
        note_change(case, n, 2.0 * (n[SQUARE] - half) * (dx * fx + dy * fy) * n[PER_SQUARES])
    return carried.SOLVED


@merged
def rates_of_rrr(case, bodies, columns, places, arms, links):
    """Fill the rates of both bodies; return q' - p' (x and y) in the last column before accelerations.

    ``places``: P and Q from the centres of K1 and K2. ``arms``: P from the centre of A, Q from that of B. ``links``: u,
    w and 1 / (u x w). All are x and y in world axes (m).
    """
    body = case.body
    rate = case.rate
    a = bodies[FIRST]
    b = bodies[SECOND]
    k1 = bodies[K1]
    k2 = bodies[K2]
    px, py, qx, qy = places
    ax, ay, bx, by = arms
    ux, uy, wx, wy, det = links
    turning_a = 0.0
    turning_b = 0.0
    fx = 0.0
    fy = 0.0
    for j in range(columns):
        at = 3 * j
        omega = rate[k1, at + 2]
        cx = rate[k1, at] - omega * py
        cy = rate[k1, at + 1] + omega * px
        omega = rate[k2, at + 2]
        ex = rate[k2, at] - omega * qy
        ey = rate[k2, at + 1] + omega * qx
        fx = ex - cx
        fy = ey - cy
        omega = (fx * wx + fy * wy) * det
        turning_a += omega * speed_of(case, j)
        rate[a, at] = cx + omega * ay
        rate[a, at + 1] = cy - omega * ax
        rate[a, at + 2] = omega
        omega = (fx * ux + fy * uy) * det
        turning_b += omega * speed_of(case, j)
        rate[b, at] = ex + omega * by
        rate[b, at + 1] = ey - omega * bx
        rate[b, at + 2] = omega
    parting = fx, fy
    body[a, carried.OMEGA] = turning_a
    body[b, carried.OMEGA] = turning_b
    turning_a *= turning_a
    turning_b *= turning_b
    at = 3 * columns
    omega = rate[k1, at + 2]
    square = body[k1, carried.OMEGA] * body[k1, carried.OMEGA]
    cx = rate[k1, at] - omega * py - square * px
    cy = rate[k1, at + 1] + omega * px - square * py
    omega = rate[k2, at + 2]
    square = body[k2, carried.OMEGA] * body[k2, carried.OMEGA]
    ex = rate[k2, at] - omega * qy - square * qx
    ey = rate[k2, at + 1] + omega * qx - square * qy
    fx = ex - cx + turning_a * ux - turning_b * wx
    fy = ey - cy + turning_a * uy - turning_b * wy
    omega = (fx * wx + fy * wy) * det
    rate[a, at] = cx + omega * ay + turning_a * ax
    rate[a, at + 1] = cy - omega * ax + turning_a * ay
    rate[a, at + 2] = omega
    omega = (fx * ux + fy * uy) * det
    rate[b, at] = ex + omega * by + turning_b * bx
    rate[b, at + 1] = ey - omega * bx + turning_b * by
    rate[b, at + 2] = omega
    return parting
