"""Timing of codes, each on each problem in a process of its own, in turn; the quickest run counts.

``python -m benchmarks.harness MODULE CODE PROBLEM`` times one code on one problem and prints its row as JSON. The
module has ``prepared(code, problem)``, which returns a :class:`Run`.
"""

from __future__ import annotations

import importlib
import json
import math
import os
import subprocess
import sys
import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict
from typing import Any, NamedTuple

from benchmarks.rows import Bar, Row
from shared.stage.console import say
from shared.stage.errors import UserError
from shared.stage.paths import ROOT

SINGLE = dict.fromkeys(("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"), "1")
MOST_RUNS, LONGEST = 400, 1.0
"""Number of runs that are timed; none is begun after so many seconds."""

Fresh = Callable[[], Callable[[], Any]]
"""Returns a run that is ready; building it is not timed."""


class Run(NamedTuple):
    """One code on one problem; ``errors`` of a result go by the names of ``limits``.

    The last is the row's.
    """

    version: str
    settings: str
    fresh: Fresh
    errors: Callable[[Any], Mapping[str, float]]
    limits: Mapping[str, float]


def printed_by(module: str, *words: str, what: str) -> Any:
    """Return the JSON that ``python -m module words`` prints in its last line.

    Raises UserError naming ``what``.
    """
    run = subprocess.run(
        [sys.executable, "-m", module, *words],
        cwd=ROOT, env=os.environ | SINGLE, capture_output=True, text=True, check=False,
    )  # fmt: skip
    if run.returncode:
        raise UserError(f"bench: {what} failed: {(run.stderr.strip().splitlines() or ['no message'])[-1]}")
    return found_in(run.stdout)


def found_in(printed: str) -> Any:
    """Return the last JSON object or list among what a code printed: Exudyn says hello when it ends."""
    return json.loads([line for line in printed.splitlines() if line.startswith(("{", "["))][-1])


def bind_to_one_core() -> None:
    """Keep this process on its last core."""
    if hasattr(os, "sched_setaffinity"):
        os.sched_setaffinity(0, {max(os.sched_getaffinity(0))})


def best_of(fresh: Callable[[], Callable[[], Any]], runs: int, longest: float = math.inf) -> tuple[float, Any]:
    """Return the seconds of the quickest of several runs and the result of the last.

    ``fresh`` gives a run, whose making is not timed; no run is begun after ``longest`` seconds.
    """
    best, result, begun = math.inf, None, time.perf_counter()
    for _ in range(runs):
        run = fresh()
        started = time.perf_counter()
        result = run()
        best = min(best, time.perf_counter() - started)
        if time.perf_counter() - begun > longest:
            break
    return best, result


def best_in_turns(
    calls: Sequence[Callable[[], Any]], turns: int, clock: Callable[[], float] = time.process_time
) -> list[tuple[float, Any]]:
    """Return seconds of the quickest run of each call and its last result.

    A first run of each is not timed.

    In turns no call finds the caches of the processor as it left them itself.
    """
    best, last = [math.inf] * len(calls), [call() for call in calls]
    for _ in range(turns):
        for k, call in enumerate(calls):
            started = clock()
            last[k] = call()
            best[k] = min(best[k], clock() - started)
    return list(zip(best, last, strict=True))


def keep_quicker(best: dict[Any, Row], key: Any, row: Row) -> None:
    """Keep a row unless the one that is kept under this key is quicker."""
    if key not in best or row.seconds < best[key].seconds:
        best[key] = row


def best_rows(module: str, codes: Mapping[str, Sequence[str]], rounds: int = 3) -> dict[str, dict[str, Row]]:
    """Return the quickest rows by problem and code; ``codes`` are those that solve each problem."""
    rows: dict[str, dict[str, Row]] = {}
    for problem, solvers in codes.items():
        best = rows.setdefault(problem, {})
        for _ in range(rounds):
            for code in solvers:
                printed = printed_by("benchmarks.harness", module, code, problem, what=f"{code} on {problem}")
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
    """Return the row of one code: errors of a first run, and the best time.

    The first run compiles and warms the cache.
    """
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
