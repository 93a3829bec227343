"""Groups RRP and RPR: two pins and a slide. Equations as in groups.py, with the terms in omega^2 in the last column.

RRP   omega_A u_perp - s' e = C' - P'  (+ 2 omega_K s' e_perp + omega_A^2 u);  C' as K2 carries it
RPR   omega d_perp + s' e = Q' - P'  (+ omega^2 d - 2 omega s' e_perp)
"""

from __future__ import annotations

import math

from mbsd.compiling.jit import lazy
from mbsd.dynamics.embedding.arrays import AVOID, COS, FIRST, K1, K2, NEAR, OMEGA, SECOND, SIGN, SIN, SINE, SPEED, X, Y
from mbsd.dynamics.embedding.groups.branch import DOUBTED, SOLVED, doubted, predicted
from mbsd.dynamics.embedding.groups.carrying import carry, hang, place, turn, turned_x, turned_y


@lazy(int)
def solve_rrp(bodies, n, body, rate, base, coordinate):
    """omega_A u_perp - s' e = C' - P'  (+ 2 omega_K s' e_perp + omega_A^2 u);  C' as K2 carries it."""
    a = bodies[FIRST]
    b = bodies[SECOND]
    k1 = bodies[K1]
    k2 = bodies[K2]
    columns = coordinate.shape[0] - 1
    px = turned_x(body, k1, n[0], n[1])
    py = turned_y(body, k1, n[0], n[1])
    qx = turned_x(body, k2, n[6], n[7])
    qy = turned_y(body, k2, n[6], n[7])
    ex = turned_x(body, k2, n[8], n[9])
    ey = turned_y(body, k2, n[8], n[9])
    dx = body[k2, X] + qx - body[k1, X] - px
    dy = body[k2, Y] + qy - body[k1, Y] - py
    along = dx * ex + dy * ey
    across = dx * ey - dy * ex
    left = n[14] - across * across
    n[SINE] = left * n[15]
    if not n[SINE] > n[AVOID]:
        return DOUBTED
    root = math.sqrt(left)
    if n[NEAR] > 0.0:
        theta = predicted(base, coordinate, a)
        c = math.cos(theta)
        s = math.sin(theta)
        side = n[14] * ((c * n[4] - s * n[5]) * ex + (s * n[4] + c * n[5]) * ey)
        if doubted(side, root):
            return DOUBTED
        n[SIGN] = 1.0 if side > 0.0 else -1.0
    root *= n[SIGN]
    slide = root - along
    sx = qx + slide * ex
    sy = qy + slide * ey
    ux = dx + slide * ex
    uy = dy + slide * ey
    body[a, COS] = ux * n[4] + uy * n[5]
    body[a, SIN] = uy * n[4] - ux * n[5]
    tx = body[k2, X] + sx
    ty = body[k2, Y] + sy
    cx = body[k1, X] + px
    cy = body[k1, Y] + py
    ax = place(body, a, cx, cy, n[2], n[3], 0)
    ay = place(body, a, cx, cy, n[2], n[3], 1)
    bx = 0.0
    by = 0.0
    if b >= 0:
        turn(body, b, k2, n[10], n[11])
        bx = place(body, b, tx, ty, n[12], n[13], 0)
        by = place(body, b, tx, ty, n[12], n[13], 1)
        body[b, OMEGA] = body[k2, OMEGA]
    inverse = 1.0 / root
    turning = 0.0
    sliding = 0.0
    for j in range(columns + 1):
        cx = carry(body, rate, columns, j, k1, px, py, 0)
        cy = carry(body, rate, columns, j, k1, px, py, 1)
        tx = carry(body, rate, columns, j, k2, sx, sy, 0)
        ty = carry(body, rate, columns, j, k2, sx, sy, 1)
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
        hang(body, rate, columns, j, a, cx, cy, omega, ax, ay)
        if b >= 0:
            hang(body, rate, columns, j, b, tx + slip * ex, ty + slip * ey, rate[k2, 3 * j + 2], bx, by)
    return SOLVED


@lazy(int)
def solve_rpr(bodies, n, body, rate, base, coordinate):
    """omega d_perp + s' e = Q' - P'  (+ omega^2 d - 2 omega s' e_perp)."""
    a = bodies[FIRST]
    b = bodies[SECOND]
    k1 = bodies[K1]
    k2 = bodies[K2]
    columns = coordinate.shape[0] - 1
    px = turned_x(body, k1, n[0], n[1])
    py = turned_y(body, k1, n[0], n[1])
    qx = turned_x(body, k2, n[7], n[8])
    qy = turned_y(body, k2, n[7], n[8])
    cx = body[k1, X] + px
    cy = body[k1, Y] + py
    tx = body[k2, X] + qx
    ty = body[k2, Y] + qy
    dx = tx - cx
    dy = ty - cy
    square = dx * dx + dy * dy
    left = square - n[6] * n[6]
    n[SINE] = left / square if square > 0.0 else 0.0
    if not n[SINE] > n[AVOID]:
        return DOUBTED
    root = math.sqrt(left)
    if n[NEAR] > 0.0:
        theta = predicted(base, coordinate, a)
        c = math.cos(theta)
        s = math.sin(theta)
        side = (c * n[4] - s * n[5]) * dx + (s * n[4] + c * n[5]) * dy
        if doubted(side, root):
            return DOUBTED
        n[SIGN] = 1.0 if side > 0.0 else -1.0
    root *= n[SIGN]
    # the axis and its normal in the group's frame: d = root e + offset e_perp
    inverse = 1.0 / square
    ex = (root * dx + n[6] * dy) * inverse
    ey = (root * dy - n[6] * dx) * inverse
    body[a, COS] = ex * n[4] + ey * n[5]
    body[a, SIN] = ey * n[4] - ex * n[5]
    ax = place(body, a, cx, cy, n[2], n[3], 0)
    ay = place(body, a, cx, cy, n[2], n[3], 1)
    bx = 0.0
    by = 0.0
    if b >= 0:
        turn(body, b, a, n[9], n[10])
        bx = place(body, b, tx, ty, n[11], n[12], 0)
        by = place(body, b, tx, ty, n[11], n[12], 1)
    inverse = 1.0 / root
    turning = 0.0
    sliding = 0.0
    for j in range(columns + 1):
        cx = carry(body, rate, columns, j, k1, px, py, 0)
        cy = carry(body, rate, columns, j, k1, px, py, 1)
        tx = carry(body, rate, columns, j, k2, qx, qy, 0)
        ty = carry(body, rate, columns, j, k2, qx, qy, 1)
        fx = tx - cx
        fy = ty - cy
        if j == columns:
            body[a, OMEGA] = turning
            if b >= 0:
                body[b, OMEGA] = turning
            fx += turning * turning * dx + 2.0 * turning * sliding * ey
            fy += turning * turning * dy - 2.0 * turning * sliding * ex
        omega = (ex * fy - ey * fx) * inverse
        if j < columns:
            turning += omega * coordinate[j, SPEED]
            sliding += (dx * fx + dy * fy) * inverse * coordinate[j, SPEED]
        hang(body, rate, columns, j, a, cx, cy, omega, ax, ay)
        if b >= 0:
            hang(body, rate, columns, j, b, tx, ty, omega, bx, by)
    return SOLVED
