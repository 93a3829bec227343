"""RRP: A pinned to K1 at P and at C to B, which slides on K2; or C of A runs in a slot of K2 (B: -1).

C = C_0 + s e where the circle about P meets the line; u = C - P, c the point C as K2 carries it, Q = C_0:

    omega_A u_perp - s' e = c' - p'
    alpha_A u_perp - s'' e = c'' + 2 omega_K s' e_perp - p'' + omega_A^2 u
    D = a^2 - c^2,  c = (Q - P) x e;   D' = -2 c c'     a = |u|
"""

from __future__ import annotations

import math

import numpy as np

from mbsd.compiling.jit import inlined, lazy
from mbsd.kinematics.groups.carrying.branch import doubted, predicted
from mbsd.kinematics.groups.carrying.by_column import carry_column, hang_column, put, turn_as, turned_x, turned_y
from mbsd.kinematics.groups.carrying.columns import AVOID, COS, NEAR, OMEGA, SIGN, SIN, SINE, SPEED, X, Y
from mbsd.kinematics.groups.carrying.places import point_along, point_of, put_on, root_of, turn_with
from mbsd.kinematics.groups.carrying.rates import DOUBTED, SOLVED, aim, carried, follow, hang, reach
from mbsd.kinematics.groups.groups import FIRST, K1, K2, RRP, SECOND
from mbsd.kinematics.groups.kind import Bodies, GroupKind, Made, line
from mbsd.kinematics.groups.links import Link, Places

P1_X, P1_Y, PA_X, PA_Y, CA_X, CA_Y, C2_X, C2_Y, E_X, E_Y, ANGLE, CB_X, CB_Y, BRANCH = range(14)
"""P on K1, P on A, C on A, C_0 and e on K2, angle of B against K2, C on B, sign of the root."""
UA_X, UA_Y, COS_B, SIN_B, SQUARE, PER_SQUARE = CA_X, CA_Y, ANGLE, BRANCH, 14, 15
"""For columns of B: u / a^2 on A, cosine and sine of that angle, a^2, 1 / a^2."""


def in_slot(at: Places, a: int, links: dict[str, Link]) -> Made | None:
    """A pinned body whose point runs in a slot of a known one."""
    pin, slot = links["R"], links["S"]
    if slot.first:
        return None
    bodies, base = (a, -1, pin.other, slot.other), [*at.arm(slot.there), *at.axis(slot.there), 0.0]
    return _made(at, bodies, pin, at.arm(slot.here), base, [0.0, 0.0])


def on_slide(at: Places, a: int, b: int, pin: Link, inner: Link, slide: Link) -> Made:
    """A pinned body, pinned to one that slides."""
    arm = at.arm(inner.there)
    return _made(at, (a, b, pin.other, slide.other), pin, at.arm(inner.here), at.on_slide(slide, arm), arm)


def _made(at: Places, bodies: Bodies, pin: Link, c_on_a: list[float], base: list[float], c_on_b: list[float]) -> Made:
    a, _, _, k2 = bodies
    numbers = [float(x) for x in (*at.pin(pin), *c_on_a, *base, *c_on_b)]
    reach = at.world(a, c_on_a) - at.world(a, numbers[PA_X:CA_X])
    branch = math.copysign(1.0, float(np.dot(reach, at.along(k2, numbers[E_X:ANGLE]))))
    return RRP, bodies, 0, [*numbers, branch]


def _embedded(n: list[float]) -> list[float]:
    on_a, square = line(n[CA_X] - n[PA_X], n[CA_Y] - n[PA_Y])
    turn = math.cos(n[ANGLE]), math.sin(n[ANGLE])
    return [*n[:CA_X], *on_a, *n[C2_X:ANGLE], turn[0], *n[CB_X:BRANCH], turn[1], square, 1.0 / square]


KIND = GroupKind(
    RRP,
    "RRP",
    _embedded,
    one=("RS",),
    of_one=in_slot,
    two=("RRP",),
    of_two=on_slide,
    branch=BRANCH,
    angles=((1, ANGLE),),
)


