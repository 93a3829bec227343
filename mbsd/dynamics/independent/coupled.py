"""A block of several bodies or unknowns in independent coordinates; its steps are those of block.py."""

from __future__ import annotations

from mbsd.dynamics.independent.places import BODIES, EQUATIONS
from mbsd.dynamics.independent.prediction import expected, expected_since
from mbsd.kinematics.groups.blocks import BODY, MOTION, SIZE
from mbsd.kinematics.groups.carrying.columns import SPEED
from mbsd.kinematics.groups.newton.fused import fused
from mbsd.kinematics.groups.newton.iteration import correction, iterate
from mbsd.kinematics.groups.newton.matrix import extent, held, solve
from mbsd.kinematics.groups.newton.rows import bend_of, move, read_unknowns
from mbsd.kinematics.newton import ROUNDING, SHRINKS, SUSPICIOUS


@fused
def place_coupled(block, motion, work, past, coordinate, drive, step, now):
    """Place the bodies; ``work`` takes the factors of G. Returns its determinant, or 0 where the pose is doubted.

    ``step``: how far the bodies beside went since the last accepted pose.
    """
    n = block.head[EQUATIONS]
    unknown = work.unknown
    per_metre = 1.0 / block.arms[0, SIZE]
    since = now - past.seen[coordinate.shape[0] - 1]
    if past.determinant == 0.0:
        read_unknowns(block, past.q, motion.turn, unknown[0])
    for c in range(n):
        unknown[1, c] = 0.0
        unknown[2, c] = 0.0
    for attempt in range(2):
        for c in range(n if past.determinant != 0.0 else 0):
            if attempt == 0:
                unknown[0, c] = expected(past.here[c], past.seen, coordinate, since)
            else:
                unknown[0, c] = expected_since(past.kept[c], coordinate)
        determinant, change, _, _ = iterate(False, block, drive, motion, work)
        if determinant != 0.0 and change <= ROUNDING:
            move(block, unknown, False, motion, work.point)
            if past.determinant == 0.0:
                return determinant
            way = step
            for e in range(block.head[BODIES]):
                way = max(way, extent(motion.q, past.q, block.tree[e, BODY], per_metre))
            for c in range(n):
                work.solution[0, c] = unknown[0, c] - expected_since(past.kept[c], coordinate)
            missed = correction(block, work.solution[0], per_metre)
            if determinant / past.determinant > SHRINKS and missed <= SUSPICIOUS * way + 1e-9:
                return determinant
        if past.determinant == 0.0:
            break
    return 0.0


@fused
def move_coupled(block, motion, work, here, rate, coordinate, drive):
    """Columns of B and convective accelerations of the bodies that ``place_coupled`` has placed."""
    columns = coordinate.shape[0] - 1
    tree = block.tree
    rows = block.rows
    near = block.near
    count = block.head[BODIES]
    n = block.head[EQUATIONS]
    v = motion.v
    a = motion.a
    jac = work.jac
    unknown = work.unknown
    for b in near:
        for c in range(3 * b, 3 * b + 3):
            a[c] = 0.0
    for j in range(columns):
        of_time = drive.shape[0] > 1 and j == columns - 1
        for b in near:
            for c in range(3):
                v[3 * b + c] = rate[b, 3 * j + c]
        for c in range(n):
            unknown[1, c] = 0.0
        move(block, unknown, True, motion, work.point)
        for r in range(n):
            unknown[1, r] = (drive[rows[r, MOTION], 1] if of_time else 0.0) - held(jac[r], rows[r], v)
        solve(work.matrix, work.solution[1], n, unknown[1])
        move(block, unknown, True, motion, work.point)
        for e in range(count):
            b = tree[e, BODY]
            for c in range(3):
                rate[b, 3 * j + c] = v[3 * b + c]
        for c in range(n):
            here[c, 2 + j] = unknown[1, c]
    for b in near:
        for c in range(3):
            v[3 * b + c] = 0.0
            for j in range(columns):
                v[3 * b + c] += rate[b, 3 * j + c] * coordinate[j, SPEED]
            a[3 * b + c] = rate[b, 3 * columns + c]
    for c in range(n):
        unknown[1, c] = 0.0
        for j in range(columns):
            unknown[1, c] += here[c, 2 + j] * coordinate[j, SPEED]
    move(block, unknown, True, motion, work.point)
    for r in range(n):
        bend = bend_of(rows[r], block.arms[r], motion.q, v, motion.turn, work.out[r])
        unknown[2, r] = bend + drive[rows[r, MOTION], 2] - held(jac[r], rows[r], a)
    solve(work.matrix, work.solution[1], n, unknown[2])
    move(block, unknown, True, motion, work.point)
    for c in range(n):
        here[c, 0] = unknown[0, c]
        here[c, 1] = unknown[2, c]
    for e in range(count):
        b = tree[e, BODY]
        for c in range(3):
            rate[b, 3 * columns + c] = a[3 * b + c]
