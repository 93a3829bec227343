"""PRP: A slides on K1 and is pinned at C to B, which slides on K2; or C of A runs in a slot of K2 (B: -1).

C = C_1 + s_1 e_1 = C_2 + s_2 e_2 where two slides cross; c_i the point C as K_i carries it:

    s_1' e_1 - s_2' e_2 = c_2' - c_1'
    s_1'' e_1 - s_2'' e_2 = c_2'' + 2 omega_2 s_2' e_2_perp - c_1'' - 2 omega_1 s_1' e_1_perp
"""

from __future__ import annotations

import math

from mbsd.compiling.jit import inlined, lazy
from mbsd.kinematics.groups.carrying.by_column import carry_column, hang_column, put, turn_as, turned_x, turned_y
from mbsd.kinematics.groups.carrying.columns import OMEGA, SPEED, X, Y
from mbsd.kinematics.groups.carrying.places import point_of, put_on, turn_with
from mbsd.kinematics.groups.carrying.rates import DOUBTED, MEETING, SOLVED, carried, follow, hang
from mbsd.kinematics.groups.groups import FIRST, K1, K2, PRP, SECOND
from mbsd.kinematics.groups.kind import GroupKind, Made
from mbsd.kinematics.groups.links import Link, Places

C1_X, C1_Y, E1_X, E1_Y, ANGLE_A, CA_X, CA_Y, C2_X, C2_Y, E2_X, E2_Y, ANGLE_B, CB_X, CB_Y = range(14)
"""C_1 and e_1 on K1, angle of A against K1, C on A; C_2 and e_2 on K2, angle of B against K2, C on B."""
COS_A, SIN_A, COS_B, SIN_B = ANGLE_A, 14, ANGLE_B, 15
"""For columns of B: cosines and sines of these angles."""
PARALLEL = 1e-6
"""Sine of the angle between two slides below which they do not cross."""
NEARLY_PARALLEL = 1e-3
"""The same below which their crossing is in doubt, where it is not solved with rates."""


def in_slot(at: Places, a: int, links: dict[str, Link]) -> Made | None:
    """A sliding body whose point runs in a slot of a known one."""
    slide, slot = links["P"], links["S"]
    if slot.first:
        return None
    return _made(
        at, a, -1, slide, at.arm(slot.here), slot.other, [*at.arm(slot.there), *at.axis(slot.there), 0.0, 0.0, 0.0]
    )


def two_slides(at: Places, a: int, b: int, slide: Link, inner: Link, second: Link) -> Made:
    """Two sliding bodies pinned to each other."""
    arm = at.arm(inner.there)
    return _made(at, a, b, slide, at.arm(inner.here), second.other, [*at.on_slide(second, arm), *arm])


def _made(at: Places, a: int, b: int, slide: Link, arm: list[float], k2: int, second: list[float]) -> Made:
    numbers = [*at.on_slide(slide, arm), *arm, *second]
    return PRP, (a, b, slide.other, k2), 0, [float(number) for number in numbers]


def _embedded(n: list[float]) -> list[float]:
    a, b = n[ANGLE_A], n[ANGLE_B]
    return [*n[:ANGLE_A], math.cos(a), *n[CA_X:ANGLE_B], math.cos(b), *n[CB_X:SIN_A], math.sin(a), math.sin(b)]


KIND = GroupKind(
    PRP,
    "PRP",
    _embedded,
    one=("PS",),
    of_one=in_slot,
    two=("PRP",),
    of_two=two_slides,
    angles=((0, ANGLE_A), (1, ANGLE_B)),
)


