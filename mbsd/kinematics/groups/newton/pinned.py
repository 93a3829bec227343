"""A block of one pinned body, whose angle is the only unknown; and the prediction and branch guard of all blocks."""

from __future__ import annotations

import math

from mbsd.kinematics.groups.blocks import (
    BODIES,
    BODY,
    BODY_J,
    DOUBTED_BEFORE,
    MOTION,
    NEAR,
    PARENT,
    SIZE,
    STRIDE,
)
from mbsd.kinematics.groups.carrying.rates import DOUBTED, MEETING, SOLVED, carried, hang
from mbsd.kinematics.groups.newton.fused import fused
from mbsd.kinematics.groups.newton.matrix import extent, held, turns_too_far
from mbsd.kinematics.groups.newton.rows import bend_of, evaluate_row
from mbsd.kinematics.law_step import jumps
from mbsd.kinematics.newton import CONTRACTS, MAX_ITERATIONS, ROUNDING, SUSPICIOUS, TOLERANCE, heads_for_zero
from mbsd.kinematics.predictor import quintic_factors


@fused
def extrapolated(times, k, q, v, a, c):
    """Coordinate c at row k."""
    from_q, from_v, from_a, earlier_v, earlier_a = quintic_factors(times, k, times[k])
    last = k - 1
    before = max(k - 2, 0)
    return (
        q[last, c]
        + from_q * (q[before, c] - q[last, c])
        + from_v * v[last, c]
        + earlier_v * v[before, c]
        + from_a * a[last, c]
        + earlier_a * a[before, c]
    )


@fused
def solve_pinned(k, block, history, work):
    """As solve_arrays for a block of one pinned body, whose angle is the only unknown."""
    tree = block.tree
    arms = block.arms
    times = history.times
    drives = history.drives
    turn = history.turn
    jac = work.jac
    out = work.out
    body = tree[0, BODY]
    b = 3 * body
    n = block.frame[0]
    row = block.rows[0]
    per_metre = 1.0 / arms[0, SIZE]
    motion = row[MOTION]
    qk = history.q[k]
    vk = history.v[k]
    ak = history.a[k]
    h = 0.0
    theta = history.start[b + 2]
    if k > 0:
        h = times[k] - times[k - 1]
        if motion > 0 and jumps(drives[k, motion], drives[k - 1, motion], h, arms[0, STRIDE]):
            return DOUBTED
        theta = extrapolated(times, k, history.q, history.v, history.a, b + 2)
    own = 3 if row[BODY_J] == body else 0
    p = work.point[0]
    carried(qk, vk, ak, turn, tree[0, PARENT], n[0], n[1], p)
    first = 0.0
    second = 0.0
    last = math.inf
    change = math.inf
    slope = 0.0
    correction = 0.0
    for iteration in range(MAX_ITERATIONS):
        turn[body, 0] = math.cos(theta)
        turn[body, 1] = math.sin(theta)
        sx = turn[body, 0] * n[5] - turn[body, 1] * n[6]
        sy = turn[body, 1] * n[5] + turn[body, 0] * n[6]
        qk[b] = p[0] - sx
        qk[b + 1] = p[1] - sy
        qk[b + 2] = theta
        value = evaluate_row(row, arms[0], qk, turn, block.numbers, work.matrix, out[0], jac[0])
        slope = jac[0, own] * sy - jac[0, own + 1] * sx + jac[0, own + 2]
        if slope == 0.0:
            return MEETING
        correction = (drives[k, motion, 0] - value) / slope
        theta += correction
        change = abs(correction)
        if iteration == 0:
            first = change
        elif iteration == 1:
            second = change
        if change <= TOLERANCE:
            break
        if iteration > 0 and not change < 0.5 * last:
            break
        last = change
    if not change <= ROUNDING:
        return DOUBTED
    history.determinant[k, 0] = slope
    qk[b + 2] = theta
    cosine = turn[body, 0]
    turn[body, 0] -= turn[body, 1] * correction  # a correction of 1e-9 is exact this way
    turn[body, 1] += cosine * correction
    vk[b] = p[2]
    vk[b + 1] = p[3]
    vk[b + 2] = 0.0
    vk[b + 2] = (drives[k, motion, 1] - held(jac[0], row, vk)) / slope
    ak[b + 2] = 0.0
    hang(qk, vk, ak, turn, body, p, n[5], n[6])
    bend = bend_of(row, arms[0], qk, vk, turn, out[0])
    ak[b + 2] = (bend + drives[k, motion, 2] - held(jac[0], row, ak)) / slope
    hang(qk, vk, ak, turn, body, p, n[5], n[6])
    return in_doubt(k, block, history, h, per_metre, first, second) if k > 0 else SOLVED


@fused
def in_doubt(k, block, history, h, per_metre, first, second):
    """The branch guard after row k: SOLVED, or in which step a pose is needed."""
    q = history.q
    step = 0.0
    for e in range(block.head[BODIES]):
        step = max(step, extent(q[k], q[k - 1], block.tree[e, BODY], per_metre))
    for e in range(block.head[NEAR]):
        step = max(step, extent(q[k], q[k - 1], block.near[e], per_metre))
    if first > SUSPICIOUS * step + 1e-9 or second > CONTRACTS * first + 1e-9:
        return DOUBTED
    refused = heads_for_zero(history.determinant, history.times, k, 0)
    if refused > 0:
        return DOUBTED if refused == k else DOUBTED_BEFORE
    return DOUBTED if turns_too_far(block.head, block.tree, q, history.v, history.a, k, h, per_metre) else SOLVED
