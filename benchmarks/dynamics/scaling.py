"""A02 by mbsd alone at 40, 400 and 4000 loops: cost of a body per second of motion."""

from __future__ import annotations

import time

import mbsd
from benchmarks.dynamics.problems import problem
from benchmarks.rows import Row
from mbsd.dynamics.simulate import integrator_named

LOOPS = (40, 400, 4000)
TOLERANCE = 1e-6
SPREAD = 1.3
"""Largest ratio of the dearest to the cheapest."""


def measured() -> tuple[list[Row], list[str]]:
    """A row for each size, and the bar if it is missed."""
    import numpy as np

    rows, costs = [], []
    method = integrator_named("A02", "dop853")
    tasks = [problem(f"A02 N={loops}") for loops in LOOPS]
    best = [float("inf")] * len(LOOPS)
    for _ in range(3):
        for k, task in enumerate(tasks):
            grid = np.array([0.0, task.duration])
            started = time.perf_counter()
            task.ready.run(method, grid, TOLERANCE, task.duration)
            if _ or LOOPS[k] > 40:
                best[k] = min(best[k], time.perf_counter() - started)
    for loops, seconds in zip(LOOPS, best, strict=True):
        costs.append(seconds / (2 * loops + 1) / 10.0)
        words = f"dop853, tolerance {TOLERANCE:g}; {costs[-1] * 1e6:.2f} us per body and second"
        rows.append(Row(f"A02 N={loops}, mbsd alone", "mbsd", mbsd.__version__, words, seconds, 0.0))
    spread = max(costs) / min(costs)
    return rows, [] if spread <= SPREAD else [f"A02, N = 40 to 4000: cost varies by {spread:.2f}x, wanted {SPREAD}x"]
