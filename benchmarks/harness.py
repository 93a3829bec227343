"""Timing of codes: each run in a process of its own, on one core and one thread; the best of several calls counts."""

from __future__ import annotations

import json
import math
import os
import subprocess
import sys
import time
from collections.abc import Callable, Sequence
from typing import Any

from benchmarks.rows import Row
from shared.stage.errors import UserError
from shared.stage.paths import ROOT

SINGLE = dict.fromkeys(("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"), "1")


def printed_by(module: str, *words: str, what: str) -> Any:
    """Return the JSON that ``python -m module words`` prints in its last line. Raises UserError naming ``what``."""
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
    """Return seconds of the quickest run of each call and what its last run gave; a first run of each is not timed.

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
