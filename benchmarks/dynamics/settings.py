"""The best settings of every code on every problem, settings.json: the quickest within the limits.

    python -m benchmarks.dynamics.settings CODE CASE        (all: python -m benchmarks tune)

Every ladder of the code's ``ladders`` is climbed from cheap to exact, three rungs at a time and then back over the two
between, until the limits are met or it takes longer than the best so far. The best few are timed again side by side.
Times are of the processor, so that other work on the machine disturbs them little. Prints one JSON object.
"""

from __future__ import annotations

import importlib
import json
import math
import os
import subprocess
import sys
import time
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from benchmarks.dynamics import CODES
from benchmarks.dynamics.cases import BESIDE_PEERS, Case, case
from benchmarks.harness import found_in
from shared.stage.console import say
from shared.stage.errors import UserError

FILE = Path(__file__).parent / "settings.json"
LONGEST = 1800.0
"""s, of the sweep of one code on one problem."""
STRIDE = 3
TOO_LONG = 1.3
"""Times the best so far."""
FINALISTS = 4
FINAL_RUNS = 7


def load() -> dict[str, dict[str, dict[str, Any]]]:
    """Problem name to code to what the sweep found."""
    return json.loads(FILE.read_text())


def words(settings: dict[str, Any]) -> str:
    """Words of a row."""
    return ", ".join(f"{name} {value}" for name, value in settings.items())


def tune_all(wanted: Sequence[str]) -> None:
    """Sweep anew the codes and problems named (all where none is), each pair in a process of its own."""
    codes = [code for code in CODES if code in wanted] or CODES
    problems = [name for name in BESIDE_PEERS if name in wanted] or BESIDE_PEERS
    unknown = set(wanted) - {*CODES, *BESIDE_PEERS}
    if unknown:
        raise UserError(f"bench: {', '.join(sorted(unknown))}? There is: {', '.join((*CODES, *BESIDE_PEERS))}")
    for name in problems:
        for code in codes:
            swept = _sweep(code, name)
            kept = load()
            kept.setdefault(name, {})[code] = swept
            write(kept)
            limits = "within" if swept["met"] else "NOT within"
            say(
                "tune", f"{name}, {code}: {1000 * swept['seconds']:.3g} ms, {limits} the limits, {swept['tried']} tried"
            )


def write(kept: dict[str, dict[str, dict[str, Any]]]) -> None:
    """In the order of problems and codes, one line a pair."""
    blocks = []
    for name in (n for n in BESIDE_PEERS if n in kept):
        lines = [f"  {json.dumps(code)}: {json.dumps(kept[name][code])}" for code in CODES if code in kept[name]]
        blocks.append(f" {json.dumps(name)}: {{\n" + ",\n".join(lines) + "\n }")
    FILE.write_text("{\n" + ",\n".join(blocks) + "\n}\n")


def _sweep(code: str, name: str) -> dict[str, Any]:
    command = [sys.executable, "-m", "benchmarks.dynamics.settings", code, name]
    try:
        done = subprocess.run(command, stdout=subprocess.PIPE, text=True, check=False, timeout=LONGEST)
    except subprocess.TimeoutExpired:
        raise UserError(f"bench: the sweep of {code} on {name} took more than {LONGEST:g} s") from None
    if done.returncode:
        raise UserError(f"bench: the sweep of {code} on {name} failed, see above")
    return found_in(done.stdout)


def steps_of(first: int, last: int, ratio: float = 1.15) -> list[int]:
    """Return numbers of steps from ``first`` to ``last``, in even ratios."""
    count = round(math.log(last / first) / math.log(ratio))
    return [round(first * ratio**k) for k in range(count + 1)]


def tolerances(first: float, last: float, per_decade: int = 3) -> list[float]:
    """Return tolerances from loose to tight, in even ratios."""
    count = round(math.log10(first / last) * per_decade)
    return [float(f"{first * 10 ** (-k / per_decade):.2g}") for k in range(count + 1)]


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
