"""DRIVEN: body A pinned to K1, its angle given against K2 by a driver, or a coordinate.

theta_A = theta_K2 + s (offset + f),   s: 1 or -1;   P of A stays on P of K1
"""

from __future__ import annotations

import math

from mbsd.compiling.alternatives import alternatives
from mbsd.compiling.jit import internal, merged
from mbsd.kinematics.groups.carried import COS, OMEGA, SIN, SOLVED, X, Y
from mbsd.kinematics.groups.cases import AlongLaws, PerCoordinate, PoseAlone, columns_of, law_rate, speed_of, value_of
from mbsd.kinematics.groups.groups import COORDINATE, DRIVEN, FIRST, K1, K2, LAW, GroupKind, Link, Made, Places

P1_X, P1_Y, PA_X, PA_Y, OFFSET, SENSE = range(6)
"""P on K1, P on A; constant of the driver (rad), s."""


def driven(at: Places, body: int, links: dict[str, Link]) -> Made:
    """Return a body with a pin and a driver of its angle."""
    pin, drive = links["R"], links["D"]
    sense = -1.0 if drive.first else 1.0
    return DRIVEN, (body, -1, pin.other, drive.other), drive.motion, [*at.pin(pin), drive.offset, sense]


KIND = GroupKind(DRIVEN, "driven", lambda n: [*n[:6]], one=("DR",), of_one=driven, follows=((0, OFFSET, K2),))


@merged
def solve_driven(case, e):
    """Place the body of group e and fill its rates. See prp.solve_prp."""
    bodies = case.group[e]
    n = case.number[e]
    body = case.body
    rate = case.rate
    a = bodies[FIRST]
    k1 = bodies[K1]
    k2 = bodies[K2]
    law = bodies[LAW]
    column = bodies[COORDINATE]
    columns = columns_of(case)
    c = body[k1, COS]
    s = body[k1, SIN]
    px = c * n[P1_X] - s * n[P1_Y]
    py = s * n[P1_X] + c * n[P1_Y]
    qx, qy = turn_rydriver(case, e, law, column, n)
    dx = body[k2, COS]
    dy = body[k2, SIN]
    c = dx * qx - dy * qy
    s = dy * qx + dx * qy
    body[a, COS] = c
    body[a, SIN] = s
    ax = c * n[PA_X] - s * n[PA_Y]
    ay = s * n[PA_X] + c * n[PA_Y]
    body[a, X] = body[k1, X] + px - ax
    body[a, Y] = body[k1, Y] + py - ay
    if columns < 0:
        return SOLVED
    turning = 0.0
    for j in range(columns):
        at = 3 * j
        omega = rate[k1, at + 2]
        cx = rate[k1, at] - omega * py
        cy = rate[k1, at + 1] + omega * px
        omega = rate[k2, at + 2]
        if j == column:
            omega += n[SENSE]
        elif j == columns - 1 and law > 0:
            omega += n[SENSE] * law_rate(case, law, 1)
        turning += omega * speed_of(case, j)
        rate[a, at] = cx + omega * ay
        rate[a, at + 1] = cy - omega * ax
        rate[a, at + 2] = omega
    body[a, OMEGA] = turning
    turning *= turning
    at = 3 * columns
    omega = rate[k1, at + 2]
    square = body[k1, OMEGA] * body[k1, OMEGA]
    cx = rate[k1, at] - omega * py - square * px
    cy = rate[k1, at + 1] + omega * px - square * py
    omega = rate[k2, at + 2]
    if law > 0:
        omega += n[SENSE] * law_rate(case, law, 2)
    rate[a, at] = cx + omega * ay + turning * ax
    rate[a, at + 1] = cy - omega * ax + turning * ay
    rate[a, at + 2] = omega
    return SOLVED


@internal
def _tabulated(case, e, law, column, n):
    return case.driven[e, 0], case.driven[e, 1]


@internal
def _evaluated(case, e, law, column, n):
    angle = n[SENSE] * (n[OFFSET] + value_of(case, e, law, column))
    return math.cos(angle), math.sin(angle)


turn_rydriver = alternatives({PoseAlone: _tabulated, AlongLaws: _evaluated, PerCoordinate: _evaluated})
"""Cosine and sine of s (offset + f)."""
