"""Positions, velocities and accelerations of one group PRP, ROD, SLIDE or TRAIN; the others are in solve.py.

PRP   C = C_1 + s_1 e_1 = C_2 + s_2 e_2 where two slides cross;  c_i the point C as K_i carries it:
      s_1' e_1 - s_2' e_2 = c_2' - c_1'
      s_1'' e_1 - s_2'' e_2 = c_2'' + 2 omega_2 s_2' e_2_perp - c_1'' - 2 omega_1 s_1' e_1_perp
ROD   C where the circles about P and Q meet;  u = C - P, w = C - Q, |w| = l:
      omega w . u_perp = l l' + w . (q' - p')
      alpha w . u_perp = l'^2 + l l'' - |w'|^2 + w . (q'' - p'' + omega^2 u)
SLIDE S = S_0 + f g:  S' = k' + f' g,  S'' = k'' + 2 omega_K f' g_perp + f'' g;  k the point S as K1 carries it
"""

from __future__ import annotations

import math

from mbsd.compiling.jit import lazy
from mbsd.kinematics.groups.points import MEETING, SOLVED, aim, carried, follow, hang, reach

PARALLEL = 1e-6
"""Sine of the angle between two slides below which they do not cross."""


@lazy(int)
def solve_prp(body, n, qk, vk, ak, turn, point):
    """Fill positions, velocities and accelerations qk, vk, ak (3 nb,) of the group's bodies; return SOLVED or why not.

    ``point`` (4, 8): scratch; its last row gets the discriminant and its rate, here sine^2 between the slides.
    """
    p = point[0]
    r = point[1]
    g = point[2]
    one = body[0]
    two = body[1]
    k1 = body[2]
    k2 = body[3]
    carried(qk, vk, ak, turn, k1, n[0], n[1], p)
    carried(qk, vk, ak, turn, k2, n[7], n[8], r)
    ex = turn[k1, 0] * n[2] - turn[k1, 1] * n[3]
    ey = turn[k1, 1] * n[2] + turn[k1, 0] * n[3]
    fx = turn[k2, 0] * n[9] - turn[k2, 1] * n[10]
    fy = turn[k2, 1] * n[9] + turn[k2, 0] * n[10]
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
    follow(qk, vk, ak, turn, one, k1, n[4])
    hang(qk, vk, ak, turn, one, g, n[5], n[6])
    if two >= 0:
        follow(qk, vk, ak, turn, two, k2, n[11])
        hang(qk, vk, ak, turn, two, g, n[12], n[13])
    return SOLVED


@lazy(int)
def solve_rod(body, n, law, qk, vk, ak, last, turn, point):
    """law (3,): l and its rates beside the constant length; last (3 nb,): the pose before. See :func:`solve_prp`."""
    p = point[0]
    r = point[1]
    one = body[0]
    carried(qk, vk, ak, turn, body[2], n[0], n[1], p)
    carried(qk, vk, ak, turn, body[3], n[6], n[7], r)
    lx = n[4] - n[2]
    ly = n[5] - n[3]
    rod = n[8] + law[0]
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
    height = n[9] * 0.5 * inverse * math.sqrt(left)
    ux = along * dx - height * dy
    uy = along * dy + height * dx
    wx = ux - dx
    wy = uy - dy
    aim(turn, qk, last[3 * one + 2], one, ux, uy, lx, ly)
    lever = 1.0 / (wy * ux - wx * uy)
    omega = (rod * law[1] + wx * fx + wy * fy) * lever
    rate_x = -omega * uy - fx
    rate_y = omega * ux - fy
    fx = r[4] - p[4] + omega * omega * ux
    fy = r[5] - p[5] + omega * omega * uy
    bend = law[1] * law[1] + rod * law[2] - rate_x * rate_x - rate_y * rate_y
    vk[3 * one + 2] = omega
    ak[3 * one + 2] = (bend + wx * fx + wy * fy) * lever
    hang(qk, vk, ak, turn, one, p, n[2], n[3])
    return SOLVED


@lazy(int)
def solve_slide(body, n, law, qk, vk, ak, turn, point):
    """law (3,): f and its rates. See :func:`solve_prp`."""
    p = point[0]
    k1 = body[2]
    gx = turn[k1, 0] * n[2] - turn[k1, 1] * n[3]
    gy = turn[k1, 1] * n[2] + turn[k1, 0] * n[3]
    carried(qk, vk, ak, turn, k1, n[0] + law[0] * n[2], n[1] + law[0] * n[3], p)
    spin = 2.0 * vk[3 * k1 + 2] * law[1]
    p[2] += law[1] * gx
    p[3] += law[1] * gy
    p[4] += law[2] * gx - spin * gy
    p[5] += law[2] * gy + spin * gx
    follow(qk, vk, ak, turn, body[0], k1, n[4])
    hang(qk, vk, ak, turn, body[0], p, n[5], n[6])
    return SOLVED


@lazy(None)
def solve_train(train, body_of, share_of, body, k1, n, qk, vk, ak, turn, p):
    """train (2,): first share and how many; the angle is their sum. ``p`` (8,): scratch."""
    angle = n[4]
    omega = 0.0
    alpha = 0.0
    for i in range(train[0], train[0] + train[1]):
        c = 3 * body_of[i] + 2
        angle += share_of[i] * qk[c]
        omega += share_of[i] * vk[c]
        alpha += share_of[i] * ak[c]
    at = 3 * body + 2
    qk[at] = angle
    vk[at] = omega
    ak[at] = alpha
    turn[body, 0] = math.cos(angle)
    turn[body, 1] = math.sin(angle)
    carried(qk, vk, ak, turn, k1, n[0], n[1], p)
    hang(qk, vk, ak, turn, body, p, n[2], n[3])
