"""Positions, rates and convective accelerations of the groups with slides and rods; see groups.py.

Each is solved for columns j = 0 .. C - 1 of B and then, with the terms in omega^2, for the convective accelerations:
the same linear equations, whose right-hand sides come from ``carry``.
"""

from __future__ import annotations

import math

from mbsd.embedding.arrays import (
    COORDINATE,
    COS,
    FIRST,
    K1,
    K2,
    LAW,
    NEAR,
    OMEGA,
    SECOND,
    SIGN,
    SIN,
    SINE,
    SPEED,
    VALUE,
    X,
    Y,
)
from mbsd.embedding.branch import AVOIDED, DOUBTED, SOLVED, doubted, predicted
from mbsd.jit import internal

PARALLEL = 1e-3
"""Sine of the angle between two slides below which their crossing is in doubt."""


@internal
def _carry(body, rate, columns, j, b, x, y, part):
    """Rate (part 0: x, 1: y) in column j of a point with arm (x, y) in world axes that body b carries."""
    omega = rate[b, 3 * j + 2]
    out = rate[b, 3 * j] - omega * y if part == 0 else rate[b, 3 * j + 1] + omega * x
    if j == columns:
        square = body[b, OMEGA] * body[b, OMEGA]
        out -= square * (x if part == 0 else y)
    return out


@internal
def _hang(body, rate, columns, j, b, vx, vy, omega, x, y):
    """Rate in column j of body b that turns with omega, whose point with arm (x, y) in world axes has (vx, vy)."""
    rate[b, 3 * j] = vx + omega * y
    rate[b, 3 * j + 1] = vy - omega * x
    rate[b, 3 * j + 2] = omega
    if j == columns:
        square = body[b, OMEGA] * body[b, OMEGA]
        rate[b, 3 * j] += square * x
        rate[b, 3 * j + 1] += square * y


@internal
def _turn(body, b, leader, c, s):
    """Turn b as its leader, and by the angle of (c, s) more."""
    body[b, COS] = body[leader, COS] * c - body[leader, SIN] * s
    body[b, SIN] = body[leader, SIN] * c + body[leader, COS] * s


@internal
def _place(body, b, x, y, lx, ly, part):
    """Put b, whose turn is known, so that its point (lx, ly) is at (x, y); returns the arm in world axes."""
    ax = body[b, COS] * lx - body[b, SIN] * ly
    ay = body[b, SIN] * lx + body[b, COS] * ly
    body[b, X] = x - ax
    body[b, Y] = y - ay
    return ax if part == 0 else ay


@internal
def solve_rrp(bodies, n, body, rate, base, coordinate):
    """omega_A u_perp - s' e = C' - P'  (+ 2 omega_K s' e_perp + omega_A^2 u);  C' as K2 carries it."""
    a = bodies[FIRST]
    b = bodies[SECOND]
    k1 = bodies[K1]
    k2 = bodies[K2]
    columns = coordinate.shape[0] - 1
    c = body[k1, COS]
    s = body[k1, SIN]
    px = c * n[0] - s * n[1]
    py = s * n[0] + c * n[1]
    c = body[k2, COS]
    s = body[k2, SIN]
    qx = c * n[6] - s * n[7]
    qy = s * n[6] + c * n[7]
    ex = c * n[8] - s * n[9]
    ey = s * n[8] + c * n[9]
    dx = body[k2, X] + qx - body[k1, X] - px
    dy = body[k2, Y] + qy - body[k1, Y] - py
    along = dx * ex + dy * ey
    across = dx * ey - dy * ex
    left = n[14] - across * across
    n[SINE] = left * n[15]
    if not n[SINE] > AVOIDED:
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
    ax = _place(body, a, cx, cy, n[2], n[3], 0)
    ay = _place(body, a, cx, cy, n[2], n[3], 1)
    bx = 0.0
    by = 0.0
    if b >= 0:
        _turn(body, b, k2, n[10], n[11])
        bx = _place(body, b, tx, ty, n[12], n[13], 0)
        by = _place(body, b, tx, ty, n[12], n[13], 1)
        body[b, OMEGA] = body[k2, OMEGA]
    inverse = 1.0 / root
    turning = 0.0
    sliding = 0.0
    for j in range(columns + 1):
        cx = _carry(body, rate, columns, j, k1, px, py, 0)
        cy = _carry(body, rate, columns, j, k1, px, py, 1)
        tx = _carry(body, rate, columns, j, k2, sx, sy, 0)
        ty = _carry(body, rate, columns, j, k2, sx, sy, 1)
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
        _hang(body, rate, columns, j, a, cx, cy, omega, ax, ay)
        if b >= 0:
            _hang(body, rate, columns, j, b, tx + slip * ex, ty + slip * ey, rate[k2, 3 * j + 2], bx, by)
    return SOLVED


