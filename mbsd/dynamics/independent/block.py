"""One block in independent coordinates: a cam's follower, a Geneva's wheel, a triad.

    predict   u = u_0 + sum B_j (z_j - z_0j) + c tau^2 / 2          from the pose evaluated last
    correct   G du = -F,  G = J B_u                                 Newton-Raphson in the unknowns u of the block
    columns   G B_j = f'_j - J v_j                                  v_j of the block with its unknowns held
    then      G c = gamma + f'' - J a                               convective accelerations

The pose is doubted where Newton-Raphson does not converge, the prediction from the last accepted pose misses by a large
part of the way, or the determinant of G changes sign or shrinks fast since then: then the step is taken again with
another length. Equations are those of mbsd/kinematics/groups/newton/.

Tables of blocks, whose bodies Newton-Raphson places, are those of mbsd/kinematics/groups/blocks.py one after
the other, in one array of integers and one of numbers, and all their scratch is one array. ``block`` begins with where
each begins.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from mbsd.compiling.jit import inlined, lazy, merged
from mbsd.compiling.kernel_arguments import table
from mbsd.kinematics.groups.blocks import ARM, BODY, LARGEST, MOTION, SIZE, Block, Motion, Work
from mbsd.kinematics.groups.carried import BASE, COS, DOUBTED, INERTIA, MASS, OMEGA, SIN, SOLVED, SPEED, VALUE, X, Y
from mbsd.kinematics.groups.cases import angle_of, predicted
from mbsd.kinematics.groups.kinds.train import UNSURE
from mbsd.kinematics.groups.newton.block import correction, iterate
from mbsd.kinematics.groups.newton.matrix import extent, held, solve
from mbsd.kinematics.groups.newton.rows import bend_of, move, read_unknowns
from mbsd.kinematics.newton import ROUNDING, SHRINKS, SUSPICIOUS

if TYPE_CHECKING:
    from mbsd.kinematics.groups.parts import Tables


(
    HEADS, KEPT_SIZE, Q, KEPT_Q, UNKNOWN_AT, DETERMINANT_AT, SEEN_AT, V, A, TURN_AT, UNKNOWN_WORK, JAC, OUT, SOLUTION,
    POINT, SCRATCH, WORK,
) = range(17)  # fmt: skip
"""Entries of ``block``: where its heads begin, and places in the scratch. What the last accepted pose leaves is
``KEPT_SIZE`` numbers from ``KEPT_Q`` on, a copy of those from ``Q`` on: poses q (3 nb,), then for each unknown its
value, convective acceleration and columns of B, then the determinant of each block. From ``SEEN_AT`` on stand the
coordinates and the time at which each block was evaluated last."""
HEAD = 9
"""Length of a head."""
BODIES, EQUATIONS, NEAR_COUNT, TREE, ROWS, NEAR_AT, FRAME, ARMS, FIRST = range(9)
"""Entries of a head: bodies, equations, known bodies beside; where its lines begin in ``block`` and, of FRAME and ARMS,
in ``block_number``; its first unknown."""
TREE_WIDTH, ROWS_WIDTH, FRAME_WIDTH, ARMS_WIDTH = 5, 9, 7, 9


class Past(NamedTuple):
    """Memory of one block with n unknowns and C columns of B."""

    q: Any
    """(3 nb,) the last accepted pose."""
    here: Any
    """(n, C + 2) unknowns, convective accelerations and columns: of the evaluation before, then of the present one."""
    kept: Any
    """The same at the last accepted pose."""
    seen: Any
    """(C + 1,) coordinates and time at which ``here`` was evaluated."""
    determinant: Any
    """The determinant of G at the last accepted pose; 0 at the first."""


@merged
def expected(numbers, seen, coordinate, since):
    """An unknown by its value, convective acceleration and columns ``numbers`` (C + 2,) at coordinates ``seen`` (C,).

    ``since``: time since then (s).
    """
    value = numbers[0] + 0.5 * numbers[1] * since * since
    for j in range(coordinate.shape[0] - 1):
        value += numbers[2 + j] * (coordinate[j, VALUE] - seen[j])
    return value


@merged
def expected_since(numbers, coordinate):
    """The same from the last accepted pose on."""
    since = coordinate[coordinate.shape[0] - 1, VALUE]
    value = numbers[0] + 0.5 * numbers[1] * since * since
    for j in range(coordinate.shape[0] - 1):
        value += numbers[2 + j] * (coordinate[j, VALUE] - coordinate[j, BASE])
    return value


@merged
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


@merged
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


@inlined
def with_body(body, rate, gravity, i, total, push):
    """Return the sums c . M c and c . M (g - b) with those of body i: its rate is c, its convective acceleration b."""
    mass = body[i, MASS]
    inertia = body[i, INERTIA]
    cx = rate[i, 0]
    cy = rate[i, 1]
    omega = rate[i, 2]
    total += mass * (cx * cx + cy * cy) + inertia * omega * omega
    push += mass * (cx * (gravity[0] - rate[i, 3]) + cy * (gravity[1] - rate[i, 4]))
    return total, push - inertia * omega * rate[i, 5]


@merged
def take_near(near, body, base, coordinate, q, last, turn, per_metre):
    """Poses of the known bodies beside; returns how far they went since the last accepted pose, or -1 for doubt."""
    step = 0.0
    for b in near:
        theta = angle_of(body, base, coordinate, b)
        if not abs(theta - predicted(base, coordinate, b)) <= UNSURE:
            return -1.0
        q[3 * b] = body[b, X]
        q[3 * b + 1] = body[b, Y]
        q[3 * b + 2] = theta
        turn[b, 0] = body[b, COS]
        turn[b, 1] = body[b, SIN]
        step = max(step, extent(q, last, b, per_metre))
    return step


@lazy(int)
def embed_block(dyn, scratch, k):
    """Fill positions and columns of B of block k, and scratch.sums with its part alone; returns SOLVED or DOUBTED."""
    block = dyn.block
    work = scratch.block_work
    body = scratch.body
    rate = scratch.rate
    base = scratch.base
    coordinate = scratch.coordinate
    drive = scratch.drive
    nb = body.shape[0]
    columns = coordinate.shape[0] - 1
    width = columns + 2
    head = block[block[HEADS] + HEAD * k : block[HEADS] + HEAD * (k + 1)]
    count = head[BODIES]
    n = head[EQUATIONS]
    tables = Block(
        head,
        table(block, head[TREE], count, TREE_WIDTH),
        table(block, head[ROWS], n, ROWS_WIDTH),
        block[head[NEAR_AT] : head[NEAR_AT] + head[NEAR_COUNT]],
        table(dyn.block_number, head[FRAME], count, FRAME_WIDTH),
        table(dyn.block_number, head[ARMS], n, ARMS_WIDTH),
        dyn.numbers,
    )
    motion = Motion(
        work[block[Q] : block[Q] + 3 * nb],
        work[block[V] : block[V] + 3 * nb],
        work[block[A] : block[A] + 3 * nb],
        table(work, block[TURN_AT], nb, 2),
    )
    room = Work(
        table(work, block[UNKNOWN_WORK], 3, LARGEST),
        table(work, block[JAC], LARGEST, 6),
        table(work, block[OUT], LARGEST, 10),
        table(work, block[SOLUTION], 2, LARGEST),
        work[block[SCRATCH] :],
        table(work, block[POINT], 4, 8),
    )
    past = Past(
        work[block[KEPT_Q] : block[KEPT_Q] + 3 * nb],
        table(work, block[UNKNOWN_AT] + width * head[FIRST], n, width),
        table(work, block[KEPT_Q] + block[UNKNOWN_AT] + width * head[FIRST], n, width),
        work[block[SEEN_AT] + (columns + 1) * k : block[SEEN_AT] + (columns + 1) * (k + 1)],
        work[block[KEPT_Q] + block[DETERMINANT_AT] + k],
    )
    tree = tables.tree
    q = motion.q
    v = motion.v
    turn = motion.turn
    seen = past.seen
    now = coordinate[columns, VALUE] + coordinate[columns, BASE]
    step = take_near(tables.near, body, base, coordinate, q, past.q, turn, 1.0 / tables.arms[0, SIZE])
    if step < 0.0:
        return DOUBTED
    determinant = place_coupled(tables, motion, room, past, coordinate, drive, step, now)
    if determinant == 0.0:
        return DOUBTED
    move_coupled(tables, motion, room, past.here, rate, coordinate, drive)
    work[block[DETERMINANT_AT] + k] = determinant
    for j in range(columns):
        seen[j] = coordinate[j, VALUE]
    seen[columns] = now
    total = 0.0
    push = 0.0
    for e in range(count):
        b = tree[e, BODY]
        body[b, X] = q[3 * b]
        body[b, Y] = q[3 * b + 1]
        body[b, COS] = turn[b, 0]
        body[b, SIN] = turn[b, 1]
        body[b, OMEGA] = v[3 * b + 2]
        total, push = with_body(body, rate, dyn.gravity, b, total, push)
    scratch.sums[0] = total
    scratch.sums[1] = push
    return SOLVED


def block_arrays(blocks: Sequence[Tables], bodies: int, columns: int) -> tuple[np.ndarray, np.ndarray]:
    """``block`` and ``block_number`` of Embedding; ``columns``: of B."""
    unknowns = sum(len(tables.equations) for tables in blocks)
    most = max((len(tables.tree) for tables in blocks), default=0)
    kept = 3 * bodies + (columns + 2) * unknowns + len(blocks) if blocks else 0
    start = np.zeros(WORK + 1, np.int64)
    start[HEADS], start[KEPT_SIZE] = WORK + 1, kept
    start[KEPT_Q] = kept
    start[UNKNOWN_AT], start[DETERMINANT_AT] = 3 * bodies, 3 * bodies + (columns + 2) * unknowns
    sizes = [
        (columns + 1) * len(blocks),
        3 * bodies,
        3 * bodies,
        2 * bodies,
        3 * LARGEST,
        6 * LARGEST,
        10 * LARGEST,
        2 * LARGEST,
        32,
    ]
    sizes.append(LARGEST * LARGEST + 3 * LARGEST * most + 16)
    start[SEEN_AT : WORK + 1] = 2 * kept + np.cumsum([0, *sizes])
    if not blocks:
        start[WORK] = 0
    integers, numbers = [*start], list[float]()
    heads = np.zeros((len(blocks), HEAD), np.int64)
    integers += [0] * heads.size
    first = 0
    for head, tables in zip(heads, blocks, strict=True):
        near = sorted(set(tables.near) | _arms(tables))
        head[[BODIES, EQUATIONS, NEAR_COUNT, FIRST]] = len(tables.tree), len(tables.equations), len(near), first
        first += len(tables.equations)
        for entry, lines in ((TREE, tables.tree), (ROWS, tables.equations)):
            head[entry] = len(integers)
            integers += [value for line in lines for value in line]
        head[NEAR_AT] = len(integers)
        integers += near
        for entry, lines in ((FRAME, tables.frame), (ARMS, tables.arms)):
            head[entry] = len(numbers)
            numbers += [value for line in lines for value in line]
    block = np.array(integers, np.int64)
    block[WORK + 1 : WORK + 1 + heads.size] = heads.ravel()
    return block, np.array(numbers, float)


def block_work(block: np.ndarray, q: np.ndarray) -> np.ndarray:
    """The scratch of one run that begins at q (3 nb,)."""
    work = np.zeros(int(block[WORK]))
    if block[KEPT_SIZE]:
        work[block[KEPT_Q] : block[KEPT_Q] + len(q)] = q
        work[block[TURN_AT]] = 1.0
    return work


def _arms(tables: Tables) -> set[int]:
    """Known bodies whose turns an equation counts."""
    return {line[ARM] for line in tables.equations} - {line[0] for line in tables.tree} - {0}
