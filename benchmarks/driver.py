"""Each code on each problem in a process of its own, in turn, round after round; the quickest run counts.

``python -m benchmarks.driver MODULE CODE PROBLEM`` times one code on one problem and prints its row as JSON. The module
has ``prepared(code, problem)``, which returns a :class:`Run`.
"""

from __future__ import annotations

import importlib
import json
import sys
from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict
from typing import Any, NamedTuple

from benchmarks.harness import best_of, bind_to_one_core, keep_quicker, printed_by
from benchmarks.rows import Bar, Row
from shared.stage.console import say

MOST_RUNS, LONGEST = 400, 1.0
"""Number of runs that are timed; none is begun after so many seconds."""

Fresh = Callable[[], Callable[[], Any]]
"""Returns a run that is ready; building it is not timed."""


class Run(NamedTuple):
    """One code on one problem; ``errors`` of a run's result go by the names of ``limits``, the last is the row's."""

    version: str
    settings: str
    fresh: Fresh
    errors: Callable[[Any], Mapping[str, float]]
    limits: Mapping[str, float]


def best_rows(module: str, codes: Mapping[str, Sequence[str]], rounds: int = 3) -> dict[str, dict[str, Row]]:
    """Return the quickest rows by problem and code; ``codes`` are those that solve each problem."""
    rows: dict[str, dict[str, Row]] = {}
    for problem, solvers in codes.items():
        best = rows.setdefault(problem, {})
        for _ in range(rounds):
            for code in solvers:
                printed = printed_by("benchmarks.driver", module, code, problem, what=f"{code} on {problem}")
                keep_quicker(best, code, Row(**printed))
        say("bench", f"{problem} done")
    return rows


def bar_of_peers(rows: Sequence[Row], wanted: float) -> Bar:
    """Return the bar of mbsd against the quickest peer that keeps the limits of a problem."""
    ours = next(row for row in rows if row.code == "mbsd")
    peers = [row for row in rows if row.code != "mbsd" and row.within_limits]
    if not peers:
        return Bar(ours.problem, wanted, 0.0, "no peer was swept yet, or none keeps the limits", "", met=False)
    peer = min(peers, key=lambda row: row.seconds)
    ratio = peer.seconds / ours.seconds
    return Bar(ours.problem, wanted, ratio, peer.code, peer.settings, ours.within_limits and ratio >= wanted)


def row_of(code: str, problem: str, run: Run) -> Row:
    """Return the row of one code: errors of a first run, which compiles and warms the cache, and the best time."""
    errors = run.errors(run.fresh()())
    within = all(errors[name] <= limit for name, limit in run.limits.items())
    seconds, _ = best_of(run.fresh, MOST_RUNS, LONGEST)
    several = {} if len(errors) == 1 and "" in errors else dict(errors)
    return Row(problem, code, run.version, run.settings, seconds, list(errors.values())[-1], several, within)


def main(module: str, code: str, problem: str) -> None:
    """Print the row of one code on one problem."""
    bind_to_one_core()
    print(json.dumps(asdict(row_of(code, problem, importlib.import_module(module).prepared(code, problem)))))


if __name__ == "__main__":
    main(*sys.argv[1:])