@lazy(int)
def solve_prp(bodies, n, qk, vk, ak, turn, point):
    """Fill positions, velocities and accelerations qk, vk, ak (3 nb,) of the group's bodies; return SOLVED or why not.

    ``point`` (4, 8): scratch; its last row gets the discriminant and its rate, here sine^2 between the slides.
    """
    p = point[0]
    r = point[1]
    g = point[2]
    first_body = bodies[FIRST]
    two = bodies[SECOND]
    k1 = bodies[K1]
    k2 = bodies[K2]
    carried(qk, vk, ak, turn, k1, n[C1_X], n[C1_Y], p)
    carried(qk, vk, ak, turn, k2, n[C2_X], n[C2_Y], r)
    ex = turn[k1, 0] * n[E1_X] - turn[k1, 1] * n[E1_Y]
    ey = turn[k1, 1] * n[E1_X] + turn[k1, 0] * n[E1_Y]
    fx = turn[k2, 0] * n[E2_X] - turn[k2, 1] * n[E2_Y]
    fy = turn[k2, 1] * n[E2_X] + turn[k2, 0] * n[E2_Y]
    sine = fx * ey - fy * ex
    if not abs(sine) > PARALLEL:
        return MEETING
    inverse = 1.0 / sine
    dx = r[0] - p[0]
    dy = r[1] - p[1]
    first = (fx * dy - fy * dx) * inverse
    second = (ex * dy - ey * dx) * inverse
    w1 = vk[3 * k1 + 2]
    w2 = vk[3 * k2 + 2]
    point[3, 0] = sine * sine
    point[3, 1] = 2.0 * sine * (fx * ex + fy * ey) * (w1 - w2)
    a1 = ak[3 * k1 + 2]
    a2 = ak[3 * k2 + 2]
    sx = first * ex
    sy = first * ey
    tx = second * fx
    ty = second * fy
    c1x = p[2] - w1 * sy
    c1y = p[3] + w1 * sx
    dx = r[2] - w2 * ty - c1x
    dy = r[3] + w2 * tx - c1y
    rate1 = (fx * dy - fy * dx) * inverse
    rate2 = (ex * dy - ey * dx) * inverse
    g[0] = p[0] + sx
    g[1] = p[1] + sy
    g[2] = c1x + rate1 * ex
    g[3] = c1y + rate1 * ey
    c1x = p[4] - a1 * sy - w1 * w1 * sx - 2.0 * w1 * rate1 * ey
    c1y = p[5] + a1 * sx - w1 * w1 * sy + 2.0 * w1 * rate1 * ex
    dx = r[4] - a2 * ty - w2 * w2 * tx - 2.0 * w2 * rate2 * fy - c1x
    dy = r[5] + a2 * tx - w2 * w2 * ty + 2.0 * w2 * rate2 * fx - c1y
    bend = (fx * dy - fy * dx) * inverse
    g[4] = c1x + bend * ex
    g[5] = c1y + bend * ey
    follow(qk, vk, ak, turn, first_body, k1, n[ANGLE_A])
    hang(qk, vk, ak, turn, first_body, g, n[CA_X], n[CA_Y])
    if two >= 0:
        follow(qk, vk, ak, turn, two, k2, n[ANGLE_B])
        hang(qk, vk, ak, turn, two, g, n[CB_X], n[CB_Y])
    return SOLVED


@inlined
def place_prp(bodies, n, turn_a, turn_b, place, p, r):
    """Places alone; turn_a, turn_b (2,): cosine and sine of the angles. Returns the sine between the slides, or 0."""
    a = bodies[FIRST]
    b = bodies[SECOND]
    k1 = bodies[K1]
    k2 = bodies[K2]
    point_of(place, k1, n[C1_X], n[C1_Y], p)
    point_of(place, k2, n[C2_X], n[C2_Y], r)
    ex = place[k1, 2] * n[E1_X] - place[k1, 3] * n[E1_Y]
    ey = place[k1, 3] * n[E1_X] + place[k1, 2] * n[E1_Y]
    ux = place[k2, 2] * n[E2_X] - place[k2, 3] * n[E2_Y]
    uy = place[k2, 3] * n[E2_X] + place[k2, 2] * n[E2_Y]
    root = ux * ey - uy * ex
    if not abs(root) > NEARLY_PARALLEL:
        return 0.0
    slide = (ux * (r[1] - p[1]) - uy * (r[0] - p[0])) / root
    turn_with(place, a, k1, turn_a)
    put_on(place, a, p[0] + slide * ex, p[1] + slide * ey, n[CA_X], n[CA_Y])
    if b >= 0:
        turn_with(place, b, k2, turn_b)
        put_on(place, b, p[0] + slide * ex, p[1] + slide * ey, n[CB_X], n[CB_Y])
    return root


