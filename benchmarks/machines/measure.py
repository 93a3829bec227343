"""Rows of the machines: every code on every problem in turn, one process a run, several rounds.

python -m benchmarks.machines.measure CODE NUMBER times one code on one problem and prints its row as JSON.
"""

from __future__ import annotations

import importlib
import json
import os
import subprocess
import sys
import time
from dataclasses import asdict

for threads in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ.setdefault(threads, "1")

from benchmarks import machines  # noqa: E402
from benchmarks.rows import Bar, Row  # noqa: E402
from shared.stage.console import say  # noqa: E402
from shared.stage.errors import UserError  # noqa: E402
from shared.stage.paths import ROOT  # noqa: E402

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
                row = _once(code, number)
                best[code] = min(best.get(code, row), row, key=lambda r: r.seconds)
        rows += best.values()
        ours = best.pop("mbsd")
        peer = min(best.values(), key=lambda row: row.seconds)
        if any(row.within_limits for row in best.values()):
            peer = min((row for row in best.values() if row.within_limits), key=lambda row: row.seconds)
        ratio, wanted = peer.seconds / ours.seconds, machines.BARS[problem]
        bars.append(Bar(problem, wanted, ratio, peer.code, peer.settings, ours.within_limits and ratio >= wanted))
        say("bench", f"{problem} done")
    return rows, bars


def _once(code: str, number: int) -> Row:
    run = subprocess.run(
        [sys.executable, "-m", "benchmarks.machines.measure", code, str(number)],
        cwd=ROOT, capture_output=True, text=True, check=False,
    )  # fmt: skip
    if run.returncode:
        raise UserError(
            f"bench: {code} on {machines.PROBLEMS[number]} failed: "
            f"{(run.stderr.strip().splitlines() or ['no message'])[-1]}"
        )
    return Row(**json.loads(next(line for line in run.stdout.splitlines() if line.startswith("{"))))


def main(code: str, number: int) -> None:
    """Print the row."""
    if hasattr(os, "sched_setaffinity"):
        os.sched_setaffinity(0, {max(os.sched_getaffinity(0))})
    problem = machines.PROBLEMS[number]
    module = importlib.import_module(f"benchmarks.machines.{code}_code")
    fresh, error = module.prepare(problem)
    result = fresh()()  # compiles, allocates, warms the cache
    wrong = error(result)
    best, begun = float("inf"), time.perf_counter()
    for _ in range(MOST_RUNS):
        run = fresh()
        started = time.perf_counter()
        run()
        best = min(best, time.perf_counter() - started)
        if time.perf_counter() - begun > LONGEST:
            break
    row = Row(
        problem, code, module.VERSION, module.settings(problem), best, wrong,
        within_limits=wrong <= machines.LIMITS[problem],
    )  # fmt: skip
    print(json.dumps(asdict(row)))


if __name__ == "__main__":
    main(sys.argv[1], int(sys.argv[2]))
