"""The compiled closed forms: positions, velocities and accelerations of all groups at all times.

RRP, RPR and YOKE are in one_slide.py, PRP, ROD, SLIDE and trains in slides.py, blocks of Newton-Raphson in newton/,
carried points in points.py.

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

Discriminants D, whose sign tells whether the group closes, and whose rates tell whether it does between two poses:

    RRR   D = 4 a^2 b^2 - m^2,  m = a^2 + b^2 - |Q - P|^2;   D' = 4 m (Q - P) . (q' - p')
    RRP   D = a^2 - c^2,  c = (Q - P) x e;                   D' = -2 c c'
    RPR   D = |Q - P|^2 - offset^2;                          D' = 2 (Q - P) . (q' - p')

The branch is that of the start. A step is doubted, and a pose between is asked for, where the discriminant may vanish
between its ends, where a body turns too far to count turns, or where a law moves too far or jumps.
"""

from __future__ import annotations

import math

from mbsd.compiling.jit import kernel
from mbsd.kinematics.groups.blocks import BLOCK, CARRIES_ON, DOUBTED_BEFORE, NEAR_AT, ROWS_AT, TRAIN, TREE_AT
from mbsd.kinematics.groups.groups import DRIVEN, PRP, RPR, RRP, RRR, SLIDE, WELDED, YOKE
from mbsd.kinematics.groups.newton.call import call_block
from mbsd.kinematics.groups.one_slide import solve_rpr, solve_rrp, solve_yoke
from mbsd.kinematics.groups.points import DOUBTED, SOLVED, aim, carried, dip, hang, reach, wound
from mbsd.kinematics.groups.slides import solve_prp, solve_rod, solve_slide, solve_train
from mbsd.kinematics.law_step import jumps


