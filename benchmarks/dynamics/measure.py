"""Rows of the dynamics problems: every code at its stored settings, in turn, one process a run, several rounds.

python -m benchmarks.dynamics.measure CODE CASE times one code on one problem. It prints seconds (the best of several
runs), errors by name, and whether they are within the limits, as JSON.
"""

from __future__ import annotations

import importlib
import json
import sys

from benchmarks.dynamics import CODES
from benchmarks.dynamics.cases import BESIDE_PEERS, case
from benchmarks.dynamics.settings import load, words
from benchmarks.harness import best_of, bind_to_one_core, keep_quicker, printed_by
from benchmarks.rows import Bar, Row
from shared.stage.console import say

ROUNDS = 3
LONGEST = 1.0
"""s: no new run is begun after this."""
MOST_RUNS = 400


def measured() -> tuple[list[Row], list[Bar]]:
    """Rows of all codes on all problems, the best of the rounds, and the bars."""
    rows: list[Row] = []
    bars: list[Bar] = []
    chosen = load()
    for name in BESIDE_PEERS:
        best: dict[str, Row] = {}
        for _ in range(ROUNDS):
            for code in CODES:
                if code in chosen.get(name, {}):
                    keep_quicker(best, code, _once(code, name, words(chosen[name][code]["settings"])))
        rows += best.values()
        if "mbsd" in best:
            bars.append(_bar(name, best))
        say("bench", f"{name} done")
    return rows, bars


def _once(code: str, name: str, settings: str) -> Row:
    record = printed_by("benchmarks.dynamics.measure", code, name, what=f"{code} on {name}")
    errors = record["errors"]
    error = errors[list(case(name).limits)[-1]]
    return Row(name, code, record["version"], settings, record["seconds"], error, errors, record["met"])


def _bar(name: str, best: dict[str, Row]) -> Bar:
    """Against the quickest peer that keeps the limits."""
    ours, wanted = best["mbsd"], case(name).bar
    peers = [row for code, row in best.items() if code != "mbsd" and row.within_limits]
    if not peers:
        return Bar(name, wanted, 0.0, "no peer was swept yet, or none keeps the limits", "", met=False)
    peer = min(peers, key=lambda row: row.seconds)
    ratio = peer.seconds / ours.seconds
    return Bar(name, wanted, ratio, peer.code, peer.settings, ours.within_limits and ratio >= wanted)


def main(code: str, name: str) -> None:
    """Print the result of one code on one problem at its stored settings."""
    bind_to_one_core()
    module = importlib.import_module(f"benchmarks.dynamics.{code}_code")
    problem, settings = case(name), load()[name][code]["settings"]
    fresh, record = module.prepare(problem, settings)
    errors = problem.errors(record())  # compiles and warms the cache too
    seconds, _ = best_of(fresh, MOST_RUNS, LONGEST)
    print(json.dumps({"version": module.VERSION, "seconds": seconds, "errors": errors, "met": problem.met(errors)}))


if __name__ == "__main__":
    main(*sys.argv[1:])
