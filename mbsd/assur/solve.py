"""The compiled closed forms: positions, velocities and accelerations of all groups at all times.

PRP, ROD and SLIDE are in slides.py, points carried by a body in points.py.

    RRR   C where the circles about P and Q meet;  with u = C - P, w = C - Q:
          omega_A u_perp - omega_B w_perp = q' - p'
          alpha_A u_perp - alpha_B w_perp = q'' - p'' + omega_A^2 u - omega_B^2 w
    RRP   C = C_0 + s e where the circle about P meets the line;  c the point C as K2 carries it:
          omega_A u_perp - s' e = c' - p'
          alpha_A u_perp - s'' e = c'' + 2 omega_K s' e_perp - p'' + omega_A^2 u
    RPR   |Q - P|^2 = t^2 + offset^2;  with d = Q - P:
          omega d_perp + s' e = q' - p',   alpha d_perp + s'' e = q'' - p'' + omega^2 d - 2 omega s' e_perp
    YOKE  n . (Q - S_0 - s e) = 0;  with k the point Q as K1 carries it:
          s' n.e = n . (q' - k'),   s'' n.e = n . (q'' - k'' - 2 omega_K (q' - k')_perp)

The branch is that of the start. A step is doubted, and all is left to Newton-Raphson, where the other branch lies
nearly as close to the extrapolated motion, where the discriminant vanishes, or where a law jumps.
"""

from __future__ import annotations

import math

from mbsd.assur.groups import DRIVEN, PRP, ROD, RPR, RRP, RRR, WELDED, YOKE
from mbsd.assur.points import DOUBTED, FLAT, OPEN, SOLVED, aim, carried, doubtful, follow, hang, jumps
from mbsd.assur.slides import solve_prp, solve_rod, solve_slide
from mbsd.jit import kernel


