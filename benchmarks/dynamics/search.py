"""``python -m benchmarks.dynamics.search``: the fastest valid settings of every code, into settings.json.

Candidates go from cheap to dear; each runs once with few samples (the time) and once with many (the energy).
One that takes more than LONGEST seconds is not waited for.
"""

from __future__ import annotations

import importlib
import json
import subprocess
import sys
from pathlib import Path

from benchmarks.dynamics import BARS, CODES
from benchmarks.dynamics.problems import problem

SETTINGS = Path(__file__).parent / "settings.json"
SAMPLES = 1001
LONGEST = 60.0


def try_one(code: str, name: str, settings: dict) -> dict:
    """Seconds, energy change and angle error of one run; an ``unfit`` entry where it is not valid."""
    module = importlib.import_module(f"benchmarks.dynamics.{code}_code")
    task = problem(name)
    try:
        seconds, _, q, v = module.run(task, settings, 2)
        best = min(seconds, *(module.run(task, settings, 2)[0] for _ in range(3 if seconds < 1 else 1)))
        error = task.errors(q, v)[1]
        _, _, q, v = module.run(task, settings, SAMPLES)
        drift = task.errors(q, v)[0]
    except Exception as problem_found:
        return {"unfit": str(problem_found).strip().splitlines()[-1][:120] if str(problem_found) else "failed"}
    out = {"seconds": best, "drift": drift, "error": error, "version": module.VERSION}
    return out if task.valid(drift, error) else out | {"unfit": "beyond the limits"}


def candidates(code: str, name: str) -> list[dict]:
    """Settings to try."""
    return importlib.import_module(f"benchmarks.dynamics.{code}_code").CANDIDATES[name]


def main() -> None:
    """Search all, or the codes named on the command line."""
    chosen = json.loads(SETTINGS.read_text()) if SETTINGS.exists() else {}
    for code in sys.argv[1:] or CODES:
        for name in BARS:
            best, fastest = None, float("inf")
            for settings in candidates(code, name):
                found = run_apart(code, name, settings)
                print(code, name, settings, found, flush=True)
                if "unfit" not in found and found["seconds"] < fastest:
                    best, fastest = settings, found["seconds"]
            chosen.setdefault(code, {})[name] = best
            SETTINGS.write_text(json.dumps(chosen, indent=1) + "\n")


def run_apart(code: str, name: str, settings: dict) -> dict:
    """One run in a process of its own: a peer may crash."""
    command = [sys.executable, "-m", "benchmarks.dynamics.one", code, name, json.dumps(settings)]
    try:
        run = subprocess.run(command, capture_output=True, text=True, check=False, timeout=LONGEST)
    except subprocess.TimeoutExpired:
        return {"unfit": f"more than {LONGEST:g} s"}
    lines = run.stdout.strip().splitlines()
    return json.loads(lines[-1]) if run.returncode == 0 and lines else {"unfit": f"exit {run.returncode}"}


if __name__ == "__main__":
    main()
