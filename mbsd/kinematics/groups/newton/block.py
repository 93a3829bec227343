"""One block of a plan at one time by Newton-Raphson in its few unknowns, with the branch guard of newton.py.

    predict   poses from the quintic through the last two
    correct   G du = -F,  G = J B;  B the rates of the bodies for unit rates of the unknowns
    then      G u' = f' - J v,   G u'' = gamma + f'' - J a      v, a of the block with its unknowns held

It is reached by its machine address, and compiled when a plan with blocks is first solved.
"""

from __future__ import annotations

from numba import carray

from mbsd.compiling.jit import COMPILED, at_address
from mbsd.kinematics.groups.blocks import (
    BODIES,
    BODY,
    EQUATIONS,
    HANGS,
    LARGEST,
    LAWS,
    MOTION,
    MOVING,
    NEAR,
    PIN,
    SIZE,
    STRIDE,
)
from mbsd.kinematics.groups.carrying.rates import DOUBTED, MEETING, SOLVED
from mbsd.kinematics.groups.newton.call import PYTHON, SIGNATURE
from mbsd.kinematics.groups.newton.fused import fused
from mbsd.kinematics.groups.newton.iteration import iterate
from mbsd.kinematics.groups.newton.matrix import held, solve
from mbsd.kinematics.groups.newton.pinned import extrapolated, in_doubt, solve_pinned
from mbsd.kinematics.groups.newton.rows import begin, bend_of, move
from mbsd.kinematics.law_step import jumps
from mbsd.kinematics.newton import ROUNDING

LONG = 1 << 40
"""For arrays whose length does not matter."""


@fused
def predict(tree, count, times, k, q, v, a, start):
    """Fill row k of q for the block's bodies."""
    if k == 0:
        for e in range(count):
            for c in range(3 * tree[e, BODY], 3 * tree[e, BODY] + 3):
                q[0, c] = start[c]
        return
    for e in range(count):
        for c in range(3 * tree[e, BODY], 3 * tree[e, BODY] + 3):
            q[k, c] = extrapolated(times, k, q, v, a, c)


@fused
def solve_arrays(
    k, head, tree, rows, near, frame, arms, times, drives, q, v, a, turn, start, numbers, determinant, point,
    unknown, jac, out, du, scratch,
):  # fmt: skip
    """Fill row k of q, v, a (T, 3 nb) for the bodies of one block; returns SOLVED, or why not."""
    count = head[BODIES]
    n = head[EQUATIONS]
    per_metre = 1.0 / arms[0, SIZE]
    qk = q[k]
    vk = v[k]
    ak = a[k]
    drive = drives[k]
    h = times[k] - times[k - 1] if k > 0 else 0.0
    for r in range(n):
        motion = rows[r, MOTION]
        if k > 0 and motion > 0 and jumps(drive[motion], drives[k - 1, motion], h, arms[r, STRIDE]):
            return DOUBTED
    predict(tree, count, times, k, q, v, a, start)
    begin(tree, frame, count, qk, turn, unknown[0])
    for c in range(n):
        unknown[1, c] = 0.0
        unknown[2, c] = 0.0
    determinant[k, 0], change, first, second = iterate(
        True, head, tree, rows, frame, arms, drive, qk, vk, ak, turn, numbers, jac, out, scratch, unknown, du, point
    )  # fmt: skip
    if determinant[k, 0] == 0.0:
        return MEETING
    if not change <= ROUNDING:
        return DOUBTED
    for r in range(n):
        unknown[1, r] = drive[rows[r, MOTION], 1] - held(jac[r], rows[r], vk)
    solve(scratch, du[1], n, unknown[1])
    move(tree, frame, count, unknown, False, qk, vk, ak, turn, point)
    for r in range(n):
        bend = bend_of(rows[r], arms[r], qk, vk, turn, out[r])
        unknown[2, r] = bend + drive[rows[r, MOTION], 2] - held(jac[r], rows[r], ak)
    solve(scratch, du[1], n, unknown[2])
    move(tree, frame, count, unknown, True, qk, vk, ak, turn, point)
    return in_doubt(head, tree, near, times, q, v, a, determinant, k, h, per_metre, first, second) if k > 0 else SOLVED


def _at_address(
    k, head, tree, rows, near, frame, arms, times, drives, q, v, a, turn, start, numbers, determinant, point,
    unknown, jac, out, du, scratch,
):  # fmt: skip
    """The same with pointers."""
    sizes = carray(head, (MOVING + 1,))
    count = sizes[BODIES]
    n = sizes[EQUATIONS]
    bodies = sizes[MOVING]
    rows_known = k + 1
    tree_of = carray(tree, (count, 5))
    rows_of = carray(rows, (n, 9))
    near_of = carray(near, (sizes[NEAR],))
    frame_of = carray(frame, (count, 7))
    arms_of = carray(arms, (n, 9))
    at = carray(times, (rows_known,))
    laws = carray(drives, (rows_known, sizes[LAWS], 3))
    qs = carray(q, (rows_known, 3 * bodies))
    vs = carray(v, (rows_known, 3 * bodies))
    bends = carray(a, (rows_known, 3 * bodies))
    turned = carray(turn, (bodies, 2))
    before = carray(start, (3 * bodies,))
    all_numbers = carray(numbers, (LONG,))
    determinants = carray(determinant, (rows_known, 1))
    points = carray(point, (4, 8))
    jacobian = carray(jac, (LARGEST, 6))
    values = carray(out, (LARGEST, 10))
    work = carray(scratch, (LONG,))
    return solve_any(
        k, sizes, tree_of, rows_of, near_of, frame_of, arms_of, at, laws, qs, vs, bends, turned, before, all_numbers,
        determinants, points, carray(unknown, (3, LARGEST)), jacobian, values, carray(du, (2, LARGEST)), work,
    )  # fmt: skip


@fused
def solve_any(
    k, head, tree, rows, near, frame, arms, times, drives, q, v, a, turn, start, numbers, determinant, point,
    unknown, jac, out, du, scratch,
):  # fmt: skip
    """Fill row k of q, v, a (T, 3 nb) for the bodies of one block; returns SOLVED, or why not."""
    if head[EQUATIONS] == 1 and head[BODIES] == 1 and tree[0, HANGS] == PIN:
        return solve_pinned(
            k, head, tree, rows, near, frame, arms, times, drives, q, v, a, turn, start, numbers, determinant, point,
            jac, out, scratch,
        )  # fmt: skip
    return solve_arrays(
        k, head, tree, rows, near, frame, arms, times, drives, q, v, a, turn, start, numbers, determinant, point,
        unknown, jac, out, du, scratch,
    )  # fmt: skip


if COMPILED:
    ADDRESS = at_address(SIGNATURE)(_at_address).address
else:
    PYTHON[:] = [solve_any]
    ADDRESS = 0
