"""Rows of sweeps and calls, bars against peers of the sweep, and the most that our calls may take."""

from __future__ import annotations

import importlib

from benchmarks.calls import CHANGED, FOUR_BAR, LIMIT, SIMULATION, SWEEP
from benchmarks.harness import Run, best_rows
from benchmarks.rows import Bar, Row

CODES = {
    FOUR_BAR: ("mbsd", "numpy", "exudyn", "pylinkage"),
    SWEEP: ("mbsd", "pylinkage", "exudyn"),
    CHANGED: ("mbsd", "pylinkage", "exudyn"),
    SIMULATION: ("mbsd", "exudyn", "mujoco"),
}
ROUNDS = 8
PEERS = {"exudyn": 20.0, "numpy": 200.0, "pylinkage": 2.0}
"""How many times the time of mbsd each peer takes at least for the sweep."""
LARGEST_ERROR = 1e-12
"""rad, of our sweep."""
BARS = {SWEEP: 2e-3, CHANGED: 1e-3, SIMULATION: 1e-3}
"""s that our calls take at most."""


def prepared(code: str, problem: str) -> Run:
    """Return the run of one code.

    Its module gives settings, ``fresh`` and the error of a result by the problem.
    """
    module = importlib.import_module(f"benchmarks.calls.{code}_code")
    settings, fresh, error = module.run(problem)
    return Run(module.VERSION, settings, fresh, lambda result: {"": error(result)}, {"": LIMIT})


def measured() -> tuple[list[Row], list[Bar]]:
    """Return rows by problem, and the bars."""
    best = best_rows(__name__, CODES, ROUNDS)
    ours, bars = best[FOUR_BAR]["mbsd"], []
    for code, wanted in PEERS.items():
        ratio = best[FOUR_BAR][code].seconds / ours.seconds
        met = ours.error < LARGEST_ERROR and ratio >= wanted
        bars.append(Bar(FOUR_BAR, wanted, ratio, code, best[FOUR_BAR][code].settings, met))
    for problem, most in BARS.items():
        ours = best[problem]["mbsd"]
        met = ours.seconds <= most and ours.within_limits
        bars.append(Bar(f"{problem}, ms", 1e3 * most, 1e3 * ours.seconds, "", ours.settings, met, most=True))
    return [row for rows in best.values() for row in rows.values()], bars
