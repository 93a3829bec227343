"""Positions, velocities and accelerations of one group RRP, RPR or YOKE: equations in solve.py."""

from __future__ import annotations

import math

from mbsd.compiling.jit import lazy
from mbsd.kinematics.groups.points import MEETING, SOLVED, aim, carried, follow, hang, reach


@lazy(int)
def solve_rrp(bodies, n, qk, vk, ak, last, turn, point):
    """last (3 nb,): the pose before. See slides.solve_prp."""
    p = point[0]
    r = point[1]
    g = point[2]
    body = bodies[0]
    other = bodies[1]
    k1 = bodies[2]
    k2 = bodies[3]
    at = 3 * body
    carried(qk, vk, ak, turn, k1, n[0], n[1], p)
    carried(qk, vk, ak, turn, k2, n[6], n[7], r)
    lx = n[4] - n[2]
    ly = n[5] - n[3]
    square = lx * lx + ly * ly
    ex = turn[k2, 0] * n[8] - turn[k2, 1] * n[9]
    ey = turn[k2, 1] * n[8] + turn[k2, 0] * n[9]
    dx = r[0] - p[0]
    dy = r[1] - p[1]
    along = dx * ex + dy * ey
    across = dx * ey - dy * ex
    left = square - across * across
    point[3, 0] = left
    state = reach(left, square)
    if state != SOLVED:
        return state
    root = n[13] * math.sqrt(left)
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
    hang(qk, vk, ak, turn, body, p, n[2], n[3])
    if other >= 0:
        follow(qk, vk, ak, turn, other, k2, n[10])
        hang(qk, vk, ak, turn, other, g, n[11], n[12])
    return SOLVED


@lazy(int)
def solve_rpr(bodies, n, qk, vk, ak, last, tiny, turn, point):
    """tiny (m^2): the square of a length that counts as zero. See :func:`solve_rrp`."""
    p = point[0]
    r = point[1]
    body = bodies[0]
    other = bodies[1]
    k1 = bodies[2]
    k2 = bodies[3]
    at = 3 * body
    carried(qk, vk, ak, turn, k1, n[0], n[1], p)
    carried(qk, vk, ak, turn, k2, n[7], n[8], r)
    dx = r[0] - p[0]
    dy = r[1] - p[1]
    square = dx * dx + dy * dy
    left = square - n[6] * n[6]
    point[3, 0] = left
    state = reach(left, square)
    if not left > tiny:
        state = min(state, MEETING)
    if state != SOLVED:
        return state
    root = n[12] * math.sqrt(left)
    aim(turn, qk, last[at + 2], body, dx, dy, root * n[4] - n[6] * n[5], root * n[5] + n[6] * n[4])
    ex = turn[body, 0] * n[4] - turn[body, 1] * n[5]
    ey = turn[body, 1] * n[4] + turn[body, 0] * n[5]
    fx = r[2] - p[2]
    fy = r[3] - p[3]
    inverse = 1.0 / root
    omega = (ex * fy - ey * fx) * inverse
    rate = dx * fx + dy * fy
    point[3, 1] = 2.0 * rate
    rate *= inverse
    fx = r[4] - p[4] + omega * omega * dx + 2.0 * omega * rate * ey
    fy = r[5] - p[5] + omega * omega * dy - 2.0 * omega * rate * ex
    vk[at + 2] = omega
    ak[at + 2] = (ex * fy - ey * fx) * inverse
    hang(qk, vk, ak, turn, body, p, n[2], n[3])
    if other >= 0:
        follow(qk, vk, ak, turn, other, body, n[9])
        hang(qk, vk, ak, turn, other, r, n[10], n[11])
    return SOLVED


@lazy(int)
def solve_yoke(bodies, n, qk, vk, ak, turn, point):
    """See :func:`solve_rrp`."""
    p = point[0]
    r = point[1]
    g = point[2]
    body = bodies[0]
    k1 = bodies[2]
    k2 = bodies[3]
    point[3, 0] = 1.0
    point[3, 1] = 0.0
    carried(qk, vk, ak, turn, k1, n[0], n[1], p)
    carried(qk, vk, ak, turn, k2, n[6], n[7], r)
    ex = turn[k1, 0] * n[2] - turn[k1, 1] * n[3]
    ey = turn[k1, 1] * n[2] + turn[k1, 0] * n[3]
    nx = turn[k1, 0] * n[4] - turn[k1, 1] * n[5]
    ny = turn[k1, 1] * n[4] + turn[k1, 0] * n[5]
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
    follow(qk, vk, ak, turn, body, k1, n[8])
    hang(qk, vk, ak, turn, body, g, n[9], n[10])
    return SOLVED
