"""Outputs in reference coordinates from states in independent ones; multipliers are found afterwards.

At a pose that coordinates do not tell clearly the output is the middle of the quintic through q, q', q'' at two poses
a little before and after it, H seconds apart:

    q   = (q0 + q1) / 2 + 5/32 H (q0' - q1') + 1/64 H^2 (q0'' + q1'')
    q'  = 15/8 (q1 - q0) / H - 7/16 (q0' + q1') + 1/32 H (q1'' - q0'')
    q'' = 3/2 (q1' - q0') / H - (q0'' + q1'') / 4
"""

from __future__ import annotations

from mbsd.compiling.jit import apart, inlined
from mbsd.dynamics.independent.equations import evaluate, put, write
from mbsd.dynamics.state import NEXT, TIME, WORK


@inlined
def record(dyn, scratch, out, k, t, work):
    """Write output k from scratch.state at t (s); returns whether its pose is clear."""
    out.work[k] = work
    power = write(dyn, scratch, t, scratch.state, scratch.stages[0], out, k)
    return power + work == power + work


@inlined
def record_all(dyn, scratch, out, k, t, work):
    """``record`` with the evaluation in it: no arrays are handed over for each of many outputs."""
    a = scratch.stages[0, 1]
    forces = out.lam.shape[0] > 0
    out.work[k] = work
    power = evaluate(dyn, scratch, t, scratch.state, a, forces)
    put(scratch.body, scratch.rate, scratch.base, scratch.coordinate, a, forces, out.y[k], out.a[k])
    return power + work == power + work


@inlined
def keep_row(dyn, scratch, out, k):
    """Keep output k as the pose before an unclear one."""
    for c in range(scratch.before.shape[1]):
        scratch.before[0, c] = out.y[k, 0, c]
        scratch.before[1, c] = out.y[k, 1, c]
        scratch.before[2, c] = out.a[k, c]


@inlined
def join_rows(dyn, scratch, out, k, between):
    """Put output k in the middle between the pose kept and its own, ``between`` seconds later."""
    before = scratch.before
    for c in range(before.shape[1]):
        q = out.y[k, 0, c]
        v = out.y[k, 1, c]
        a = out.a[k, c]
        out.y[k, 0, c] = (
            0.5 * (before[0, c] + q)
            + 5.0 / 32.0 * between * (before[1, c] - v)
            + between * between / 64.0 * (before[2, c] + a)
        )
        out.y[k, 1, c] = (
            15.0 / 8.0 * (q - before[0, c]) / between
            - 7.0 / 16.0 * (before[1, c] + v)
            + between / 32.0 * (a - before[2, c])
        )
        out.a[k, c] = 1.5 * (v - before[1, c]) / between - 0.25 * (before[2, c] + a)


@apart
def record_here(dyn, scratch, state, out):
    """Write the next output from the state itself, which stands at its time."""
    k = state.count[NEXT]
    write(dyn, scratch, state.clock[TIME], state.y, scratch.stages[0], out, k)
    out.work[k] = state.clock[WORK]
    state.count[NEXT] = k + 1
