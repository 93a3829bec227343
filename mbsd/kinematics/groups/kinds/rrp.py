"""RRP: A pinned to K1 at P and at C to B, which slides on K2; or C of A runs in a slot of K2 (B: -1).

C = C_0 + s e where the circle about P meets the line; u = C - P, c the point C as K2 carries it, Q = C_0:

    omega_A u_perp - s' e = c' - p'
    alpha_A u_perp - s'' e = c'' + 2 omega_K s' e_perp - p'' + omega_A^2 u
    D = a^2 - c^2,  c = (Q - P) x e;   D' = -2 c c'     a = |u|
"""

from __future__ import annotations

import math

import numpy as np

from mbsd.kinematics.groups import carried
from mbsd.kinematics.groups.cases import branch_of, columns_of, formula, note_change, reached, speed_of
from mbsd.kinematics.groups.groups import FIRST, K1, K2, RRP, SECOND, Bodies, GroupKind, Link, Made, Places, line

P1_X, P1_Y, PA_X, PA_Y, CA_X, CA_Y, C2_X, C2_Y, E_X, E_Y, ANGLE, CB_X, CB_Y, BRANCH = range(14)
"""P on K1, P on A, C on A, C_0 and e on K2, angle of B against K2, C on B, sign of the root."""
UA_X, UA_Y, COS_B, SIN_B, SQUARE, PER_SQUARE = CA_X, CA_Y, ANGLE, BRANCH, 14, 15
"""In a row of Groups.row: u / a^2 on A, cosine and sine of that angle, a^2, 1 / a^2."""


def in_slot(at: Places, a: int, links: dict[str, Link]) -> Made | None:
    """Return a pinned body whose point runs in a slot of a known one."""
    pin, slot = links["R"], links["S"]
    if slot.first:
        return None
    bodies, base = (a, -1, pin.other, slot.other), [*at.arm(slot.there), *at.axis(slot.there), 0.0]
    return _group(at, bodies, pin, at.arm(slot.here), base, [0.0, 0.0])


def on_slide(at: Places, a: int, b: int, pin: Link, inner: Link, slide: Link) -> Made:
    """Return a pinned body, pinned to one that slides."""
    arm = at.arm(inner.there)
    return _group(at, (a, b, pin.other, slide.other), pin, at.arm(inner.here), at.on_slide(slide, arm), arm)


def _group(at: Places, bodies: Bodies, pin: Link, c_on_a: list[float], base: list[float], c_on_b: list[float]) -> Made:
    a, _, _, k2 = bodies
    numbers = [float(x) for x in (*at.pin(pin), *c_on_a, *base, *c_on_b)]
    reach = at.world(a, c_on_a) - at.world(a, numbers[PA_X:CA_X])
    branch = math.copysign(1.0, float(np.dot(reach, at.along(k2, numbers[E_X:ANGLE]))))
    return RRP, bodies, 0, [*numbers, branch]


def _row(n: np.ndarray) -> list[np.ndarray]:
    on_a, square = line(n[CA_X] - n[PA_X], n[CA_Y] - n[PA_Y])
    turn = np.cos(n[ANGLE]), np.sin(n[ANGLE])
    return [*n[:CA_X], *on_a, *n[C2_X:ANGLE], turn[0], *n[CB_X:BRANCH], turn[1], square, 1.0 / square]


KIND = GroupKind(
    RRP,
    "RRP",
    _row,
    one=("RS",),
    of_one=in_slot,
    two=("RRP",),
    of_two=on_slide,
    branch=BRANCH,
    follows=((1, ANGLE, K2),),
    watched=1,
)


