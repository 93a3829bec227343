"""DRIVEN: body A pinned to K1, its angle given against K2 by a driver, or a coordinate.

theta_A = theta_K2 + s (offset + f),   s: 1 or -1;   P of A stays on P of K1
"""

from __future__ import annotations

import math

from mbsd.compiling.jit import inlined, merged
from mbsd.kinematics.groups.carrying.columns import COS, OMEGA, SIN, SPEED, VALUE, X, Y
from mbsd.kinematics.groups.carrying.places import point_of, put_on, turn_with
from mbsd.kinematics.groups.carrying.rates import carried, hang
from mbsd.kinematics.groups.groups import COORDINATE, DRIVEN, FIRST, K1, K2, LAW
from mbsd.kinematics.groups.kind import GroupKind, Made
from mbsd.kinematics.groups.links import Link, Places

P1_X, P1_Y, PA_X, PA_Y, OFFSET, SENSE = range(6)
"""P on K1, P on A; constant of the driver (rad), s."""


def driven(at: Places, body: int, links: dict[str, Link]) -> Made:
    """A body with a pin and a driver of its angle."""
    pin, drive = links["R"], links["D"]
    sense = -1.0 if drive.first else 1.0
    return DRIVEN, (body, -1, pin.other, drive.other), drive.motion, [*at.pin(pin), drive.offset, sense]


KIND = GroupKind(DRIVEN, "driven", lambda n: n[:6], one=("DR",), of_one=driven)


@merged
def solve_driven(bodies, n, law, qk, vk, ak, turn, point):
    """Positions and rates; law (3,): f and its rates. See prp.solve_prp."""
    body = bodies[FIRST]
    k1 = bodies[K1]
    k2 = bodies[K2]
    p = point[0]
    at = 3 * body
    angle = qk[3 * k2 + 2] + n[SENSE] * (n[OFFSET] + law[0])
    vk[at + 2] = vk[3 * k2 + 2] + n[SENSE] * law[1]
    ak[at + 2] = ak[3 * k2 + 2] + n[SENSE] * law[2]
    qk[at + 2] = angle
    turn[body, 0] = math.cos(angle)
    turn[body, 1] = math.sin(angle)
    carried(qk, vk, ak, turn, k1, n[P1_X], n[P1_Y], p)
    hang(qk, vk, ak, turn, body, p, n[PA_X], n[PA_Y])


@inlined
def place_driven(bodies, n, driven, place, p):
    """Places alone; driven (2,): cosine and sine of s (offset + f). See rrr.place_rrr."""
    a = bodies[FIRST]
    k1 = bodies[K1]
    k2 = bodies[K2]
    point_of(place, k1, n[P1_X], n[P1_Y], p)
    turn_with(place, a, k2, driven)
    put_on(place, a, p[0], p[1], n[PA_X], n[PA_Y])


@merged
def embed_driven(bodies, n, body, rate, coordinate, drive):
    """Positions and columns of B. See prp.embed_prp."""
    a = bodies[FIRST]
    k1 = bodies[K1]
    k2 = bodies[K2]
    law = bodies[LAW]
    column = bodies[COORDINATE]
    columns = coordinate.shape[0] - 1
    c = body[k1, COS]
    s = body[k1, SIN]
    px = c * n[P1_X] - s * n[P1_Y]
    py = s * n[P1_X] + c * n[P1_Y]
    angle = n[SENSE] * (n[OFFSET] + (coordinate[column, VALUE] if column >= 0 else drive[law, 0]))
    qx = math.cos(angle)
    qy = math.sin(angle)
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
            omega += n[SENSE] * drive[law, 1]
        turning += omega * coordinate[j, SPEED]
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
        omega += n[SENSE] * drive[law, 2]
    rate[a, at] = cx + omega * ay + turning * ax
    rate[a, at + 1] = cy - omega * ax + turning * ay
    rate[a, at + 2] = omega
