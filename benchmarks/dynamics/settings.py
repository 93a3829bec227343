"""The best settings of every code on every problem, settings.json, ladders of settings, and the sweep over them."""

from __future__ import annotations

import json
import math
import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from benchmarks.dynamics import CODES
from benchmarks.dynamics.cases import BESIDE_PEERS
from benchmarks.harness import found_in
from shared.stage.console import say
from shared.stage.errors import UserError

FILE = Path(__file__).parent / "settings.json"
LONGEST = 1800.0
"""s, of the sweep of one code on one problem."""


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
    command = [sys.executable, "-m", "benchmarks.dynamics.tune", code, name]
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