@kernel
def solve_groups(groups, start, times, drives, q, v, a, turn, point):
    """Fill q, v, a (T, 3 nb) at times (T,) with drives (T, motions + 1, 3), angles going on from start (3 nb,).

    ``turn`` (nb, 2) must hold (1, 0) for ground; ``point`` (3, 8) is scratch. Returns (status, index).
    """
    p = point[0]
    r = point[1]
    g = point[2]
    for k in range(times.shape[0]):
        qk = q[k]
        vk = v[k]
        ak = a[k]
        before = max(k - 1, 0)
        last = start if k == 0 else q[before]
        h = times[k] - times[k - 1] if k > 0 else 0.0
        for e in range(groups.kind.shape[0]):
            kind = groups.kind[e]
            body = groups.body[e, 0]
            other = groups.body[e, 1]
            k1 = groups.body[e, 2]
            k2 = groups.body[e, 3]
            n = groups.number[e]
            at = 3 * body
            if kind <= WELDED:
                if kind == DRIVEN:
                    d = drives[k, groups.motion[e]]
                    if k > 0 and jumps(d, drives[k - 1, groups.motion[e]], h):
                        return DOUBTED, k
                    angle = qk[3 * k2 + 2] + n[5] * (n[4] + d[0])
                    vk[at + 2] = vk[3 * k2 + 2] + n[5] * d[1]
                    ak[at + 2] = ak[3 * k2 + 2] + n[5] * d[2]
                else:
                    angle = qk[3 * k1 + 2] + n[4]
                    vk[at + 2] = vk[3 * k1 + 2]
                    ak[at + 2] = ak[3 * k1 + 2]
                qk[at + 2] = angle
                turn[body, 0] = math.cos(angle)
                turn[body, 1] = math.sin(angle)
                carried(qk, vk, ak, turn, k1, n[0], n[1], p)
                hang(qk, vk, ak, turn, body, p, n[2], n[3])
            elif kind == RRR:
                carried(qk, vk, ak, turn, k1, n[0], n[1], p)
                carried(qk, vk, ak, turn, k2, n[6], n[7], r)
                lx = n[4] - n[2]
                ly = n[5] - n[3]
                mx = n[10] - n[8]
                my = n[11] - n[9]
                first = lx * lx + ly * ly
                second = mx * mx + my * my
                dx = r[0] - p[0]
                dy = r[1] - p[1]
                square = dx * dx + dy * dy
                if not square > FLAT * first:
                    return DOUBTED, k
                inverse = 1.0 / square
                along = 0.5 * (square + first - second) * inverse
                height = first * inverse - along * along
                if not height > FLAT:
                    return (OPEN if height < -FLAT else DOUBTED), k
                height = n[12] * math.sqrt(height)
                ux = along * dx - height * dy
                uy = along * dy + height * dx
                wx = ux - dx
                wy = uy - dy
                aim(turn, qk, last[at + 2], body, ux, uy, lx, ly)
                aim(turn, qk, last[3 * other + 2], other, wx, wy, mx, my)
                if k > 0 and doubtful(
                    qk, last, v[k - 1], a[k - 1], h, at + 2, height * height / (along * along + height * height)
                ):
                    return DOUBTED, k
                det = 1.0 / (uy * wx - ux * wy)
                fx = r[2] - p[2]
                fy = r[3] - p[3]
                omega = (fx * wx + fy * wy) * det
                turning = (fx * ux + fy * uy) * det
                fx = r[4] - p[4] + omega * omega * ux - turning * turning * wx
                fy = r[5] - p[5] + omega * omega * uy - turning * turning * wy
                vk[at + 2] = -omega
                ak[at + 2] = -(fx * wx + fy * wy) * det
                vk[3 * other + 2] = -turning
                ak[3 * other + 2] = -(fx * ux + fy * uy) * det
                hang(qk, vk, ak, turn, body, p, n[2], n[3])
                hang(qk, vk, ak, turn, other, r, n[8], n[9])
            elif kind == RRP:
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
                if not left > FLAT * square:
                    return (OPEN if left < -FLAT * square else DOUBTED), k
                root = n[13] * math.sqrt(left)
                slide = root - along
                sx = slide * ex
                sy = slide * ey
                ux = dx + sx
                uy = dy + sy
                aim(turn, qk, last[at + 2], body, ux, uy, lx, ly)
                if k > 0 and doubtful(qk, last, v[k - 1], a[k - 1], h, at + 2, left / square):
                    return DOUBTED, k
                spin = vk[3 * k2 + 2]
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
            elif kind == RPR:
                carried(qk, vk, ak, turn, k1, n[0], n[1], p)
                carried(qk, vk, ak, turn, k2, n[7], n[8], r)
                dx = r[0] - p[0]
                dy = r[1] - p[1]
                square = dx * dx + dy * dy
                left = square - n[6] * n[6]
                if not left > FLAT * square:
                    return (OPEN if left < -FLAT * square else DOUBTED), k
                root = n[12] * math.sqrt(left)
                aim(turn, qk, last[at + 2], body, dx, dy, root * n[4] - n[6] * n[5], root * n[5] + n[6] * n[4])
                if k > 0 and doubtful(qk, last, v[k - 1], a[k - 1], h, at + 2, left / square):
                    return DOUBTED, k
                ex = turn[body, 0] * n[4] - turn[body, 1] * n[5]
                ey = turn[body, 1] * n[4] + turn[body, 0] * n[5]
                fx = r[2] - p[2]
                fy = r[3] - p[3]
                inverse = 1.0 / root
                omega = (ex * fy - ey * fx) * inverse
                rate = (dx * fx + dy * fy) * inverse
                fx = r[4] - p[4] + omega * omega * dx + 2.0 * omega * rate * ey
                fy = r[5] - p[5] + omega * omega * dy - 2.0 * omega * rate * ex
                vk[at + 2] = omega
                ak[at + 2] = (ex * fy - ey * fx) * inverse
                hang(qk, vk, ak, turn, body, p, n[2], n[3])
                if other >= 0:
                    follow(qk, vk, ak, turn, other, body, n[9])
                    hang(qk, vk, ak, turn, other, r, n[10], n[11])
            elif kind == YOKE:
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
            else:
                bodies = groups.body[e]
                law = drives[k, groups.motion[e]]
                if k > 0 and groups.motion[e] > 0 and jumps(law, drives[k - 1, groups.motion[e]], h):
                    return DOUBTED, k
                if kind == PRP:
                    state = solve_prp(bodies, n, qk, vk, ak, last, v[before], a[before], h, turn, point)
                elif kind == ROD:
                    state = solve_rod(bodies, n, law, qk, vk, ak, last, v[before], a[before], h, turn, point)
                else:
                    state = solve_slide(bodies, n, law, qk, vk, ak, turn, point)
                if state != SOLVED:
                    return state, k
    return SOLVED, times.shape[0]
