"""Rows of the dynamics problems at stored settings, bars beside peers, and growth with size."""

from __future__ import annotations

import importlib

import numpy as np

import mbsd
from benchmarks.dynamics import CODES
from benchmarks.dynamics.cases import ALONE, BESIDE_PEERS, case
from benchmarks.dynamics.mbsd_code import ready, started
from benchmarks.dynamics.n_four_bar import exact_angle
from benchmarks.dynamics.settings import load, words
from benchmarks.harness import Run, bar_of_peers, best_of, best_rows
from benchmarks.rows import Bar, Row
from mbsd.dynamics.simulate import integrator_named

TOLERANCE = 1e-6
ROUNDS = 3
SPREAD = 1.3
"""Largest ratio of the dearest to the cheapest."""


def prepared(code: str, name: str) -> Run:
    """Return the run of one code at its stored settings; errors are of a record of its own."""
    module = importlib.import_module(f"benchmarks.dynamics.{code}_code")
    problem, settings = case(name), load()[name][code]["settings"]
    fresh, record = module.prepare(problem, settings)
    return Run(module.VERSION, words(settings), fresh, lambda _: problem.errors(record()), problem.limits)


def measured() -> tuple[list[Row], list[Bar]]:
    """Return rows of all codes on all problems, the best of the rounds, and the bars."""
    chosen = load()
    codes = {name: [code for code in CODES if code in chosen.get(name, {})] for name in BESIDE_PEERS}
    rows = {name: list(best.values()) for name, best in best_rows(__name__, codes).items()}
    bars = [bar_of_peers(rows[name], case(name).bar) for name in rows if "mbsd" in codes[name]]
    return [row for of_problem in rows.values() for row in of_problem], bars


def scaling() -> tuple[list[Row], list[Bar]]:
    """Return rows of A02 by mbsd at 40, 400 and 4000 loops, and the bar of the cost of a body."""
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
    return rows, [
        Bar(
            "A02 N=40 to 4000, cost of a body",
            SPREAD,
            spread,
            "",
            ", ".join(f"{cost * 1e6:.2f}" for cost in costs) + " us per body and second",
            met,
            most=True,
        )
    ]
