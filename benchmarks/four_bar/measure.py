"""Time one code on the sweep and print its row as JSON: ``python -m benchmarks.four_bar.measure CODE``."""

from __future__ import annotations

import importlib
import json
import os
import sys
import time
from dataclasses import asdict

from benchmarks.four_bar import PROBLEM, REPEATS
from benchmarks.rows import Row


def main(code: str) -> None:
    """Best of several runs of ``solve()``; the module checks its own error on the last one."""
    if hasattr(os, "sched_setaffinity"):
        os.sched_setaffinity(0, {max(os.sched_getaffinity(0))})
    module = importlib.import_module(f"benchmarks.four_bar.{code}_code")
    solve, error = module.prepare()
    result = solve()  # compiles, allocates, warms the cache
    best = float("inf")
    for _ in range(getattr(module, "REPEATS", REPEATS)):
        started = time.perf_counter()
        result = solve()
        best = min(best, time.perf_counter() - started)
    print(json.dumps(asdict(Row(PROBLEM, code, module.VERSION, module.SETTINGS, best, error(result)))))


if __name__ == "__main__":
    main(sys.argv[1])