@kernel
def solve_groups(
    groups, blocks, start, times, drives, stride, tiny, first_row, q, v, a, determinant, turn, point, before
):
    """Fill rows ``first_row`` .. of q, v, a (T, 3 nb) at times (T,) with drives (T, motions + 1, 3).

    Angles go on from start (3 nb,). ``stride`` (motions + 1,) is how far each law may go in one step, ``tiny`` (m^2)
    the square of a length that counts as zero. The row ``first_row`` itself is not compared with the one before it.
    ``determinant`` (blocks, T, 1) is filled for the blocks (mbsd/kinematics/groups/blocks.py).
    Scratch: ``turn`` (nb, 2) with (1, 0) for ground, ``point`` (4, 8), ``before`` (g, 2) discriminants and their rates.
    Returns (status, index, part): where a step was DOUBTED, the part of it at which a pose is asked for.
    """
    p = point[0]
    r = point[1]
    for k in range(first_row, times.shape[0]):
        qk = q[k]
        vk = v[k]
        ak = a[k]
        last = start if k == 0 else q[k - 1]
        goes_on = k > first_row
        h = times[k] - times[k - 1] if goes_on else 0.0
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
                    motion = groups.motion[e]
                    d = drives[k, motion]
                    if goes_on and jumps(d, drives[k - 1, motion], h, stride[motion]):
                        return DOUBTED, k, 0.5
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
                continue
            left = 1.0
            rate_of_left = 0.0
            if kind == RRR:
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
                middle = first + second - square
                left = 4.0 * first * second - middle * middle
                state = reach(left, 4.0 * first * second)
                if state != SOLVED:
                    return state, k, 0.0
                inverse = 1.0 / square
                along = 0.5 * (square + first - second) * inverse
                height = n[12] * 0.5 * inverse * math.sqrt(left)
                ux = along * dx - height * dy
                uy = along * dy + height * dx
                wx = ux - dx
                wy = uy - dy
                aim(turn, qk, last[at + 2], body, ux, uy, lx, ly)
                aim(turn, qk, last[3 * other + 2], other, wx, wy, mx, my)
                det = 1.0 / (uy * wx - ux * wy)
                fx = r[2] - p[2]
                fy = r[3] - p[3]
                rate_of_left = 4.0 * middle * (dx * fx + dy * fy)
                omega = (fx * wx + fy * wy) * det
                turning = (fx * ux + fy * uy) * det
                fx = r[4] - p[4] + omega * omega * ux - turning * turning * wx
                fy = r[5] - p[5] + omega * omega * uy - turning * turning * wy
                vk[at + 2] = -omega
                ak[at + 2] = -(fx * wx + fy * wy) * det
                vk[3 * other + 2] = -turning
                ak[3 * other + 2] = -(fx * ux + fy * uy) * det
                if goes_on and wound(qk, last, vk, v[k - 1], ak, a[k - 1], h, 3 * other + 2):
                    return DOUBTED, k, 0.5
                hang(qk, vk, ak, turn, body, p, n[2], n[3])
                hang(qk, vk, ak, turn, other, r, n[8], n[9])
            elif kind == RRP:
                state = solve_rrp(groups.body[e], n, qk, vk, ak, last, turn, point)
                if state != SOLVED:
                    return state, k, 0.0
                left = point[3, 0]
                rate_of_left = point[3, 1]
            elif kind == RPR:
                state = solve_rpr(groups.body[e], n, qk, vk, ak, last, tiny, turn, point)
                if state != SOLVED:
                    return state, k, 0.0
                left = point[3, 0]
                rate_of_left = point[3, 1]
            elif kind == YOKE:
                solve_yoke(groups.body[e], n, qk, vk, ak, turn, point)
                left = point[3, 0]
                rate_of_left = point[3, 1]
            elif kind == BLOCK:
                head = blocks.head[groups.motion[e]]
                state = call_block(
                    blocks.address[0], k,
                    (
                        head, blocks.tree[head[TREE_AT] :], blocks.rows[head[ROWS_AT] :], blocks.near[head[NEAR_AT] :],
                        blocks.frame[head[TREE_AT] :], blocks.arms[head[ROWS_AT] :], times, drives, q, v, a, turn,
                        start, blocks.numbers, determinant[groups.motion[e]], point, blocks.unknown, blocks.jac,
                        blocks.out, blocks.du, blocks.scratch,
                    ),
                )  # fmt: skip
                if state == DOUBTED_BEFORE:
                    return DOUBTED, k - 1, 0.5
                if state != SOLVED:
                    return state, k, 0.5
                continue
            elif kind == TRAIN:
                train = blocks.train[groups.motion[e]]
                solve_train(train, blocks.train_body, blocks.share, body, k1, n, qk, vk, ak, turn, p)
                if goes_on and n[CARRIES_ON] > 0.0 and wound(qk, last, vk, v[k - 1], ak, a[k - 1], h, at + 2):
                    return DOUBTED, k, 0.5
                continue
            else:
                bodies = groups.body[e]
                motion = groups.motion[e]
                law = drives[k, motion]
                if goes_on and motion > 0 and jumps(law, drives[k - 1, motion], h, stride[motion]):
                    return DOUBTED, k, 0.5
                if kind == SLIDE:
                    solve_slide(bodies, n, law, qk, vk, ak, turn, point)
                    continue
                if kind == PRP:
                    state = solve_prp(bodies, n, qk, vk, ak, turn, point)
                else:
                    state = solve_rod(bodies, n, law, qk, vk, ak, last, turn, point)
                if state != SOLVED:
                    return state, k, 0.0
                left = point[3, 0]
                rate_of_left = point[3, 1]
            if goes_on:
                if wound(qk, last, vk, v[k - 1], ak, a[k - 1], h, at + 2):
                    return DOUBTED, k, 0.5
                part = dip(h * before[e, 1], before[e, 0], h * rate_of_left, left)
                if part > 0.0:
                    return DOUBTED, k, part
            before[e, 0] = left
            before[e, 1] = rate_of_left
    return SOLVED, times.shape[0], 0.0
