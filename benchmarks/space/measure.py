"""Rows of the problems in space, every code on every problem, and bars against each peer."""

from __future__ import annotations

import importlib

from benchmarks import space
from benchmarks.harness import Run, best_rows
from benchmarks.rows import Bar, Row


def prepared(code: str, problem: str) -> Run:
    """Return the run of one code; its module gives ``fresh`` and the error of a result."""
    module = importlib.import_module(f"benchmarks.space.{code}_code")
    fresh, error = module.prepare(problem)
    limits = {"": space.LIMITS[problem]}
    return Run(module.VERSION, module.settings(problem), fresh, lambda result: {"": error(result)}, limits)


def measured() -> tuple[list[Row], list[Bar]]:
    """Return rows of all codes on all problems, the best of the rounds in turn, and the bars."""
    codes = dict.fromkeys(space.PROBLEMS, space.CODES) | {space.BATCH: tuple({"mbsd", *space.BARS[space.BATCH]})}
    best = best_rows(__name__, codes)
    bars = []
    for problem, rows in best.items():
        ours = rows["mbsd"]
        for code, wanted in space.BARS[problem].items():
            peer = rows[code]
            ratio = peer.seconds / ours.seconds
            met = ours.within_limits and peer.within_limits and ratio >= wanted
            bars.append(Bar(problem, wanted, ratio, code, peer.settings, met))
    return [row for rows in best.values() for row in rows.values()], bars
