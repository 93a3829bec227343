"""Rows of the machines, every code on every problem, and bars against the quickest peer."""

from __future__ import annotations

import importlib

from benchmarks import machines
from benchmarks.harness import Run, bar_of_peers, best_rows
from benchmarks.rows import Bar, Row


def prepared(code: str, problem: str) -> Run:
    """Return the run of one code; its module gives ``fresh`` and the error of a result."""
    module = importlib.import_module(f"benchmarks.machines.{code}_code")
    fresh, error = module.prepare(problem)
    limits = {"": machines.LIMITS[problem]}
    return Run(module.VERSION, module.settings(problem), fresh, lambda result: {"": error(result)}, limits)


def measured() -> tuple[list[Row], list[Bar]]:
    """Return rows of all codes on all problems, the best of the rounds, and the bars."""
    best = best_rows(__name__, dict.fromkeys(machines.PROBLEMS, machines.CODES))
    bars = [bar_of_peers(list(rows.values()), machines.BAR) for rows in best.values()]
    return [row for rows in best.values() for row in rows.values()], bars
