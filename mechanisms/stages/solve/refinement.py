"""Refinement of output times, until the motion between two of them is the quintic that plots, clearance and film use.

    at the middle of a step h   q = (q0 + q1) / 2 + 5 h / 32 (v0 - v1) + h^2 / 64 (a0 + a1)

That is compared with the simulation itself at these middles; steps that differ are divided, and it is simulated
again. Stiff contacts and short pulses need it: for milliseconds their accelerations say nothing about the rest of a
step.

A motion that snaps through needs more. The proof of clearance knows rows alone, and trusts a step by how far the
quintic is from the cubic through places and rates (clearance/path.py), with h the step, at their middle control
points:

    3 (q0 - q1) / 10 + h (2 v0 + v1) / 10 + h^2 a0 / 20      and the same from the other end

so that steps in which these are far apart are divided, too.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from mbsd import Mechanism, Solution

CLOSE = 2e-5
"""Largest difference, in sizes of the mechanism (turned bodies count by their angle times that size)."""
PROVABLE = 5e-4
"""Doubt of the proof of clearance that a step may leave, in the same sizes: a third of the gap by which a block clears
its rail in automatic parts."""
DOUBT = 3.0 * 0.625
"""Factor on that difference of control points, as in the proof."""
PARTS = 4
"""Into which a step is divided at once."""
ROUNDS = 4
MOST = 20_000
"""Times that a motion has at the most."""


def simulated_closely(m: Mechanism, duration: float, steps: int) -> Solution:
    """``m.simulate`` with both rows of events, in ``steps`` equal steps and more where the motion needs them."""
    times = np.linspace(0.0, duration, steps + 1)
    solution = m.simulate(times=times, event_rows=True)
    for _ in range(ROUNDS):
        closer = np.union1d(times, _inner(solution.t, len(times), *coarse_steps(solution)))
        if len(closer) == len(times):
            break
        times = closer
        solution = m.simulate(times=times, event_rows=True)
    return solution


def refined_sweep(solution: Solution) -> Solution:
    """Return the same sweep, with both rows of what jumps and at more times where the motion needs them."""
    both = solution.mechanism.sweep(times=solution.t, event_rows=True)
    times = np.unique(both.t)
    closer = closer_times(solution.mechanism, times)
    if len(closer) > len(times):
        return solution.mechanism.sweep(times=closer, event_rows=True)
    return both if len(both.t) > len(solution.t) else solution


def swept_closely(m: Mechanism, times: np.ndarray) -> Solution:
    """``m.sweep`` at ``times`` (s) and at more where the motion needs them."""
    return m.sweep(times=closer_times(m, times))


def closer_times(m: Mechanism, times: np.ndarray) -> np.ndarray:
    """Return times (s) with more of them where the motion of a sweep needs it: where a link flies past a dead point."""
    for _ in range(2 * ROUNDS):
        middles = (times[:-1] + times[1:]) / 2
        finer = m.sweep(times=np.sort(np.concatenate([times, middles])), event_rows=True)
        first = np.searchsorted(finer.t, times[:-1], side="right") - 1
        last, middle = np.searchsorted(finer.t, times[1:]), np.searchsorted(finer.t, middles)
        far = _far(finer, first, last, finer.q[middle])
        coarse = np.flatnonzero(far > 1.0)
        closer = np.union1d(times, _inner(times, len(times), coarse, far[coarse]))
        if len(closer) == len(times):
            break
        times = closer
    return times


def _inner(times: np.ndarray, count: int, coarse: np.ndarray, far: np.ndarray) -> np.ndarray:
    """Return times (s) that divide the steps after rows ``coarse`` of ``times``; of too many, those that are ``far``
    most.

    ``count``: how many times there are already.
    """
    room = max(MOST - count, 0) // (PARTS - 1)
    coarse = coarse[np.argsort(-far, kind="stable")[:room]]
    starts, ends = times[coarse], times[coarse + 1]
    return (starts[:, None] + (ends - starts)[:, None] * np.arange(1, PARTS) / PARTS).ravel()


def coarse_steps(solution: Solution) -> tuple[np.ndarray, np.ndarray]:
    """Return rows after which the quintic leaves the motion or cannot be trusted, and how far, 1 being what may be."""
    steps = _steps(solution)
    far = _far(solution, steps, steps + 1, solution.at((solution.t[steps] + solution.t[steps + 1]) / 2).q)
    return steps[far > 1.0], far[far > 1.0]


def doubted_steps(solution: Solution) -> np.ndarray:
    """Return rows after which the proof of clearance doubts the motion, as far as the rows themselves show."""
    steps = _steps(solution)
    return steps[_doubt(solution, steps, steps + 1) > 1.0]


def _steps(solution: Solution) -> np.ndarray:
    """Return (n,) rows at which a step begins."""
    t = solution.t
    return np.flatnonzero(np.diff(t) > 1e-9 * (t[-1] - t[0]))


def _far(solution: Solution, first: np.ndarray, last: np.ndarray, middle: np.ndarray) -> np.ndarray:
    """Return (n,) how far the quintic between two rows is from the motion, ``middle`` (n, bodies, 3) half way, or
    doubted.

    In parts of what may be.
    """
    h, size = (solution.t[last] - solution.t[first])[:, None, None], solution.packed.size
    q, v, a = solution.q, solution.v, solution.a
    between = (q[first] + q[last]) / 2 + 5 / 32 * h * (v[first] - v[last]) + h * h / 64 * (a[first] + a[last])
    gap = np.abs(between - middle) * np.array([1.0, 1.0, size])
    return np.maximum(gap.max(axis=(1, 2)) / (CLOSE * size), _doubt(solution, first, last))


def _doubt(solution: Solution, first: np.ndarray, last: np.ndarray) -> np.ndarray:
    """Return (n,) how far the quintic between two rows is from the cubic, in parts of what the proof may doubt."""
    h, size = (solution.t[last] - solution.t[first])[:, None, None], solution.packed.size
    rise = 0.3 * (solution.q[last] - solution.q[first])
    v0, v1 = h * solution.v[first], h * solution.v[last]
    begins = (2 * v0 + v1) / 10 + h * h * solution.a[first] / 20 - rise
    ends = (v0 + 2 * v1) / 10 - h * h * solution.a[last] / 20 - rise
    gap = DOUBT * np.maximum(np.abs(begins), np.abs(ends)) * np.array([1.0, 1.0, size])
    return gap.max(axis=(1, 2)) / (PROVABLE * size)
