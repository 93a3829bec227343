"""A block of several bodies or unknowns in independent coordinates; its steps are those of block.py."""

from __future__ import annotations

from mbsd.dynamics.embedding.blocks.places import BODIES, EQUATIONS
from mbsd.dynamics.embedding.blocks.prediction import expected, expected_since
from mbsd.kinematics.groups.blocks import BODY, MOTION, SIZE
from mbsd.kinematics.groups.carrying.columns import SPEED
from mbsd.kinematics.groups.newton.fused import fused
from mbsd.kinematics.groups.newton.iteration import correction, iterate
from mbsd.kinematics.groups.newton.matrix import extent, held, solve
from mbsd.kinematics.groups.newton.rows import begin, bend_of, move
from mbsd.kinematics.newton import ROUNDING, SHRINKS, SUSPICIOUS


@fused
def place_coupled(
    head, tree, rows, frame, arms, q, last, v, a, turn, numbers, jac, out, scratch, unknown, solution, point,
    here, kept, seen, coordinate, drive, before, step, now,
):  # fmt: skip
    """Place the bodies; ``scratch`` takes the factors of G. Returns its determinant, or 0 where the pose is doubted.

    ``before``: determinant at the last accepted pose, 0 at the first; ``step``: how far the bodies beside went since.
    """
    count = head[BODIES]
    n = head[EQUATIONS]
    per_metre = 1.0 / arms[0, SIZE]
    since = now - seen[coordinate.shape[0] - 1]
    if before == 0.0:
        begin(tree, frame, count, last, turn, unknown[0])
    for c in range(n):
        unknown[1, c] = 0.0
        unknown[2, c] = 0.0
    for attempt in range(2):
        for c in range(n if before != 0.0 else 0):
            if attempt == 0:
                unknown[0, c] = expected(here[c], seen, coordinate, since)
            else:
                unknown[0, c] = expected_since(kept[c], coordinate)
        determinant, change, _, _ = iterate(
            False, head, tree, rows, frame, arms, drive, q, v, a, turn, numbers, jac, out, scratch, unknown, solution,
            point,
        )  # fmt: skip
        if determinant != 0.0 and change <= ROUNDING:
            move(tree, frame, count, unknown, False, q, v, a, turn, point)
            if before == 0.0:
                return determinant
            way = step
            for e in range(count):
                way = max(way, extent(q, last, tree[e, BODY], per_metre))
            for c in range(n):
                solution[0, c] = unknown[0, c] - expected_since(kept[c], coordinate)
            missed = correction(head, tree, solution[0], per_metre)
            if determinant / before > SHRINKS and missed <= SUSPICIOUS * way + 1e-9:
                return determinant
        if before == 0.0:
            break
    return 0.0


@fused
def move_coupled(
    head, tree, rows, near, frame, arms, q, v, a, turn, jac, out, scratch, unknown, solution, point, here, rate,
    coordinate, drive,
):  # fmt: skip
    """Columns of B and convective accelerations of the bodies that ``place_coupled`` has placed."""
    columns = coordinate.shape[0] - 1
    count = head[BODIES]
    n = head[EQUATIONS]
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
        move(tree, frame, count, unknown, True, q, v, a, turn, point)
        for r in range(n):
            unknown[1, r] = (drive[rows[r, MOTION], 1] if of_time else 0.0) - held(jac[r], rows[r], v)
        solve(scratch, solution[1], n, unknown[1])
        move(tree, frame, count, unknown, True, q, v, a, turn, point)
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
    move(tree, frame, count, unknown, True, q, v, a, turn, point)
    for r in range(n):
        bend = bend_of(rows[r], arms[r], q, v, turn, out[r])
        unknown[2, r] = bend + drive[rows[r, MOTION], 2] - held(jac[r], rows[r], a)
    solve(scratch, solution[1], n, unknown[2])
    move(tree, frame, count, unknown, True, q, v, a, turn, point)
    for c in range(n):
        here[c, 0] = unknown[0, c]
        here[c, 1] = unknown[2, c]
    for e in range(count):
        b = tree[e, BODY]
        for c in range(3):
            rate[b, 3 * columns + c] = a[3 * b + c]
