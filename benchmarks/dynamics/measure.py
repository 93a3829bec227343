"""Rows of the dynamics problems, every code at its stored settings, and bars against the quickest peer within limits."""

from __future__ import annotations

import importlib

from benchmarks.driver import Run, bar_of_peers, best_rows
from benchmarks.dynamics import CODES
from benchmarks.dynamics.cases import BESIDE_PEERS, case
from benchmarks.dynamics.settings import load, words
from benchmarks.rows import Bar, Row


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
