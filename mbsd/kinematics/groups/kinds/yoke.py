"""YOKE: A slides on K1, point Q of K2 runs in a slot of A.

n . (Q - S_0 - s e) = 0, n the normal of the slot; k the point Q as K1 carries it:

    s' n.e = n . (q' - k'),   s'' n.e = n . (q'' - k'' - 2 omega_K (q' - k')_perp)
"""

from __future__ import annotations

import math

import numpy as np

from mbsd.compiling.jit import inlined, lazy
from mbsd.kinematics.groups.carrying.by_column import carry_column, hang_column, put, turn_as, turned_x, turned_y
from mbsd.kinematics.groups.carrying.columns import OMEGA, SPEED, X, Y
from mbsd.kinematics.groups.carrying.places import point_of, put_on, turn_with
from mbsd.kinematics.groups.carrying.rates import SOLVED, carried, follow, hang
from mbsd.kinematics.groups.groups import FIRST, K1, K2, YOKE
from mbsd.kinematics.groups.kind import GroupKind, Made
from mbsd.kinematics.groups.links import Link, Places, cross, turned

S1_X, S1_Y, E_X, E_Y, N_X, N_Y, Q2_X, Q2_Y, ANGLE, SA_X, SA_Y = range(11)
"""S_0, e and n on K1, Q on K2, angle of A against K1, the slot's point on A."""
COS_A, SIN_A = ANGLE, 11
"""For columns of B: cosine and sine of that angle."""
PARALLEL = 1e-9
"""Sine of the angle between slide and slot below which they make no group."""


def yoke(at: Places, a: int, links: dict[str, Link]) -> Made | None:
    """A sliding body in whose slot a point of a known body runs."""
    slide, slot = links["P"], links["S"]
    if not slot.first:
        return None
    slot_on_a = at.arm(slot.here)
    x, y, e_x, e_y, angle = at.on_slide(slide, slot_on_a)
    u = turned(at.axis(slot.here), angle)
    if abs(cross(u, np.array([e_x, e_y]))) < PARALLEL:
        return None
    numbers = [x, y, e_x, e_y, -u[1], u[0], *at.arm(slot.there), angle, *slot_on_a]
    return YOKE, (a, -1, slide.other, slot.other), 0, [float(number) for number in numbers]


def _embedded(n: list[float]) -> list[float]:
    return [*n[:ANGLE], math.cos(n[ANGLE]), *n[SA_X:SIN_A], math.sin(n[ANGLE])]


KIND = GroupKind(YOKE, "yoke", _embedded, one=("PS",), of_one=yoke, angles=((0, ANGLE),))


@lazy(int)
def solve_yoke(bodies, n, qk, vk, ak, turn, point):
    """Positions and rates. See prp.solve_prp."""
    p = point[0]
    r = point[1]
    g = point[2]
    body = bodies[FIRST]
    k1 = bodies[K1]
    k2 = bodies[K2]
    point[3, 0] = 1.0
    point[3, 1] = 0.0
    carried(qk, vk, ak, turn, k1, n[S1_X], n[S1_Y], p)
    carried(qk, vk, ak, turn, k2, n[Q2_X], n[Q2_Y], r)
    ex = turn[k1, 0] * n[E_X] - turn[k1, 1] * n[E_Y]
    ey = turn[k1, 1] * n[E_X] + turn[k1, 0] * n[E_Y]
    nx = turn[k1, 0] * n[N_X] - turn[k1, 1] * n[N_Y]
    ny = turn[k1, 1] * n[N_X] + turn[k1, 0] * n[N_Y]
    spin = vk[3 * k1 + 2]
    turning = ak[3 * k1 + 2]
    dx = r[0] - p[0]
    dy = r[1] - p[1]
    inverse = 1.0 / (nx * ex + ny * ey)
    slide = (nx * dx + ny * dy) * inverse
    sx = slide * ex
    sy = slide * ey
    fx = r[2] - p[2] + spin * dy
    fy = r[3] - p[3] - spin * dx
    rate = (nx * fx + ny * fy) * inverse
    ux = r[4] - p[4] + turning * dy + spin * spin * dx + 2.0 * spin * fy
    uy = r[5] - p[5] - turning * dx + spin * spin * dy - 2.0 * spin * fx
    along = (nx * ux + ny * uy) * inverse
    g[0] = p[0] + sx
    g[1] = p[1] + sy
    g[2] = p[2] - spin * sy + rate * ex
    g[3] = p[3] + spin * sx + rate * ey
    g[4] = p[4] - turning * sy - spin * spin * sx - 2.0 * spin * rate * ey + along * ex
    g[5] = p[5] + turning * sx - spin * spin * sy + 2.0 * spin * rate * ex + along * ey
    follow(qk, vk, ak, turn, body, k1, n[ANGLE])
    hang(qk, vk, ak, turn, body, g, n[SA_X], n[SA_Y])
    return SOLVED