@internal
def solve_rpr(bodies, n, body, rate, base, coordinate):
    """omega d_perp + s' e = Q' - P'  (+ omega^2 d - 2 omega s' e_perp)."""
    a = bodies[FIRST]
    b = bodies[SECOND]
    k1 = bodies[K1]
    k2 = bodies[K2]
    columns = coordinate.shape[0] - 1
    c = body[k1, COS]
    s = body[k1, SIN]
    px = c * n[0] - s * n[1]
    py = s * n[0] + c * n[1]
    c = body[k2, COS]
    s = body[k2, SIN]
    qx = c * n[7] - s * n[8]
    qy = s * n[7] + c * n[8]
    cx = body[k1, X] + px
    cy = body[k1, Y] + py
    tx = body[k2, X] + qx
    ty = body[k2, Y] + qy
    dx = tx - cx
    dy = ty - cy
    square = dx * dx + dy * dy
    left = square - n[6] * n[6]
    n[SINE] = left / square if square > 0.0 else 0.0
    if not n[SINE] > AVOIDED:
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
    ax = _place(body, a, cx, cy, n[2], n[3], 0)
    ay = _place(body, a, cx, cy, n[2], n[3], 1)
    bx = 0.0
    by = 0.0
    if b >= 0:
        _turn(body, b, a, n[9], n[10])
        bx = _place(body, b, tx, ty, n[11], n[12], 0)
        by = _place(body, b, tx, ty, n[11], n[12], 1)
    inverse = 1.0 / root
    turning = 0.0
    sliding = 0.0
    for j in range(columns + 1):
        cx = _carry(body, rate, columns, j, k1, px, py, 0)
        cy = _carry(body, rate, columns, j, k1, px, py, 1)
        tx = _carry(body, rate, columns, j, k2, qx, qy, 0)
        ty = _carry(body, rate, columns, j, k2, qx, qy, 1)
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
        _hang(body, rate, columns, j, a, cx, cy, omega, ax, ay)
        if b >= 0:
            _hang(body, rate, columns, j, b, tx, ty, omega, bx, by)
    return SOLVED


@internal
def solve_yoke(bodies, n, body, rate, coordinate):
    """s' n.e = n . (Q' - K')  (- 2 omega_K (Q' - K')_perp);  K' the point Q as K1 carries it."""
    a = bodies[FIRST]
    k1 = bodies[K1]
    k2 = bodies[K2]
    columns = coordinate.shape[0] - 1
    c = body[k1, COS]
    s = body[k1, SIN]
    px = c * n[0] - s * n[1]
    py = s * n[0] + c * n[1]
    ex = c * n[2] - s * n[3]
    ey = s * n[2] + c * n[3]
    nx = c * n[4] - s * n[5]
    ny = s * n[4] + c * n[5]
    c = body[k2, COS]
    s = body[k2, SIN]
    qx = c * n[6] - s * n[7]
    qy = s * n[6] + c * n[7]
    dx = body[k2, X] + qx - body[k1, X] - px
    dy = body[k2, Y] + qy - body[k1, Y] - py
    inverse = 1.0 / (nx * ex + ny * ey)
    slide = (nx * dx + ny * dy) * inverse
    sx = px + slide * ex
    sy = py + slide * ey
    gx = px + dx
    gy = py + dy
    _turn(body, a, k1, n[8], n[9])
    tx = body[k1, X] + sx
    ty = body[k1, Y] + sy
    ax = _place(body, a, tx, ty, n[10], n[11], 0)
    ay = _place(body, a, tx, ty, n[10], n[11], 1)
    spin = body[k1, OMEGA]
    body[a, OMEGA] = spin
    sliding = 0.0
    past_x = 0.0
    past_y = 0.0
    for j in range(columns + 1):
        fx = _carry(body, rate, columns, j, k2, qx, qy, 0) - _carry(body, rate, columns, j, k1, gx, gy, 0)
        fy = _carry(body, rate, columns, j, k2, qx, qy, 1) - _carry(body, rate, columns, j, k1, gx, gy, 1)
        tx = _carry(body, rate, columns, j, k1, sx, sy, 0)
        ty = _carry(body, rate, columns, j, k1, sx, sy, 1)
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
        _hang(body, rate, columns, j, a, tx + slip * ex, ty + slip * ey, rate[k1, 3 * j + 2], ax, ay)
    return SOLVED


