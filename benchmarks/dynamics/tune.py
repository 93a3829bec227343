"""Find a peer's best settings for a problem: the quickest that keep all errors within the limits.

    python -m benchmarks.dynamics.tune CODE CASE            (all: python -m benchmarks tune)

Every ladder of the code's ``ladders`` is climbed from cheap to exact, three rungs at a time and then back over the two
between, until the limits are met or it takes longer than the best so far. The best few are timed again side by side.
Times are of the processor, so that other work on the machine disturbs them little. Prints one JSON object.
"""

from __future__ import annotations

import importlib
import json
import os
import sys
import time
from dataclasses import dataclass
from typing import Any

from benchmarks.dynamics.cases import Case, case

STRIDE = 3
TOO_LONG = 1.3
"""Times the best so far."""
FINALISTS = 4
FINAL_RUNS = 7


@dataclass
class Tried:
    """One candidate: processor seconds and errors."""

    settings: dict[str, Any]
    seconds: float
    errors: dict[str, float]
    excess: float


def tune(code: str, problem: Case) -> dict[str, Any]:
    """The best settings found, whether they meet the limits, errors, seconds, and how many were tried."""
    module = importlib.import_module(f"benchmarks.dynamics.{code}_code")
    tried: list[Tried] = []
    best = float("inf")
    for ladder in module.ladders(problem):
        k, last, reached = 0, 0, False
        while k < len(ladder):
            attempt = _attempt(module, problem, ladder[k])
            tried.append(attempt)
            if attempt.excess <= 1:
                best = min(best, attempt.seconds)
                if reached or k == 0:
                    break
                reached, last = True, k
                k = max(0, k - STRIDE + 1)
                continue
            if attempt.seconds > TOO_LONG * best:
                break
            k += 1 if reached else STRIDE
            if reached and k >= last:
                break
    good = sorted((t for t in tried if t.excess <= 1), key=lambda t: t.seconds)[:FINALISTS]
    for _ in range(FINAL_RUNS):
        for finalist in good:
            finalist.seconds = min(finalist.seconds, _seconds(module, problem, finalist.settings))
    chosen = min(good, key=lambda t: t.seconds) if good else min(tried, key=lambda t: t.excess)
    return {
        "settings": chosen.settings,
        "met": chosen.excess <= 1,
        "errors": {name: float(f"{value:.3g}") for name, value in chosen.errors.items()},
        "seconds": float(f"{chosen.seconds:.3g}"),
        "tried": len(tried),
    }


def _attempt(module: Any, problem: Case, settings: dict[str, Any]) -> Tried:
    started, seconds = time.process_time(), 0.0
    try:
        seconds = min(_seconds(module, problem, settings) for _ in range(2))
        errors = problem.errors(module.prepare(problem, settings)[1]())
    except Exception as failure:  # a peer gives up in many ways; the candidate is out, the sweep goes on
        print(f"{settings}: {type(failure).__name__} {failure}"[:200], file=sys.stderr)
        seconds = seconds or time.process_time() - started
        return Tried(settings, seconds, dict.fromkeys(problem.limits, float("inf")), float("inf"))
    excess = problem.excess(errors)
    shown = {name: f"{value:.2g}" for name, value in errors.items()}
    print(f"{settings}: {seconds * 1e3:.2f} ms, {shown}", file=sys.stderr, flush=True)
    return Tried(settings, seconds, errors, excess)


def _seconds(module: Any, problem: Case, settings: dict[str, Any]) -> float:
    run = module.prepare(problem, settings)[0]()
    started = time.process_time()
    run()
    return time.process_time() - started


if __name__ == "__main__":
    if hasattr(os, "sched_setaffinity") and len(sys.argv) > 3:
        os.sched_setaffinity(0, {int(sys.argv[3])})
    print(json.dumps(tune(sys.argv[1], case(sys.argv[2]))))
