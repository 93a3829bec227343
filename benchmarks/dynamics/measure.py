"""Rows of the dynamics problems: every code at its stored settings, in rounds, one process a run."""

from __future__ import annotations

import json

from benchmarks.dynamics import BARS, CODES
from benchmarks.dynamics.problems import problem
from benchmarks.dynamics.search import SETTINGS, run_apart
from benchmarks.rows import Row
from shared.console import say

ROUNDS = 3


def measured() -> tuple[list[Row], list[str]]:
    """Rows of all codes on all problems, the best of the rounds, and the bars missed."""
    chosen = json.loads(SETTINGS.read_text())
    rows: list[Row] = []
    missed: list[str] = []
    for name in BARS:
        best: dict[str, Row] = {}
        for _ in range(ROUNDS):
            for code in CODES:
                settings = chosen.get(code, {}).get(name)
                if settings is None:
                    continue
                found = run_apart(code, name, settings)
                if "unfit" in found:
                    say("bench", f"{code} on {name}: {found['unfit']}")
                    continue
                task = problem(name)
                error = found["drift"] if name == "A01" else found["error"]
                words = ", ".join(f"{key} {value}" for key, value in settings.items())
                if task.loops:
                    words += f"; energy within {found['drift']:.1e} J"
                row = Row(name, code, found["version"], words, found["seconds"], error)
                best[code] = min(best.get(code, row), row, key=lambda r: r.seconds)
        rows += best.values()
        missed += _missed(name, best)
        say("bench", f"{name} done")
    return rows, missed


def _missed(name: str, best: dict[str, Row]) -> list[str]:
    peers = [row for code, row in best.items() if code != "mbsd"]
    if "mbsd" not in best or not peers:
        return [f"{name}: no valid result"]
    fastest = min(peers, key=lambda row: row.seconds)
    ratio = fastest.seconds / best["mbsd"].seconds
    return [] if ratio >= BARS[name] else [f"{name}: {fastest.code} {ratio:.1f}x, wanted {BARS[name]:g}x"]
