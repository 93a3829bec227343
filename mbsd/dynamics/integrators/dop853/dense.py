"""The dense output of DOP853: its polynomial of order 7, and the outputs within a step."""

from __future__ import annotations

from mbsd.compiling.jit import apart, internal, lazy
from mbsd.dynamics.formulation import derivative, join_rows, keep_row, record, record_all
from mbsd.dynamics.integrators.dop853.tableau import A, C, D
from mbsd.dynamics.state import NEXT, TIME, WORK

BESIDE = 1e-3
"""Part of a step by which poses beside an unclear one are looked for, doubled until both are clear."""


@apart
def interpolant(dyn, scratch, state, h, work):
    """Find coefficients of the dense output of the step that ends in scratch.state and does ``work`` (J)."""
    power = scratch.power
    k = scratch.stages
    dense = scratch.dense
    n3 = state.y.shape[1]
    t = state.clock[TIME]
    for part in range(2):
        for c in range(3, n3):
            rise = scratch.state[part, c] - state.y[part, c]
            dense[0, part, c] = rise
            dense[1, part, c] = h * k[0, part, c] - rise
            dense[2, part, c] = 2.0 * rise - h * (k[12, part, c] + k[0, part, c])
    for s in range(13, 16):
        for part in range(2):
            for c in range(3, n3):
                change = 0.0
                for j in range(s):
                    change += A[s, j] * k[j, part, c]
                dense[7, part, c] = state.y[part, c] + h * change
        power[s] = derivative(dyn, scratch, t + C[s] * h, dense[7], k[s], scratch.multipliers)
    for part in range(2):
        for c in range(3, n3):
            fourth = 0.0
            fifth = 0.0
            sixth = 0.0
            seventh = 0.0
            for j in range(16):
                rate = k[j, part, c]
                fourth += D[0, j] * rate
                fifth += D[1, j] * rate
                sixth += D[2, j] * rate
                seventh += D[3, j] * rate
            dense[3, part, c] = h * fourth
            dense[4, part, c] = h * fifth
            dense[5, part, c] = h * sixth
            dense[6, part, c] = h * seventh
    for row in range(4):
        change = 0.0
        for j in range(16):
            change += D[row, j] * power[j]
        scratch.dense_work[3 + row] = h * change
    scratch.dense_work[0] = work
    scratch.dense_work[1] = h * power[0] - work
    scratch.dense_work[2] = 2.0 * work - h * (power[12] + power[0])


@internal
def interpolate(dense, dense_work, y, x, out):
    """Fill out (2, n) at the part x of the step that began at y; returns the work so far (J).

    Not inlined: numba 0.68 mixes up its copies where it is called more than once.
    """
    for part in range(2):
        for c in range(3, y.shape[1]):
            value = 0.0
            for row in range(6, -1, -1):
                value = (value + dense[row, part, c]) * (x if row % 2 == 0 else 1.0 - x)
            out[part, c] = y[part, c] + value
    work = 0.0
    for row in range(6, -1, -1):
        work = (work + dense_work[row]) * (x if row % 2 == 0 else 1.0 - x)
    return work


@lazy(bool)
def _output_between(dyn, scratch, state, out, k, x, h, so_far):
    """Write output k at the part x of the step from poses beside; returns whether two are clear."""
    t = state.clock[TIME]
    beside = BESIDE
    while beside < 1.0:
        interpolate(scratch.dense, scratch.dense_work, state.y, x - beside, scratch.state)
        before = record(dyn, scratch, out, k, t + (x - beside) * h, so_far)
        keep_row(dyn, scratch, out, k)
        interpolate(scratch.dense, scratch.dense_work, state.y, x + beside, scratch.state)
        after = record(dyn, scratch, out, k, t + (x + beside) * h, so_far)
        if before and after:
            join_rows(dyn, scratch, out, k, 2.0 * beside * h)
            return True
        beside *= 2.0
    return False


@apart
def write_outputs(dyn, scratch, state, out, h, reached):
    """Write all outputs before the end of the step; returns whether their poses, or poses beside them, are clear."""
    t = state.clock[TIME]
    k = state.count[NEXT]
    while k < out.t.shape[0] and out.t[k] < reached:
        x = (out.t[k] - t) / h
        so_far = state.clock[WORK] + interpolate(scratch.dense, scratch.dense_work, state.y, x, scratch.state)
        clear = record_all(dyn, scratch, out, k, t + x * h, so_far)
        if not clear and not _output_between(dyn, scratch, state, out, k, x, h, so_far):
            return False
        k += 1
        state.count[NEXT] = k
    return True
