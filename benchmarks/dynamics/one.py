"""``python -m benchmarks.dynamics.one CODE PROBLEM SETTINGS``: one code once, its result as JSON, on one core."""

from __future__ import annotations

import json
import os
import sys

for threads in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ.setdefault(threads, "1")

from benchmarks.dynamics.search import try_one  # noqa: E402


def main(code: str, name: str, settings: str) -> None:
    """Print the result."""
    if hasattr(os, "sched_setaffinity"):
        os.sched_setaffinity(0, {max(os.sched_getaffinity(0))})
    print(json.dumps(try_one(code, name, json.loads(settings))))


if __name__ == "__main__":
    main(*sys.argv[1:])
