"""Rows of the calls: every code in a process of its own on one core, in turns, the best of all calls counts."""

from __future__ import annotations

import importlib
import json
import os
import subprocess
import sys
import time
from dataclasses import asdict

from benchmarks.calls import BARS
from benchmarks.rows import Bar, Row
from shared.stage.errors import UserError
from shared.stage.paths import ROOT

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
            for row in _measure(code):
                key = row.problem, code
                best[key] = min(best.get(key, row), row, key=lambda call: call.seconds)
    rows_of_codes = [best[problem, code] for problem in BARS for code in CODES if (problem, code) in best]
    bars = []
    for problem, most in BARS.items():
        ours = best[problem, "mbsd"]
        met = ours.seconds <= most and ours.error < LARGEST_ERROR
        bars.append(Bar(f"{problem}, ms", 1e3 * most, 1e3 * ours.seconds, "", ours.settings, met, most=True))
    return rows_of_codes, bars


def _measure(code: str) -> list[Row]:
    single = dict.fromkeys(("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"), "1")
    run = subprocess.run(
        [sys.executable, "-m", "benchmarks.calls.measure", code],
        cwd=ROOT, env=os.environ | single, capture_output=True, text=True, check=False,
    )  # fmt: skip
    if run.returncode:
        raise UserError(f"bench: calls of {code} failed: {(run.stderr.strip().splitlines() or ['no message'])[-1]}")
    return [Row(**row) for row in json.loads(run.stdout.strip().splitlines()[-1])]


def main(code: str) -> None:
    """Print the rows of one code as JSON."""
    if hasattr(os, "sched_setaffinity"):
        os.sched_setaffinity(0, {max(os.sched_getaffinity(0))})
    module = importlib.import_module(f"benchmarks.calls.{code}_code")
    rows = []
    for call in module.calls():
        result, best = call.call(), float("inf")
        for _ in range(CALLS):
            started = time.perf_counter()
            result = call.call()
            best = min(best, time.perf_counter() - started)
        error = call.error(result)
        rows.append(Row(call.problem, code, module.VERSION, call.settings, best, error, {}, error < LARGEST_ERROR))
    print(json.dumps([asdict(row) for row in rows]))


if __name__ == "__main__":
    main(sys.argv[1])
