"""Rows of the calls: every code in a process of its own on one core, in turns.

The best of all calls counts.
"""

from __future__ import annotations

import importlib
import json
import sys
from dataclasses import asdict

from benchmarks.calls import BARS
from benchmarks.harness import best_of, bind_to_one_core, keep_quicker, printed_by
from benchmarks.rows import Bar, Row

CODES = ("mbsd", "pylinkage", "exudyn", "mujoco")
ROUNDS = 4
CALLS = 60
LARGEST_ERROR = 1e-3
"""rad, J: with more, a code did not solve the problem."""


def measured() -> tuple[list[Row], list[Bar]]:
    """Rows by problem, and what our own calls take at most."""
    best: dict[tuple[str, str], Row] = {}
    for _ in range(ROUNDS):
        for code in CODES:
            for row in printed_by("benchmarks.calls.measure", code, what=f"calls of {code}"):
                keep_quicker(best, (row["problem"], code), Row(**row))
    rows_of_codes = [best[problem, code] for problem in BARS for code in CODES if (problem, code) in best]
    bars = []
    for problem, most in BARS.items():
        ours = best[problem, "mbsd"]
        met = ours.seconds <= most and ours.error < LARGEST_ERROR
        bars.append(Bar(f"{problem}, ms", 1e3 * most, 1e3 * ours.seconds, "", ours.settings, met, most=True))
    return rows_of_codes, bars


def main(code: str) -> None:
    """Print the rows of one code as JSON."""
    bind_to_one_core()
    module = importlib.import_module(f"benchmarks.calls.{code}_code")
    rows = []
    for call in module.calls():
        call.call()
        best, result = best_of(lambda call=call: call.call, CALLS)
        error = call.error(result)
        rows.append(Row(call.problem, code, module.VERSION, call.settings, best, error, {}, error < LARGEST_ERROR))
    print(json.dumps([asdict(row) for row in rows]))


if __name__ == "__main__":
    main(sys.argv[1])