@internal
def solve_prp(bodies, n, body, rate, coordinate):
    """s1' e1 - s2' e2 = C2' - C1'  (+ 2 omega_2 s2' e2_perp - 2 omega_1 s1' e1_perp)."""
    a = bodies[FIRST]
    b = bodies[SECOND]
    k1 = bodies[K1]
    k2 = bodies[K2]
    columns = coordinate.shape[0] - 1
    c = body[k1, COS]
    s = body[k1, SIN]
    px = c * n[0] - s * n[1]
    py = s * n[0] + c * n[1]
    ex = c * n[2] - s * n[3]
    ey = s * n[2] + c * n[3]
    c = body[k2, COS]
    s = body[k2, SIN]
    qx = c * n[8] - s * n[9]
    qy = s * n[8] + c * n[9]
    fx = c * n[10] - s * n[11]
    fy = s * n[10] + c * n[11]
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
    _turn(body, a, k1, n[4], n[5])
    tx = body[k1, X] + px
    ty = body[k1, Y] + py
    ax = _place(body, a, tx, ty, n[6], n[7], 0)
    ay = _place(body, a, tx, ty, n[6], n[7], 1)
    body[a, OMEGA] = body[k1, OMEGA]
    bx = 0.0
    by = 0.0
    if b >= 0:
        _turn(body, b, k2, n[12], n[13])
        bx = _place(body, b, tx, ty, n[14], n[15], 0)
        by = _place(body, b, tx, ty, n[14], n[15], 1)
        body[b, OMEGA] = body[k2, OMEGA]
    slip1 = 0.0
    slip2 = 0.0
    for j in range(columns + 1):
        cx = _carry(body, rate, columns, j, k1, px, py, 0)
        cy = _carry(body, rate, columns, j, k1, px, py, 1)
        tx = _carry(body, rate, columns, j, k2, qx, qy, 0)
        ty = _carry(body, rate, columns, j, k2, qx, qy, 1)
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
        _hang(body, rate, columns, j, a, gx, gy, rate[k1, 3 * j + 2], ax, ay)
        if b >= 0:
            _hang(body, rate, columns, j, b, gx, gy, rate[k2, 3 * j + 2], bx, by)
    return SOLVED


@internal
def solve_rod(bodies, n, body, rate, base, coordinate, drive):
    """omega w . u_perp = l l' + w . (Q' - P').

    alpha w . u_perp = l'^2 + l l'' - |w'|^2 + w . (Q'' - P'' + omega^2 u)
    """
    a = bodies[FIRST]
    k1 = bodies[K1]
    k2 = bodies[K2]
    law = bodies[LAW]
    columns = coordinate.shape[0] - 1
    c = body[k1, COS]
    s = body[k1, SIN]
    px = c * n[0] - s * n[1]
    py = s * n[0] + c * n[1]
    c = body[k2, COS]
    s = body[k2, SIN]
    qx = c * n[6] - s * n[7]
    qy = s * n[6] + c * n[7]
    cx = body[k1, X] + px
    cy = body[k1, Y] + py
    dx = body[k2, X] + qx - cx
    dy = body[k2, Y] + qy - cy
    rod = n[8] + drive[law, 0]
    square = dx * dx + dy * dy
    half = 0.5 * (square + n[9] - rod * rod)
    cross = n[9] * square - half * half
    n[SINE] = cross / (n[9] * rod * rod)
    if not n[SINE] > AVOIDED:
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
    ax = _place(body, a, cx, cy, n[2], n[3], 0)
    ay = _place(body, a, cx, cy, n[2], n[3], 1)
    lever = 1.0 / (wy * ux - wx * uy)
    turning = 0.0
    past_x = 0.0
    past_y = 0.0
    for j in range(columns + 1):
        cx = _carry(body, rate, columns, j, k1, px, py, 0)
        cy = _carry(body, rate, columns, j, k1, px, py, 1)
        fx = _carry(body, rate, columns, j, k2, qx, qy, 0) - cx
        fy = _carry(body, rate, columns, j, k2, qx, qy, 1) - cy
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
        _hang(body, rate, columns, j, a, cx, cy, omega, ax, ay)
    return SOLVED


@internal
def solve_slide(bodies, n, body, rate, coordinate, drive):
    """S = S_0 + f g:  S' = K' + f' g  (S'' = K'' + 2 omega_K f' g_perp + f'' g);  K' the point S as K1 carries it."""
    a = bodies[FIRST]
    k1 = bodies[K1]
    law = bodies[LAW]
    column = bodies[COORDINATE]
    columns = coordinate.shape[0] - 1
    c = body[k1, COS]
    s = body[k1, SIN]
    gx = c * n[2] - s * n[3]
    gy = s * n[2] + c * n[3]
    way = coordinate[column, VALUE] if column >= 0 else drive[law, 0]
    px = c * n[0] - s * n[1] + way * gx
    py = s * n[0] + c * n[1] + way * gy
    _turn(body, a, k1, n[4], n[5])
    cx = body[k1, X] + px
    cy = body[k1, Y] + py
    ax = _place(body, a, cx, cy, n[6], n[7], 0)
    ay = _place(body, a, cx, cy, n[6], n[7], 1)
    body[a, OMEGA] = body[k1, OMEGA]
    for j in range(columns + 1):
        cx = _carry(body, rate, columns, j, k1, px, py, 0)
        cy = _carry(body, rate, columns, j, k1, px, py, 1)
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
        _hang(body, rate, columns, j, a, cx + slip * gx, cy + slip * gy, rate[k1, 3 * j + 2], ax, ay)
    return SOLVED
