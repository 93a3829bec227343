"""One block in independent coordinates: a cam's follower, a Geneva's wheel, a triad.

    predict   u = u_0 + sum B_j (z_j - z_0j) + c tau^2 / 2          from the pose evaluated last
    correct   G du = -F,  G = J B_u                                 Newton-Raphson in the unknowns u of the block
    columns   G B_j = f'_j - J v_j                                  v_j of the block with its unknowns held
    then      G c = gamma + f'' - J a                               convective accelerations

The pose is doubted where Newton-Raphson does not converge, the prediction from the last accepted pose misses by a large
part of the way, or the determinant of G changes sign or shrinks fast since then: then the step is taken again with
another length. Equations are those of mbsd/kinematics/groups/newton/.
"""

from __future__ import annotations

from mbsd.compiling.jit import lazy
from mbsd.compiling.views import table
from mbsd.dynamics.independent.coupled import move_coupled, place_coupled
from mbsd.dynamics.independent.past import Past
from mbsd.dynamics.independent.places import (
    ARMS,
    ARMS_WIDTH,
    BODIES,
    DETERMINANT_AT,
    EQUATIONS,
    FIRST,
    FRAME,
    FRAME_WIDTH,
    HEAD,
    HEADS,
    JAC,
    KEPT_Q,
    NEAR,
    NEAR_AT,
    OUT,
    POINT,
    ROWS,
    ROWS_WIDTH,
    SCRATCH,
    SEEN_AT,
    SOLUTION,
    TREE,
    TREE_WIDTH,
    TURN_AT,
    UNKNOWN_AT,
    UNKNOWN_WORK,
    A,
    Q,
    V,
)
from mbsd.kinematics.groups.blocks import BODY, LARGEST, SIZE
from mbsd.kinematics.groups.carrying.branch import angle_of, predicted
from mbsd.kinematics.groups.carrying.columns import BASE, COS, INERTIA, MASS, OMEGA, SIN, VALUE, X, Y
from mbsd.kinematics.groups.carrying.rates import DOUBTED, SOLVED
from mbsd.kinematics.groups.kinds.train import UNSURE
from mbsd.kinematics.groups.newton.fused import fused
from mbsd.kinematics.groups.newton.matrix import extent
from mbsd.kinematics.groups.newton.records import Block, Motion, Work


@fused
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
def embed_block(k, block, block_number, numbers, work, body, rate, base, coordinate, drive, gravity, sums):
    """Positions and columns of B of block k; sums (2,) takes what its bodies add to those of EmbeddingScratch."""
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
        block[head[NEAR_AT] : head[NEAR_AT] + head[NEAR]],
        table(block_number, head[FRAME], count, FRAME_WIDTH),
        table(block_number, head[ARMS], n, ARMS_WIDTH),
        numbers,
    )
    motion = Motion(
        work[block[Q] : block[Q] + 3 * nb],
        work[block[V] : block[V] + 3 * nb],
        work[block[A] : block[A] + 3 * nb],
        table(work, block[TURN_AT], nb, 2),
    )
    scratch = Work(
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
    determinant = place_coupled(tables, motion, scratch, past, coordinate, drive, step, now)
    if determinant == 0.0:
        return DOUBTED
    move_coupled(tables, motion, scratch, past.here, rate, coordinate, drive)
    work[block[DETERMINANT_AT] + k] = determinant
    for j in range(columns):
        seen[j] = coordinate[j, VALUE]
    seen[columns] = now
    total = 0.0
    push = 0.0
    last_column = 3 * columns
    for e in range(count):
        b = tree[e, BODY]
        body[b, X] = q[3 * b]
        body[b, Y] = q[3 * b + 1]
        body[b, COS] = turn[b, 0]
        body[b, SIN] = turn[b, 1]
        body[b, OMEGA] = v[3 * b + 2]
        mass = body[b, MASS]
        inertia = body[b, INERTIA]
        cx = rate[b, 0]
        cy = rate[b, 1]
        omega = rate[b, 2]
        total += mass * (cx * cx + cy * cy) + inertia * omega * omega
        push += mass * (cx * (gravity[0] - rate[b, last_column]) + cy * (gravity[1] - rate[b, last_column + 1]))
        push -= inertia * omega * rate[b, last_column + 2]
    sums[0] = total
    sums[1] = push
    return SOLVED
