"""Refines output times until the motion between two of them is the quintic that plots, clearance and film use.

    at the middle of a step h   q = (q0 + q1) / 2 + 5 h / 32 (v0 - v1) + h^2 / 64 (a0 + a1)

That is compared with the simulation itself at these middles; steps that differ are divided, and it is simulated again.
Stiff contacts and short pulses need it: for milliseconds their accelerations say nothing about the rest of a step.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from mbsd import Mechanism
    from mbsd.results.solution import Solution

CLOSE = 2e-5
"""Largest difference, in sizes of the mechanism (turned bodies count by their angle times that size)."""
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
        coarse = coarse_steps(solution)
        if not len(coarse) or len(times) + (PARTS - 1) * len(coarse) > MOST:
            break
        starts, ends = solution.t[coarse], solution.t[coarse + 1]
        inner = (starts[:, None] + (ends - starts)[:, None] * np.arange(1, PARTS) / PARTS).ravel()
        times = np.unique(np.concatenate([times, inner]))
        solution = m.simulate(times=times, event_rows=True)
    return solution


def refined_sweep(solution: Solution) -> Solution:
    """The same sweep, at more times where the motion needs them; itself where it does not."""
    closer = closer_times(solution.mechanism, solution.t)
    return solution if len(closer) == len(solution.t) else solution.mechanism.sweep(times=closer)


def swept_closely(m: Mechanism, times: np.ndarray) -> Solution:
    """``m.sweep`` at ``times`` (s) and at more where the motion needs them."""
    return m.sweep(times=closer_times(m, times))


def closer_times(m: Mechanism, times: np.ndarray) -> np.ndarray:
    """Times (s) with more of them where the motion of a sweep needs it: where a link flies past a dead point."""
    for _ in range(2 * ROUNDS):
        both = np.empty(2 * len(times) - 1)
        both[::2], both[1::2] = times, (times[:-1] + times[1:]) / 2
        finer = m.sweep(times=both)
        starts = np.arange(0, len(both) - 1, 2)
        closer = _divided(times, np.flatnonzero(_leaves(finer, starts, starts + 2, finer.q[1::2])))
        if len(closer) == len(times):
            break
        times = closer
    return times


def _divided(times: np.ndarray, coarse: np.ndarray) -> np.ndarray:
    """Times with some of their steps divided; the same where these are too many."""
    if len(times) + (PARTS - 1) * len(coarse) > MOST:
        return times
    starts, ends = times[coarse], times[coarse + 1]
    inner = (starts[:, None] + (ends - starts)[:, None] * np.arange(1, PARTS) / PARTS).ravel()
    return np.unique(np.concatenate([times, inner]))


def coarse_steps(solution: Solution) -> np.ndarray:
    """Numbers of the rows after which the quintic leaves the motion, by the motion at the middle of each step."""
    t = solution.t
    steps = np.flatnonzero(np.diff(t) > 1e-9 * (t[-1] - t[0]))
    return steps[_leaves(solution, steps, steps + 1, solution.at((t[steps] + t[steps + 1]) / 2).q)]


def _leaves(solution: Solution, first: np.ndarray, last: np.ndarray, middle: np.ndarray) -> np.ndarray:
    """(n,) bool: whether the quintic between two rows leaves the motion, ``middle`` (n, bodies, 3) half way."""
    h, size = (solution.t[last] - solution.t[first])[:, None, None], solution.packed.size
    q, v, a = solution.q, solution.v, solution.a
    between = (q[first] + q[last]) / 2 + 5 / 32 * h * (v[first] - v[last]) + h * h / 64 * (a[first] + a[last])
    gap = np.abs(between - middle) * np.array([1.0, 1.0, size])
    return gap.max(axis=(1, 2)) > CLOSE * size