@lazy(int)
def embed_prp(bodies, n, body, rate, coordinate):
    """Fill ``body`` and ``rate`` of the group's bodies; return SOLVED, or DOUBTED where their pose is unclear.

    Arrays: mbsd/dynamics/embedding/arrays.py; bodies and n are rows of Embedding.group and Embedding.number.
    """
    a = bodies[FIRST]
    b = bodies[SECOND]
    k1 = bodies[K1]
    k2 = bodies[K2]
    columns = coordinate.shape[0] - 1
    px = turned_x(body, k1, n[C1_X], n[C1_Y])
    py = turned_y(body, k1, n[C1_X], n[C1_Y])
    ex = turned_x(body, k1, n[E1_X], n[E1_Y])
    ey = turned_y(body, k1, n[E1_X], n[E1_Y])
    qx = turned_x(body, k2, n[C2_X], n[C2_Y])
    qy = turned_y(body, k2, n[C2_X], n[C2_Y])
    fx = turned_x(body, k2, n[E2_X], n[E2_Y])
    fy = turned_y(body, k2, n[E2_X], n[E2_Y])
    sine = fx * ey - fy * ex
    if not abs(sine) > NEARLY_PARALLEL:
        return DOUBTED
    inverse = 1.0 / sine
    dx = body[k2, X] + qx - body[k1, X] - px
    dy = body[k2, Y] + qy - body[k1, Y] - py
    first = (fx * dy - fy * dx) * inverse
    second = (ex * dy - ey * dx) * inverse
    px += first * ex
    py += first * ey
    qx += second * fx
    qy += second * fy
    turn_as(body, a, k1, n[COS_A], n[SIN_A])
    tx = body[k1, X] + px
    ty = body[k1, Y] + py
    ax = put(body, a, tx, ty, n[CA_X], n[CA_Y], 0)
    ay = put(body, a, tx, ty, n[CA_X], n[CA_Y], 1)
    body[a, OMEGA] = body[k1, OMEGA]
    bx = 0.0
    by = 0.0
    if b >= 0:
        turn_as(body, b, k2, n[COS_B], n[SIN_B])
        bx = put(body, b, tx, ty, n[CB_X], n[CB_Y], 0)
        by = put(body, b, tx, ty, n[CB_X], n[CB_Y], 1)
        body[b, OMEGA] = body[k2, OMEGA]
    slip1 = 0.0
    slip2 = 0.0
    for j in range(columns + 1):
        cx = carry_column(body, rate, columns, j, k1, px, py, 0)
        cy = carry_column(body, rate, columns, j, k1, px, py, 1)
        tx = carry_column(body, rate, columns, j, k2, qx, qy, 0)
        ty = carry_column(body, rate, columns, j, k2, qx, qy, 1)
        if j == columns:
            twice = 2.0 * body[k1, OMEGA] * slip1
            cx -= twice * ey
            cy += twice * ex
            twice = 2.0 * body[k2, OMEGA] * slip2
            tx -= twice * fy
            ty += twice * fx
        dx = tx - cx
        dy = ty - cy
        along = (fx * dy - fy * dx) * inverse
        if j < columns:
            slip1 += along * coordinate[j, SPEED]
            slip2 += (ex * dy - ey * dx) * inverse * coordinate[j, SPEED]
        gx = cx + along * ex
        gy = cy + along * ey
        hang_column(body, rate, columns, j, a, gx, gy, rate[k1, 3 * j + 2], ax, ay)
        if b >= 0:
            hang_column(body, rate, columns, j, b, gx, gy, rate[k2, 3 * j + 2], bx, by)
    return SOLVED