@formula
def solve_rrp(case, e):
    """Place the bodies of group e and fill their rates. See prp.solve_prp."""
    bodies = case.group[e]
    n = case.number[e]
    body = case.body
    rate = case.rate
    a = bodies[FIRST]
    b = bodies[SECOND]
    k1 = bodies[K1]
    k2 = bodies[K2]
    columns = columns_of(case)
    px = carried.turned_x(body, k1, n[P1_X], n[P1_Y])
    py = carried.turned_y(body, k1, n[P1_X], n[P1_Y])
    qx = carried.turned_x(body, k2, n[C2_X], n[C2_Y])
    qy = carried.turned_y(body, k2, n[C2_X], n[C2_Y])
    ex = carried.turned_x(body, k2, n[E_X], n[E_Y])
    ey = carried.turned_y(body, k2, n[E_X], n[E_Y])
    dx = body[k2, carried.X] + qx - body[k1, carried.X] - px
    dy = body[k2, carried.Y] + qy - body[k1, carried.Y] - py
    along = dx * ex + dy * ey
    across = dx * ey - dy * ex
    left = n[SQUARE] - across * across
    n[carried.SINE] = left * n[PER_SQUARE]
    state = reached(case, n)
    if state != carried.SOLVED:
        return state
    root = math.sqrt(left)
    sign = branch_of(case, n, a, n[SQUARE] * n[UA_X], n[SQUARE] * n[UA_Y], ex, ey, root)
    if sign == 0.0:
        return carried.DOUBTED
    root *= sign
    slide = root - along
    sx = qx + slide * ex
    sy = qy + slide * ey
    ux = dx + slide * ex
    uy = dy + slide * ey
    body[a, carried.COS] = ux * n[UA_X] + uy * n[UA_Y]
    body[a, carried.SIN] = uy * n[UA_X] - ux * n[UA_Y]
    cx = body[k1, carried.X] + px
    cy = body[k1, carried.Y] + py
    ax = carried.place_by_point(body, a, cx, cy, n[PA_X], n[PA_Y], 0)
    ay = carried.place_by_point(body, a, cx, cy, n[PA_X], n[PA_Y], 1)
    bx = 0.0
    by = 0.0
    if b >= 0:
        carried.turn_as(body, b, k2, n[COS_B], n[SIN_B])
        bx = carried.place_by_point(body, b, body[k2, carried.X] + sx, body[k2, carried.Y] + sy, n[CB_X], n[CB_Y], 0)
        by = carried.place_by_point(body, b, body[k2, carried.X] + sx, body[k2, carried.Y] + sy, n[CB_X], n[CB_Y], 1)
        body[b, carried.OMEGA] = body[k2, carried.OMEGA]
    inverse = 1.0 / root
    turning = 0.0
    sliding = 0.0
    fx = 0.0
    fy = 0.0
    for j in range(columns + 1):
        cx = carried.carry_column(body, rate, columns, j, k1, px, py, 0)
        cy = carried.carry_column(body, rate, columns, j, k1, px, py, 1)
        tx = carried.carry_column(body, rate, columns, j, k2, sx, sy, 0)
        ty = carried.carry_column(body, rate, columns, j, k2, sx, sy, 1)
        if j == columns:
            body[a, carried.OMEGA] = turning
            spin = body[k2, carried.OMEGA]
            note_change(case, n, -2.0 * across * (fx * ey - fy * ex + spin * root) * n[PER_SQUARE])
            tx -= 2.0 * spin * sliding * ey
            ty += 2.0 * spin * sliding * ex
        fx = tx - cx
        fy = ty - cy
        if j == columns:
            fx += turning * turning * ux
            fy += turning * turning * uy
        omega = (ex * fy - ey * fx) * inverse
        slip = -(ux * fx + uy * fy) * inverse
        if j < columns:
            turning += omega * speed_of(case, j)
            sliding += slip * speed_of(case, j)
        carried.hang_column(body, rate, columns, j, a, cx, cy, omega, ax, ay)
        if b >= 0:
            carried.hang_column(body, rate, columns, j, b, tx + slip * ex, ty + slip * ey, rate[k2, 3 * j + 2], bx, by)
    return carried.SOLVED