@lazy(int)
def solve_rrp(bodies, n, qk, vk, ak, last, turn, point):
    """Positions and rates; last (3 nb,): the pose before. See prp.solve_prp."""
    p = point[0]
    r = point[1]
    g = point[2]
    body = bodies[FIRST]
    other = bodies[SECOND]
    k1 = bodies[K1]
    k2 = bodies[K2]
    at = 3 * body
    carried(qk, vk, ak, turn, k1, n[P1_X], n[P1_Y], p)
    carried(qk, vk, ak, turn, k2, n[C2_X], n[C2_Y], r)
    lx = n[CA_X] - n[PA_X]
    ly = n[CA_Y] - n[PA_Y]
    square = lx * lx + ly * ly
    ex = turn[k2, 0] * n[E_X] - turn[k2, 1] * n[E_Y]
    ey = turn[k2, 1] * n[E_X] + turn[k2, 0] * n[E_Y]
    dx = r[0] - p[0]
    dy = r[1] - p[1]
    along = dx * ex + dy * ey
    across = dx * ey - dy * ex
    left = square - across * across
    point[3, 0] = left
    state = reach(left, square)
    if state != SOLVED:
        return state
    root = n[BRANCH] * math.sqrt(left)
    slide = root - along
    sx = slide * ex
    sy = slide * ey
    ux = dx + sx
    uy = dy + sy
    aim(turn, qk, last[at + 2], body, ux, uy, lx, ly)
    spin = vk[3 * k2 + 2]
    point[3, 1] = -2.0 * across * ((r[2] - p[2]) * ey - (r[3] - p[3]) * ex + spin * along)
    turning = ak[3 * k2 + 2]
    carried_x = r[2] - spin * sy
    carried_y = r[3] + spin * sx
    fx = carried_x - p[2]
    fy = carried_y - p[3]
    inverse = 1.0 / root
    omega = (ex * fy - ey * fx) * inverse
    rate = -(ux * fx + uy * fy) * inverse
    g[0] = r[0] + sx
    g[1] = r[1] + sy
    g[2] = carried_x + rate * ex
    g[3] = carried_y + rate * ey
    carried_x = r[4] - turning * sy - spin * spin * sx - 2.0 * spin * rate * ey
    carried_y = r[5] + turning * sx - spin * spin * sy + 2.0 * spin * rate * ex
    fx = carried_x - p[4] + omega * omega * ux
    fy = carried_y - p[5] + omega * omega * uy
    vk[at + 2] = omega
    ak[at + 2] = (ex * fy - ey * fx) * inverse
    rate = -(ux * fx + uy * fy) * inverse
    g[4] = carried_x + rate * ex
    g[5] = carried_y + rate * ey
    hang(qk, vk, ak, turn, body, p, n[PA_X], n[PA_Y])
    if other >= 0:
        follow(qk, vk, ak, turn, other, k2, n[ANGLE])
        hang(qk, vk, ak, turn, other, g, n[CB_X], n[CB_Y])
    return SOLVED


@inlined
def place_rrp(bodies, n, turn_b, place, p, r):
    """Places alone; turn_b (2,): cosine and sine of the angle of B. See rrr.place_rrr."""
    a = bodies[FIRST]
    b = bodies[SECOND]
    k1 = bodies[K1]
    k2 = bodies[K2]
    point_of(place, k1, n[P1_X], n[P1_Y], p)
    point_of(place, k2, n[C2_X], n[C2_Y], r)
    lx = n[CA_X] - n[PA_X]
    ly = n[CA_Y] - n[PA_Y]
    square = lx * lx + ly * ly
    ex = place[k2, 2] * n[E_X] - place[k2, 3] * n[E_Y]
    ey = place[k2, 3] * n[E_X] + place[k2, 2] * n[E_Y]
    dx = r[0] - p[0]
    dy = r[1] - p[1]
    across = dx * ey - dy * ex
    left = 1.0 - across * across / square
    root = root_of(left)
    if root < 0.0:
        return root
    slide = n[BRANCH] * math.sqrt(square) * root - (dx * ex + dy * ey)
    ux = dx + slide * ex
    uy = dy + slide * ey
    point_along(place, a, ux, uy, lx, ly)
    put_on(place, a, p[0], p[1], n[PA_X], n[PA_Y])
    if b >= 0:
        turn_with(place, b, k2, turn_b)
        put_on(place, b, p[0] + ux, p[1] + uy, n[CB_X], n[CB_Y])
    return root


