"""The guard of a block's branch: whether a step is doubted."""

from __future__ import annotations

from mbsd.kinematics.groups.blocks import BODIES, BODY, DOUBTED_BEFORE, NEAR
from mbsd.kinematics.groups.carrying.rates import DOUBTED, SOLVED
from mbsd.kinematics.groups.newton.fused import fused
from mbsd.kinematics.groups.newton.matrix import extent, turns_too_far
from mbsd.kinematics.newton import CONTRACTS, SUSPICIOUS, heads_for_zero


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
