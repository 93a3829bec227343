"""A02 by mbsd alone at 40, 400 and 4000 loops: cost of a body per second of motion.

The same tolerance for all; errors are held against the limits of the angle at 10 s, and shown.
"""

from __future__ import annotations

import numpy as np

import mbsd
from benchmarks.dynamics.cases import ALONE, case
from benchmarks.dynamics.mbsd_code import ready, started
from benchmarks.dynamics.n_four_bar import exact_angle
from benchmarks.harness import best_of
from benchmarks.rows import Bar, Row
from mbsd.dynamics.simulate import integrator_named

TOLERANCE = 1e-6
ROUNDS = 3
SPREAD = 1.3
"""Largest ratio of the dearest to the cheapest."""


def measured() -> tuple[list[Row], list[Bar]]:
    """A row for each size, and the bar."""
    method = integrator_named("A02", "dop853")
    cases = [case(name) for name in ALONE]
    prepared = [ready(chain) for chain in cases]
    best, angles = [float("inf")] * len(cases), [0.0] * len(cases)
    for repeat in range(1 + ROUNDS):
        for k, (chain, system) in enumerate(zip(cases, prepared, strict=True)):
            to_end, out = started(system, method, TOLERANCE, np.array([0.0, chain.duration]))
            seconds, _ = best_of(lambda to_end=to_end: to_end, 1)
            if repeat > 0:  # the first one compiles
                best[k] = min(best[k], seconds)
            loops = len(chain.model.solids) // 2
            vertical = out.y[-1].reshape(2, -1, 3)[0, 1::2, 2]
            angles[k] = float(np.abs(vertical - exact_angle(loops)).max())
    rows, costs = [], []
    for chain, seconds, angle in zip(cases, best, angles, strict=True):
        costs.append(seconds / len(chain.model.solids) / chain.duration)
        words = f"dop853, tolerance {TOLERANCE:g}; {costs[-1] * 1e6:.2f} us per body and second"
        right = angle <= chain.limits["angle (rad)"]
        rows.append(
            Row(f"{chain.name}, alone", "mbsd", mbsd.__version__, words, seconds, angle, {"angle (rad)": angle}, right)
        )
    spread = max(costs) / min(costs)
    met = spread <= SPREAD and all(row.within_limits for row in rows)
    return rows, [Bar("A02 N=40 to 4000, cost of a body", SPREAD, spread, "", words_of(costs), met, most=True)]


def words_of(costs: list[float]) -> str:
    """Words of the bar."""
    return ", ".join(f"{cost * 1e6:.2f}" for cost in costs) + " us per body and second"
