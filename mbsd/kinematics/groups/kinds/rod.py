"""ROD: A pinned to K1 at P, a rod or actuator holds the distance l from C of A to Q of K2.

C where the circles about P and Q meet; u = C - P, w = C - Q, |w| = l:

    omega w . u_perp = l l' + w . (q' - p')
    alpha w . u_perp = l'^2 + l l'' - |w'|^2 + w . (q'' - p'' + omega^2 u)
"""

from __future__ import annotations

import math

from mbsd.compiling.jit import inlined, lazy
from mbsd.kinematics.groups.carrying.branch import doubted, predicted
from mbsd.kinematics.groups.carrying.by_column import carry_column, hang_column, put, turned_x, turned_y
from mbsd.kinematics.groups.carrying.columns import AVOID, COS, NEAR, OMEGA, SIGN, SIN, SINE, SPEED, X, Y
from mbsd.kinematics.groups.carrying.places import point_along, point_of, put_on, root_of
from mbsd.kinematics.groups.carrying.rates import DOUBTED, SOLVED, aim, carried, hang, reach
from mbsd.kinematics.groups.groups import FIRST, K1, K2, LAW, ROD
from mbsd.kinematics.groups.kind import GroupKind, Made, line
from mbsd.kinematics.groups.links import Link, Places

P1_X, P1_Y, PA_X, PA_Y, CA_X, CA_Y, Q2_X, Q2_Y, LENGTH, BRANCH = range(10)
"""P on K1, P on A, C on A, Q on K2, constant length beside the law's, sign of the root."""
UA_X, UA_Y, SQUARE = CA_X, CA_Y, BRANCH
"""For columns of B: u / a^2 on A, a^2; a = |u|."""


def rod(at: Places, a: int, links: dict[str, Link]) -> Made:
    """A pinned body held by a rod or an actuator."""
    pin, held = links["R"], links["L"]
    numbers = [*at.pin(pin), *at.arm(held.here), *at.arm(held.there), held.offset]
    p, q = at.world(a, numbers[PA_X:CA_X]), at.world(held.other, numbers[Q2_X:LENGTH])
    branch = at.side_of(p, q, at.world(a, numbers[CA_X:Q2_X]))
    return ROD, (a, -1, pin.other, held.other), held.motion, [*numbers, branch]


def _embedded(n: list[float]) -> list[float]:
    on_a, square = line(n[CA_X] - n[PA_X], n[CA_Y] - n[PA_Y])
    return [*n[:CA_X], *on_a, *n[Q2_X:BRANCH], square]


KIND = GroupKind(ROD, "rod", _embedded, one=("LR",), of_one=rod, branch=BRANCH)


@lazy(int)
def solve_rod(bodies, n, law, qk, vk, ak, last, turn, point):
    """Positions and rates; law (3,): l and its rates beside the constant length. See prp.solve_prp."""
    p = point[0]
    r = point[1]
    a = bodies[FIRST]
    carried(qk, vk, ak, turn, bodies[K1], n[P1_X], n[P1_Y], p)
    carried(qk, vk, ak, turn, bodies[K2], n[Q2_X], n[Q2_Y], r)
    lx = n[CA_X] - n[PA_X]
    ly = n[CA_Y] - n[PA_Y]
    rod = n[LENGTH] + law[0]
    first = lx * lx + ly * ly
    dx = r[0] - p[0]
    dy = r[1] - p[1]
    square = dx * dx + dy * dy
    second = rod * rod
    middle = first + second - square
    left = 4.0 * first * second - middle * middle
    fx = r[2] - p[2]
    fy = r[3] - p[3]
    point[3, 0] = left
    point[3, 1] = 8.0 * first * rod * law[1] - 4.0 * middle * (rod * law[1] - dx * fx - dy * fy)
    state = reach(left, 4.0 * first * second)
    if state != SOLVED:
        return state
    inverse = 1.0 / square
    along = 0.5 * (square + first - second) * inverse
    height = n[BRANCH] * 0.5 * inverse * math.sqrt(left)
    ux = along * dx - height * dy
    uy = along * dy + height * dx
    wx = ux - dx
    wy = uy - dy
    aim(turn, qk, last[3 * a + 2], a, ux, uy, lx, ly)
    lever = 1.0 / (wy * ux - wx * uy)
    omega = (rod * law[1] + wx * fx + wy * fy) * lever
    rate_x = -omega * uy - fx
    rate_y = omega * ux - fy
    fx = r[4] - p[4] + omega * omega * ux
    fy = r[5] - p[5] + omega * omega * uy
    bend = law[1] * law[1] + rod * law[2] - rate_x * rate_x - rate_y * rate_y
    vk[3 * a + 2] = omega
    ak[3 * a + 2] = (bend + wx * fx + wy * fy) * lever
    hang(qk, vk, ak, turn, a, p, n[PA_X], n[PA_Y])
    return SOLVED


