"""Rows of the machines: every code on every problem in turn, one process a run, several rounds.

python -m benchmarks.machines.measure CODE NUMBER times one code on one problem and prints its row as JSON.
"""

from __future__ import annotations

import importlib
import json
import sys
from dataclasses import asdict

from benchmarks import machines
from benchmarks.harness import best_of, bind_to_one_core, keep_quicker, printed_by
from benchmarks.rows import Bar, Row
from shared.stage.console import say

ROUNDS = 3
LONGEST = 1.0
"""s: no new run is begun after this."""
MOST_RUNS = 200


def measured() -> tuple[list[Row], list[Bar]]:
    """Rows of all codes on all problems, the best of the rounds, and the bars."""
    rows: list[Row] = []
    bars: list[Bar] = []
    for number, problem in enumerate(machines.PROBLEMS):
        best: dict[str, Row] = {}
        for _ in range(ROUNDS):
            for code in machines.CODES:
                words = "benchmarks.machines.measure", code, str(number)
                keep_quicker(best, code, Row(**printed_by(*words, what=f"{code} on {problem}")))
        rows += best.values()
        ours = best.pop("mbsd")
        peer = min(best.values(), key=lambda row: row.seconds)
        if any(row.within_limits for row in best.values()):
            peer = min((row for row in best.values() if row.within_limits), key=lambda row: row.seconds)
        ratio, wanted = peer.seconds / ours.seconds, machines.BARS[problem]
        bars.append(Bar(problem, wanted, ratio, peer.code, peer.settings, ours.within_limits and ratio >= wanted))
        say("bench", f"{problem} done")
    return rows, bars


def main(code: str, number: int) -> None:
    """Print the row."""
    bind_to_one_core()
    problem = machines.PROBLEMS[number]
    module = importlib.import_module(f"benchmarks.machines.{code}_code")
    fresh, error = module.prepare(problem)
    wrong = error(fresh()())  # compiles, allocates, warms the cache
    best, _ = best_of(fresh, MOST_RUNS, LONGEST)
    row = Row(
        problem, code, module.VERSION, module.settings(problem), best, wrong,
        within_limits=wrong <= machines.LIMITS[problem],
    )  # fmt: skip
    print(json.dumps(asdict(row)))


if __name__ == "__main__":
    main(sys.argv[1], int(sys.argv[2]))
