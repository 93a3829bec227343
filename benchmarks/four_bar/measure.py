"""Time one code on the sweep and print its row as JSON: ``python -m benchmarks.four_bar.measure CODE``."""

from __future__ import annotations

import importlib
import json
import sys
from dataclasses import asdict

from benchmarks.four_bar import PROBLEM, REPEATS
from benchmarks.harness import best_of, bind_to_one_core
from benchmarks.rows import Row


def main(code: str) -> None:
    """Print the best of several runs of ``solve()`` with the error of the last."""
    bind_to_one_core()
    module = importlib.import_module(f"benchmarks.four_bar.{code}_code")
    solve, error = module.prepare()
    solve()  # compiles, allocates, warms the cache
    best, result = best_of(lambda: solve, getattr(module, "REPEATS", REPEATS))
    print(json.dumps(asdict(Row(PROBLEM, code, module.VERSION, module.SETTINGS, best, error(result)))))


if __name__ == "__main__":
    main(sys.argv[1])
