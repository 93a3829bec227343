"""Groups YOKE and PRP: two slides. Equations as in groups.py, with the terms in omega^2 in the last column.

YOKE  s' n.e = n . (Q' - K')  (- 2 omega_K (Q' - K')_perp);  K' the point Q as K1 carries it
PRP   s1' e1 - s2' e2 = C2' - C1'  (+ 2 omega_2 s2' e2_perp - 2 omega_1 s1' e1_perp)
"""

from __future__ import annotations

from mbsd.compiling.jit import lazy
from mbsd.dynamics.embedding.arrays import FIRST, K1, K2, OMEGA, SECOND, SPEED, X, Y
from mbsd.dynamics.embedding.groups.branch import DOUBTED, SOLVED
from mbsd.dynamics.embedding.groups.carrying import carry, hang, place, turn, turned_x, turned_y

PARALLEL = 1e-3
"""Sine of the angle between two slides below which their crossing is in doubt."""


@lazy(int)
def solve_yoke(bodies, n, body, rate, coordinate):
    """s' n.e = n . (Q' - K')  (- 2 omega_K (Q' - K')_perp);  K' the point Q as K1 carries it."""
    a = bodies[FIRST]
    k1 = bodies[K1]
    k2 = bodies[K2]
    columns = coordinate.shape[0] - 1
    px = turned_x(body, k1, n[0], n[1])
    py = turned_y(body, k1, n[0], n[1])
    ex = turned_x(body, k1, n[2], n[3])
    ey = turned_y(body, k1, n[2], n[3])
    nx = turned_x(body, k1, n[4], n[5])
    ny = turned_y(body, k1, n[4], n[5])
    qx = turned_x(body, k2, n[6], n[7])
    qy = turned_y(body, k2, n[6], n[7])
    dx = body[k2, X] + qx - body[k1, X] - px
    dy = body[k2, Y] + qy - body[k1, Y] - py
    inverse = 1.0 / (nx * ex + ny * ey)
    slide = (nx * dx + ny * dy) * inverse
    sx = px + slide * ex
    sy = py + slide * ey
    gx = px + dx
    gy = py + dy
    turn(body, a, k1, n[8], n[9])
    tx = body[k1, X] + sx
    ty = body[k1, Y] + sy
    ax = place(body, a, tx, ty, n[10], n[11], 0)
    ay = place(body, a, tx, ty, n[10], n[11], 1)
    spin = body[k1, OMEGA]
    body[a, OMEGA] = spin
    sliding = 0.0
    past_x = 0.0
    past_y = 0.0
    for j in range(columns + 1):
        fx = carry(body, rate, columns, j, k2, qx, qy, 0) - carry(body, rate, columns, j, k1, gx, gy, 0)
        fy = carry(body, rate, columns, j, k2, qx, qy, 1) - carry(body, rate, columns, j, k1, gx, gy, 1)
        tx = carry(body, rate, columns, j, k1, sx, sy, 0)
        ty = carry(body, rate, columns, j, k1, sx, sy, 1)
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
        hang(body, rate, columns, j, a, tx + slip * ex, ty + slip * ey, rate[k1, 3 * j + 2], ax, ay)
    return SOLVED


@lazy(int)
def solve_prp(bodies, n, body, rate, coordinate):
    """s1' e1 - s2' e2 = C2' - C1'  (+ 2 omega_2 s2' e2_perp - 2 omega_1 s1' e1_perp)."""
    a = bodies[FIRST]
    b = bodies[SECOND]
    k1 = bodies[K1]
    k2 = bodies[K2]
    columns = coordinate.shape[0] - 1
    px = turned_x(body, k1, n[0], n[1])
    py = turned_y(body, k1, n[0], n[1])
    ex = turned_x(body, k1, n[2], n[3])
    ey = turned_y(body, k1, n[2], n[3])
    qx = turned_x(body, k2, n[8], n[9])
    qy = turned_y(body, k2, n[8], n[9])
    fx = turned_x(body, k2, n[10], n[11])
    fy = turned_y(body, k2, n[10], n[11])
    sine = fx * ey - fy * ex
    if not abs(sine) > PARALLEL:
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
    turn(body, a, k1, n[4], n[5])
    tx = body[k1, X] + px
    ty = body[k1, Y] + py
    ax = place(body, a, tx, ty, n[6], n[7], 0)
    ay = place(body, a, tx, ty, n[6], n[7], 1)
    body[a, OMEGA] = body[k1, OMEGA]
    bx = 0.0
    by = 0.0
    if b >= 0:
        turn(body, b, k2, n[12], n[13])
        bx = place(body, b, tx, ty, n[14], n[15], 0)
        by = place(body, b, tx, ty, n[14], n[15], 1)
        body[b, OMEGA] = body[k2, OMEGA]
    slip1 = 0.0
    slip2 = 0.0
    for j in range(columns + 1):
        cx = carry(body, rate, columns, j, k1, px, py, 0)
        cy = carry(body, rate, columns, j, k1, px, py, 1)
        tx = carry(body, rate, columns, j, k2, qx, qy, 0)
        ty = carry(body, rate, columns, j, k2, qx, qy, 1)
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
        hang(body, rate, columns, j, a, gx, gy, rate[k1, 3 * j + 2], ax, ay)
        if b >= 0:
            hang(body, rate, columns, j, b, gx, gy, rate[k2, 3 * j + 2], bx, by)
    return SOLVED