@inlined
def place_yoke(bodies, n, turn_a, place, p, r):
    """Places alone; turn_a (2,): cosine and sine of the angle. See rrr.place_rrr."""
    a = bodies[FIRST]
    k1 = bodies[K1]
    k2 = bodies[K2]
    point_of(place, k1, n[S1_X], n[S1_Y], p)
    point_of(place, k2, n[Q2_X], n[Q2_Y], r)
    ex = place[k1, 2] * n[E_X] - place[k1, 3] * n[E_Y]
    ey = place[k1, 3] * n[E_X] + place[k1, 2] * n[E_Y]
    nx = place[k1, 2] * n[N_X] - place[k1, 3] * n[N_Y]
    ny = place[k1, 3] * n[N_X] + place[k1, 2] * n[N_Y]
    slide = (nx * (r[0] - p[0]) + ny * (r[1] - p[1])) / (nx * ex + ny * ey)
    turn_with(place, a, k1, turn_a)
    put_on(place, a, p[0] + slide * ex, p[1] + slide * ey, n[SA_X], n[SA_Y])


@lazy(int)
def embed_yoke(bodies, n, body, rate, coordinate):
    """Positions and columns of B. See prp.embed_prp."""
    a = bodies[FIRST]
    k1 = bodies[K1]
    k2 = bodies[K2]
    columns = coordinate.shape[0] - 1
    px = turned_x(body, k1, n[S1_X], n[S1_Y])
    py = turned_y(body, k1, n[S1_X], n[S1_Y])
    ex = turned_x(body, k1, n[E_X], n[E_Y])
    ey = turned_y(body, k1, n[E_X], n[E_Y])
    nx = turned_x(body, k1, n[N_X], n[N_Y])
    ny = turned_y(body, k1, n[N_X], n[N_Y])
    qx = turned_x(body, k2, n[Q2_X], n[Q2_Y])
    qy = turned_y(body, k2, n[Q2_X], n[Q2_Y])
    dx = body[k2, X] + qx - body[k1, X] - px
    dy = body[k2, Y] + qy - body[k1, Y] - py
    inverse = 1.0 / (nx * ex + ny * ey)
    slide = (nx * dx + ny * dy) * inverse
    sx = px + slide * ex
    sy = py + slide * ey
    gx = px + dx
    gy = py + dy
    turn_as(body, a, k1, n[COS_A], n[SIN_A])
    tx = body[k1, X] + sx
    ty = body[k1, Y] + sy
    ax = put(body, a, tx, ty, n[SA_X], n[SA_Y], 0)
    ay = put(body, a, tx, ty, n[SA_X], n[SA_Y], 1)
    spin = body[k1, OMEGA]
    body[a, OMEGA] = spin
    sliding = 0.0
    past_x = 0.0
    past_y = 0.0
    for j in range(columns + 1):
        fx = carry_column(body, rate, columns, j, k2, qx, qy, 0) - carry_column(body, rate, columns, j, k1, gx, gy, 0)
        fy = carry_column(body, rate, columns, j, k2, qx, qy, 1) - carry_column(body, rate, columns, j, k1, gx, gy, 1)
        tx = carry_column(body, rate, columns, j, k1, sx, sy, 0)
        ty = carry_column(body, rate, columns, j, k1, sx, sy, 1)
        if j == columns:
            fx += 2.0 * spin * past_y
            fy -= 2.0 * spin * past_x
            tx -= 2.0 * spin * sliding * ey
            ty += 2.0 * spin * sliding * ex
        slip = (nx * fx + ny * fy) * inverse
        if j < columns:
            sliding += slip * coordinate[j, SPEED]
            past_x += fx * coordinate[j, SPEED]
            past_y += fy * coordinate[j, SPEED]
        hang_column(body, rate, columns, j, a, tx + slip * ex, ty + slip * ey, rate[k1, 3 * j + 2], ax, ay)
    return SOLVED
