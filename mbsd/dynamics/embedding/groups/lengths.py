"""Groups ROD and SLIDE: a length that is constant, driven or a coordinate.

ROD    omega w . u_perp = l l' + w . (Q' - P')
       alpha w . u_perp = l'^2 + l l'' - |w'|^2 + w . (Q'' - P'' + omega^2 u)
SLIDE  S' = K' + f' g,   S'' = K'' + 2 omega_K f' g_perp + f'' g;  K' the point S as K1 carries it
"""

from __future__ import annotations

import math

from mbsd.compiling.jit import lazy
from mbsd.dynamics.embedding.arrays import (
    AVOID,
    COORDINATE,
    COS,
    FIRST,
    K1,
    K2,
    LAW,
    NEAR,
    OMEGA,
    SIGN,
    SIN,
    SINE,
    SPEED,
    VALUE,
    X,
    Y,
)
from mbsd.dynamics.embedding.groups.branch import DOUBTED, SOLVED, doubted, predicted
from mbsd.dynamics.embedding.groups.carrying import carry, hang, place, turn, turned_x, turned_y


@lazy(int)
def solve_rod(bodies, n, body, rate, base, coordinate, drive):
    """omega w . u_perp = l l' + w . (Q' - P').

    alpha w . u_perp = l'^2 + l l'' - |w'|^2 + w . (Q'' - P'' + omega^2 u)
    """
    a = bodies[FIRST]
    k1 = bodies[K1]
    k2 = bodies[K2]
    law = bodies[LAW]
    columns = coordinate.shape[0] - 1
    px = turned_x(body, k1, n[0], n[1])
    py = turned_y(body, k1, n[0], n[1])
    qx = turned_x(body, k2, n[6], n[7])
    qy = turned_y(body, k2, n[6], n[7])
    cx = body[k1, X] + px
    cy = body[k1, Y] + py
    dx = body[k2, X] + qx - cx
    dy = body[k2, Y] + qy - cy
    rod = n[8] + drive[law, 0]
    square = dx * dx + dy * dy
    half = 0.5 * (square + n[9] - rod * rod)
    cross = n[9] * square - half * half
    n[SINE] = cross / (n[9] * rod * rod)
    if not n[SINE] > n[AVOID]:
        return DOUBTED
    cross = math.sqrt(cross)
    if n[NEAR] > 0.0:
        theta = predicted(base, coordinate, a)
        c = math.cos(theta)
        s = math.sin(theta)
        side = n[9] * ((s * n[4] + c * n[5]) * dx - (c * n[4] - s * n[5]) * dy)
        if doubted(side, cross):
            return DOUBTED
        n[SIGN] = 1.0 if side > 0.0 else -1.0
    cross *= n[SIGN]
    ux = (half * dx - cross * dy) / square
    uy = (half * dy + cross * dx) / square
    wx = ux - dx
    wy = uy - dy
    body[a, COS] = ux * n[4] + uy * n[5]
    body[a, SIN] = uy * n[4] - ux * n[5]
    ax = place(body, a, cx, cy, n[2], n[3], 0)
    ay = place(body, a, cx, cy, n[2], n[3], 1)
    lever = 1.0 / (wy * ux - wx * uy)
    turning = 0.0
    past_x = 0.0
    past_y = 0.0
    for j in range(columns + 1):
        cx = carry(body, rate, columns, j, k1, px, py, 0)
        cy = carry(body, rate, columns, j, k1, px, py, 1)
        fx = carry(body, rate, columns, j, k2, qx, qy, 0) - cx
        fy = carry(body, rate, columns, j, k2, qx, qy, 1) - cy
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
        hang(body, rate, columns, j, a, cx, cy, omega, ax, ay)
    return SOLVED


@lazy(int)
def solve_slide(bodies, n, body, rate, coordinate, drive):
    """S = S_0 + f g:  S' = K' + f' g  (S'' = K'' + 2 omega_K f' g_perp + f'' g);  K' the point S as K1 carries it."""
    a = bodies[FIRST]
    k1 = bodies[K1]
    law = bodies[LAW]
    column = bodies[COORDINATE]
    columns = coordinate.shape[0] - 1
    gx = turned_x(body, k1, n[2], n[3])
    gy = turned_y(body, k1, n[2], n[3])
    way = coordinate[column, VALUE] if column >= 0 else drive[law, 0]
    px = turned_x(body, k1, n[0], n[1]) + way * gx
    py = turned_y(body, k1, n[0], n[1]) + way * gy
    turn(body, a, k1, n[4], n[5])
    cx = body[k1, X] + px
    cy = body[k1, Y] + py
    ax = place(body, a, cx, cy, n[6], n[7], 0)
    ay = place(body, a, cx, cy, n[6], n[7], 1)
    body[a, OMEGA] = body[k1, OMEGA]
    for j in range(columns + 1):
        cx = carry(body, rate, columns, j, k1, px, py, 0)
        cy = carry(body, rate, columns, j, k1, px, py, 1)
        slip = 0.0
        if j == column:
            slip = 1.0
        elif law > 0 and j == columns - 1:
            slip = drive[law, 1]
        elif j == columns:
            slip = drive[law, 2]
            twice = 2.0 * body[k1, OMEGA] * (coordinate[column, SPEED] if column >= 0 else drive[law, 1])
            cx -= twice * gy
            cy += twice * gx
        hang(body, rate, columns, j, a, cx + slip * gx, cy + slip * gy, rate[k1, 3 * j + 2], ax, ay)
    return SOLVED
