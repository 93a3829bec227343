"""Time one code on one problem at its stored settings: ``python -m benchmarks.dynamics.once CODE CASE``, one core.

Prints seconds (the best of several runs), errors by name, and whether they are within the limits, as JSON.
"""

from __future__ import annotations

import importlib
import json
import os
import sys
import time

for threads in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ.setdefault(threads, "1")

from benchmarks.dynamics.cases import case  # noqa: E402
from benchmarks.dynamics.settings import load  # noqa: E402

LONGEST = 1.0
"""s: no new run is begun after this."""
MOST_RUNS = 400


def main(code: str, name: str) -> None:
    """Print the result."""
    if hasattr(os, "sched_setaffinity"):
        os.sched_setaffinity(0, {max(os.sched_getaffinity(0))})
    module = importlib.import_module(f"benchmarks.dynamics.{code}_code")
    problem, settings = case(name), load()[name][code]["settings"]
    fresh, record = module.prepare(problem, settings)
    errors = problem.errors(record())  # compiles and warms the cache too
    best, begun = float("inf"), time.perf_counter()
    for _ in range(MOST_RUNS):
        run = fresh()
        started = time.perf_counter()
        run()
        best = min(best, time.perf_counter() - started)
        if time.perf_counter() - begun > LONGEST:
            break
    print(json.dumps({"version": module.VERSION, "seconds": best, "errors": errors, "met": problem.met(errors)}))


if __name__ == "__main__":
    main(*sys.argv[1:])