@inlined
def place_rod(bodies, n, driven, place, p, r):
    """Places alone; driven (2,): the law's length first. See rrr.place_rrr."""
    a = bodies[FIRST]
    k1 = bodies[K1]
    k2 = bodies[K2]
    point_of(place, k1, n[P1_X], n[P1_Y], p)
    point_of(place, k2, n[Q2_X], n[Q2_Y], r)
    lx = n[CA_X] - n[PA_X]
    ly = n[CA_Y] - n[PA_Y]
    second = (n[LENGTH] + driven[0]) ** 2
    first = lx * lx + ly * ly
    dx = r[0] - p[0]
    dy = r[1] - p[1]
    square = dx * dx + dy * dy
    inverse = 1.0 / square
    along = 0.5 * (square + first - second) * inverse
    left = first * inverse - along * along
    root = root_of(left)
    if root < 0.0:
        return root
    height = n[BRANCH] * root
    point_along(place, a, along * dx - height * dy, along * dy + height * dx, lx, ly)
    put_on(place, a, p[0], p[1], n[PA_X], n[PA_Y])
    return root


@lazy(int)
def embed_rod(bodies, n, body, rate, base, coordinate, drive):
    """Positions and columns of B. See prp.embed_prp."""
    a = bodies[FIRST]
    k1 = bodies[K1]
    k2 = bodies[K2]
    law = bodies[LAW]
    columns = coordinate.shape[0] - 1
    px = turned_x(body, k1, n[P1_X], n[P1_Y])
    py = turned_y(body, k1, n[P1_X], n[P1_Y])
    qx = turned_x(body, k2, n[Q2_X], n[Q2_Y])
    qy = turned_y(body, k2, n[Q2_X], n[Q2_Y])
    cx = body[k1, X] + px
    cy = body[k1, Y] + py
    dx = body[k2, X] + qx - cx
    dy = body[k2, Y] + qy - cy
    rod = n[LENGTH] + drive[law, 0]
    square = dx * dx + dy * dy
    half = 0.5 * (square + n[SQUARE] - rod * rod)
    cross = n[SQUARE] * square - half * half
    n[SINE] = cross / (n[SQUARE] * rod * rod)
    if not n[SINE] > n[AVOID]:
        return DOUBTED
    cross = math.sqrt(cross)
    if n[NEAR] > 0.0:
        theta = predicted(base, coordinate, a)
        c = math.cos(theta)
        s = math.sin(theta)
        side = n[SQUARE] * ((s * n[UA_X] + c * n[UA_Y]) * dx - (c * n[UA_X] - s * n[UA_Y]) * dy)
        if doubted(side, cross):
            return DOUBTED
        n[SIGN] = 1.0 if side > 0.0 else -1.0
    cross *= n[SIGN]
    ux = (half * dx - cross * dy) / square
    uy = (half * dy + cross * dx) / square
    wx = ux - dx
    wy = uy - dy
    body[a, COS] = ux * n[UA_X] + uy * n[UA_Y]
    body[a, SIN] = uy * n[UA_X] - ux * n[UA_Y]
    ax = put(body, a, cx, cy, n[PA_X], n[PA_Y], 0)
    ay = put(body, a, cx, cy, n[PA_X], n[PA_Y], 1)
    lever = 1.0 / (wy * ux - wx * uy)
    turning = 0.0
    past_x = 0.0
    past_y = 0.0
    for j in range(columns + 1):
        cx = carry_column(body, rate, columns, j, k1, px, py, 0)
        cy = carry_column(body, rate, columns, j, k1, px, py, 1)
        fx = carry_column(body, rate, columns, j, k2, qx, qy, 0) - cx
        fy = carry_column(body, rate, columns, j, k2, qx, qy, 1) - cy
        change = 0.0
        if j == columns:
            body[a, OMEGA] = turning
            past_x = -turning * uy - past_x
            past_y = turning * ux - past_y
            fx += turning * turning * ux
            fy += turning * turning * uy
            change = drive[law, 1] * drive[law, 1] + rod * drive[law, 2] - past_x * past_x - past_y * past_y
        elif j == columns - 1 and law > 0:
            change = rod * drive[law, 1]
        omega = (change + wx * fx + wy * fy) * lever
        if j < columns:
            turning += omega * coordinate[j, SPEED]
            past_x += fx * coordinate[j, SPEED]
            past_y += fy * coordinate[j, SPEED]
        hang_column(body, rate, columns, j, a, cx, cy, omega, ax, ay)
    return SOLVED
