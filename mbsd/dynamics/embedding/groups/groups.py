"""Positions, rates for each column, and convective accelerations of all groups, one after the other.

The equations are those of mbsd/kinematics/groups/solve.py and slides.py; here the rates are solved for each column of
B, and once more for the convective accelerations, whose right-hand sides have the terms in omega^2 besides.

    RRR   omega_A u_perp - omega_B w_perp = Q' - P'  (+ omega_A^2 u - omega_B^2 w),   u x w = s |C - P| |C - Q|
"""

from __future__ import annotations

import math

from mbsd.compiling.jit import inlined
from mbsd.dynamics.embedding.arrays import (
    AVOID,
    COORDINATE,
    COS,
    FIRST,
    INERTIA,
    K1,
    K2,
    KIND,
    LAW,
    MASS,
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
from mbsd.dynamics.embedding.groups.branch import DOUBTED, SOLVED, doubted, predicted
from mbsd.dynamics.embedding.groups.lengths import solve_rod, solve_slide
from mbsd.dynamics.embedding.groups.one_slide import solve_rpr, solve_rrp
from mbsd.dynamics.embedding.groups.two_slides import solve_prp, solve_yoke
from mbsd.kinematics.groups.groups import PRP, ROD, RPR, RRP, RRR, WELDED, YOKE


@inlined
def solve_groups(group, number, body, rate, base, coordinate, drive, gravity, sums):
    """Fill ``body`` and ``rate`` from coordinate and drive; returns SOLVED, or DOUBTED where a group's pose is unclear.

    With a single coordinate its inertia and M (g - c) are summed on the way, while numbers are at hand.
    """
    single = rate.shape[1] == 6
    total = 0.0
    push = 0.0
    columns = coordinate.shape[0] - 1
    for e in range(group.shape[0]):
        kind = group[e, KIND]
        a = group[e, FIRST]
        k1 = group[e, K1]
        k2 = group[e, K2]
        n = number[e]
        c = body[k1, COS]
        s = body[k1, SIN]
        px = c * n[0] - s * n[1]
        py = s * n[0] + c * n[1]
        if kind == RRR:
            b = group[e, SECOND]
            c = body[k2, COS]
            s = body[k2, SIN]
            qx = c * n[6] - s * n[7]
            qy = s * n[6] + c * n[7]
            cx = body[k1, X] + px
            cy = body[k1, Y] + py
            ex = body[k2, X] + qx
            ey = body[k2, Y] + qy
            dx = ex - cx
            dy = ey - cy
            square = dx * dx + dy * dy
            half = 0.5 * (square + n[13])
            cross = n[12] * square - half * half
            n[SINE] = cross * n[14]
            if not n[SINE] > n[AVOID]:
                return DOUBTED
            inverse = 1.0 / square
            cross = math.sqrt(cross)
            if n[NEAR] > 0.0:
                theta = predicted(base, coordinate, a)
                c = math.cos(theta)
                s = math.sin(theta)
                side = n[12] * ((s * n[4] + c * n[5]) * dx - (c * n[4] - s * n[5]) * dy)
                if doubted(side, cross):
                    return DOUBTED
                n[SIGN] = 1.0 if side > 0.0 else -1.0
            cross *= n[SIGN]
            det = 1.0 / cross
            along = half * inverse
            cross *= inverse
            ux = along * dx - cross * dy
            uy = along * dy + cross * dx
            wx = ux - dx
            wy = uy - dy
            c = ux * n[4] + uy * n[5]
            s = uy * n[4] - ux * n[5]
            body[a, COS] = c
            body[a, SIN] = s
            ax = c * n[2] - s * n[3]
            ay = s * n[2] + c * n[3]
            body[a, X] = cx - ax
            body[a, Y] = cy - ay
            c = wx * n[10] + wy * n[11]
            s = wy * n[10] - wx * n[11]
            body[b, COS] = c
            body[b, SIN] = s
            bx = c * n[8] - s * n[9]
            by = s * n[8] + c * n[9]
            body[b, X] = ex - bx
            body[b, Y] = ey - by
            turning_a = 0.0
            turning_b = 0.0
            for j in range(columns):
                at = 3 * j
                omega = rate[k1, at + 2]
                cx = rate[k1, at] - omega * py
                cy = rate[k1, at + 1] + omega * px
                omega = rate[k2, at + 2]
                ex = rate[k2, at] - omega * qy
                ey = rate[k2, at + 1] + omega * qx
                fx = ex - cx
                fy = ey - cy
                omega = (fx * wx + fy * wy) * det
                turning_a += omega * coordinate[j, SPEED]
                rate[a, at] = cx + omega * ay
                rate[a, at + 1] = cy - omega * ax
                rate[a, at + 2] = omega
                omega = (fx * ux + fy * uy) * det
                turning_b += omega * coordinate[j, SPEED]
                rate[b, at] = ex + omega * by
                rate[b, at + 1] = ey - omega * bx
                rate[b, at + 2] = omega
            body[a, OMEGA] = turning_a
            body[b, OMEGA] = turning_b
            turning_a *= turning_a
            turning_b *= turning_b
            at = 3 * columns
            omega = rate[k1, at + 2]
            square = body[k1, OMEGA] * body[k1, OMEGA]
            cx = rate[k1, at] - omega * py - square * px
            cy = rate[k1, at + 1] + omega * px - square * py
            omega = rate[k2, at + 2]
            square = body[k2, OMEGA] * body[k2, OMEGA]
            ex = rate[k2, at] - omega * qy - square * qx
            ey = rate[k2, at + 1] + omega * qx - square * qy
            fx = ex - cx + turning_a * ux - turning_b * wx
            fy = ey - cy + turning_a * uy - turning_b * wy
            omega = (fx * wx + fy * wy) * det
            rate[a, at] = cx + omega * ay + turning_a * ax
            rate[a, at + 1] = cy - omega * ax + turning_a * ay
            rate[a, at + 2] = omega
            omega = (fx * ux + fy * uy) * det
            rate[b, at] = ex + omega * by + turning_b * bx
            rate[b, at + 1] = ey - omega * bx + turning_b * by
            rate[b, at + 2] = omega
        elif kind <= WELDED:  # or DRIVEN
            law = group[e, LAW]
            column = group[e, COORDINATE]
            if kind == WELDED:
                qx = n[4]
                qy = n[5]
            else:
                angle = n[5] * (n[4] + (coordinate[column, VALUE] if column >= 0 else drive[law, 0]))
                qx = math.cos(angle)
                qy = math.sin(angle)
            dx = body[k2, COS]
            dy = body[k2, SIN]
            c = dx * qx - dy * qy
            s = dy * qx + dx * qy
            body[a, COS] = c
            body[a, SIN] = s
            ax = c * n[2] - s * n[3]
            ay = s * n[2] + c * n[3]
            body[a, X] = body[k1, X] + px - ax
            body[a, Y] = body[k1, Y] + py - ay
            turning_a = 0.0
            for j in range(columns):
                at = 3 * j
                omega = rate[k1, at + 2]
                cx = rate[k1, at] - omega * py
                cy = rate[k1, at + 1] + omega * px
                omega = rate[k2, at + 2]
                if j == column:
                    omega += n[5]
                elif j == columns - 1 and law > 0:
                    omega += n[5] * drive[law, 1]
                turning_a += omega * coordinate[j, SPEED]
                rate[a, at] = cx + omega * ay
                rate[a, at + 1] = cy - omega * ax
                rate[a, at + 2] = omega
            body[a, OMEGA] = turning_a
            turning_a *= turning_a
            at = 3 * columns
            omega = rate[k1, at + 2]
            square = body[k1, OMEGA] * body[k1, OMEGA]
            cx = rate[k1, at] - omega * py - square * px
            cy = rate[k1, at + 1] + omega * px - square * py
            omega = rate[k2, at + 2]
            if law > 0:
                omega += n[5] * drive[law, 2]
            rate[a, at] = cx + omega * ay + turning_a * ax
            rate[a, at + 1] = cy - omega * ax + turning_a * ay
            rate[a, at + 2] = omega
        else:
            bodies = group[e]
            if kind == RRP:
                status = solve_rrp(bodies, n, body, rate, base, coordinate)
            elif kind == RPR:
                status = solve_rpr(bodies, n, body, rate, base, coordinate)
            elif kind == YOKE:
                status = solve_yoke(bodies, n, body, rate, coordinate)
            elif kind == PRP:
                status = solve_prp(bodies, n, body, rate, coordinate)
            elif kind == ROD:
                status = solve_rod(bodies, n, body, rate, base, coordinate, drive)
            else:
                status = solve_slide(bodies, n, body, rate, coordinate, drive)
            if status != SOLVED:
                return status
        if single:
            mass = body[a, MASS]
            inertia = body[a, INERTIA]
            cx = rate[a, 0]
            cy = rate[a, 1]
            omega = rate[a, 2]
            total += mass * (cx * cx + cy * cy) + inertia * omega * omega
            push += mass * (cx * (gravity[0] - rate[a, 3]) + cy * (gravity[1] - rate[a, 4]))
            push -= inertia * omega * rate[a, 5]
            b = group[e, SECOND]
            if b >= 0:
                mass = body[b, MASS]
                inertia = body[b, INERTIA]
                cx = rate[b, 0]
                cy = rate[b, 1]
                omega = rate[b, 2]
                total += mass * (cx * cx + cy * cy) + inertia * omega * omega
                push += mass * (cx * (gravity[0] - rate[b, 3]) + cy * (gravity[1] - rate[b, 4]))
                push -= inertia * omega * rate[b, 5]
    sums[0] = total
    sums[1] = push
    return SOLVED
