"""``make bench``: every code on every problem, a table, and out/bench.json."""

from __future__ import annotations

import json
import os
import subprocess
import sys

from benchmarks import film, rows, table
from benchmarks.batch import measure as batch
from benchmarks.dynamics import measure as dynamics
from benchmarks.dynamics import scaling
from benchmarks.four_bar import STEPS
from benchmarks.rows import Row
from shared.console import run_cli, say
from shared.errors import UserError
from shared.paths import ROOT

CODES = ("mbsd", "numpy", "exudyn", "pylinkage")
ROUNDS = 3
BARS = {"exudyn": 20.0, "numpy": 200.0, "pylinkage": 2.0}
"""How many times the time of mbsd each peer takes at least."""
LARGEST_ERROR = 1e-12


def main() -> int:
    """Run the rounds; 1 if a bar is missed."""
    best: dict[str, Row] = {}
    for turn in range(ROUNDS):
        for code in CODES:
            row = _measure(code)
            best[code] = min(best.get(code, row), row, key=lambda r: r.seconds)
        say("bench", f"round {turn + 1} of {ROUNDS} done")
    found = [best[code] for code in CODES]
    rows.show(found, STEPS)
    missed = [
        f"{code}: {best[code].seconds / found[0].seconds:.2f}x, wanted {bar:g}x"
        for code, bar in BARS.items()
        if best[code].seconds < bar * found[0].seconds
    ]
    if not found[0].error < LARGEST_ERROR:
        missed.append(f"error {found[0].error:.1e}, wanted below {LARGEST_ERROR:g}")
    everything = list(found)
    for part in (batch.measured, dynamics.measured, scaling.measured, film.rows_of_films):
        more, more_missed = part()
        everything += more
        missed += more_missed
    rows.show_all(everything[len(found) :])
    rows.write(everything)
    table.write(everything)
    for line in missed:
        say("bench", f"missed: {line}")
    say("bench", "out/bench.json and the table of docs/benchmarks.md written")
    return 1 if missed else 0


def _measure(code: str) -> Row:
    """One code in a process of its own, on one thread."""
    single = dict.fromkeys(("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"), "1")
    run = subprocess.run(
        [sys.executable, "-m", "benchmarks.four_bar.measure", code],
        cwd=ROOT, env=os.environ | single, capture_output=True, text=True, check=False,
    )  # fmt: skip
    if run.returncode:
        raise UserError(f"bench: {code} failed: {(run.stderr.strip().splitlines() or ['no message'])[-1]}")
    return Row(**json.loads(run.stdout.strip().splitlines()[-1]))


if __name__ == "__main__":
    run_cli(main)