@lazy(int)
def embed_rrp(bodies, n, body, rate, base, coordinate):
    """Positions and columns of B. See prp.embed_prp."""
    a = bodies[FIRST]
    b = bodies[SECOND]
    k1 = bodies[K1]
    k2 = bodies[K2]
    columns = coordinate.shape[0] - 1
    px = turned_x(body, k1, n[P1_X], n[P1_Y])
    py = turned_y(body, k1, n[P1_X], n[P1_Y])
    qx = turned_x(body, k2, n[C2_X], n[C2_Y])
    qy = turned_y(body, k2, n[C2_X], n[C2_Y])
    ex = turned_x(body, k2, n[E_X], n[E_Y])
    ey = turned_y(body, k2, n[E_X], n[E_Y])
    dx = body[k2, X] + qx - body[k1, X] - px
    dy = body[k2, Y] + qy - body[k1, Y] - py
    along = dx * ex + dy * ey
    across = dx * ey - dy * ex
    left = n[SQUARE] - across * across
    n[SINE] = left * n[PER_SQUARE]
    if not n[SINE] > n[AVOID]:
        return DOUBTED
    root = math.sqrt(left)
    if n[NEAR] > 0.0:
        theta = predicted(base, coordinate, a)
        c = math.cos(theta)
        s = math.sin(theta)
        side = n[SQUARE] * ((c * n[UA_X] - s * n[UA_Y]) * ex + (s * n[UA_X] + c * n[UA_Y]) * ey)
        if doubted(side, root):
            return DOUBTED
        n[SIGN] = 1.0 if side > 0.0 else -1.0
    root *= n[SIGN]
    slide = root - along
    sx = qx + slide * ex
    sy = qy + slide * ey
    ux = dx + slide * ex
    uy = dy + slide * ey
    body[a, COS] = ux * n[UA_X] + uy * n[UA_Y]
    body[a, SIN] = uy * n[UA_X] - ux * n[UA_Y]
    tx = body[k2, X] + sx
    ty = body[k2, Y] + sy
    cx = body[k1, X] + px
    cy = body[k1, Y] + py
    ax = put(body, a, cx, cy, n[PA_X], n[PA_Y], 0)
    ay = put(body, a, cx, cy, n[PA_X], n[PA_Y], 1)
    bx = 0.0
    by = 0.0
    if b >= 0:
        turn_as(body, b, k2, n[COS_B], n[SIN_B])
        bx = put(body, b, tx, ty, n[CB_X], n[CB_Y], 0)
        by = put(body, b, tx, ty, n[CB_X], n[CB_Y], 1)
        body[b, OMEGA] = body[k2, OMEGA]
    inverse = 1.0 / root
    turning = 0.0
    sliding = 0.0
    for j in range(columns + 1):
        cx = carry_column(body, rate, columns, j, k1, px, py, 0)
        cy = carry_column(body, rate, columns, j, k1, px, py, 1)
        tx = carry_column(body, rate, columns, j, k2, sx, sy, 0)
        ty = carry_column(body, rate, columns, j, k2, sx, sy, 1)
        fx = tx - cx
        fy = ty - cy
        if j == columns:
            body[a, OMEGA] = turning
            twice = 2.0 * body[k2, OMEGA] * sliding
            tx -= twice * ey
            ty += twice * ex
            fx = tx - cx + turning * turning * ux
            fy = ty - cy + turning * turning * uy
        omega = (ex * fy - ey * fx) * inverse
        slip = -(ux * fx + uy * fy) * inverse
        if j < columns:
            turning += omega * coordinate[j, SPEED]
            sliding += slip * coordinate[j, SPEED]
        hang_column(body, rate, columns, j, a, cx, cy, omega, ax, ay)
        if b >= 0:
            hang_column(body, rate, columns, j, b, tx + slip * ex, ty + slip * ey, rate[k2, 3 * j + 2], bx, by)
    return SOLVED
