"""Rows of the dynamics problems: every code at its stored settings, in turn, one process a run, several rounds."""

from __future__ import annotations

import subprocess
import sys

from benchmarks.dynamics import CODES
from benchmarks.dynamics.cases import BESIDE_PEERS, case
from benchmarks.dynamics.settings import found_in, load, words
from benchmarks.rows import Bar, Row
from shared.stage.console import say
from shared.stage.errors import UserError
from shared.stage.paths import ROOT

ROUNDS = 3


def measured() -> tuple[list[Row], list[Bar]]:
    """Rows of all codes on all problems, the best of the rounds, and the bars."""
    rows: list[Row] = []
    bars: list[Bar] = []
    chosen = load()
    for name in BESIDE_PEERS:
        best: dict[str, Row] = {}
        for _ in range(ROUNDS):
            for code in CODES:
                if code in chosen.get(name, {}):
                    row = _once(code, name, words(chosen[name][code]["settings"]))
                    best[code] = min(best.get(code, row), row, key=lambda r: r.seconds)
        rows += best.values()
        if "mbsd" in best:
            bars.append(_bar(name, best))
        say("bench", f"{name} done")
    return rows, bars


def _once(code: str, name: str, settings: str) -> Row:
    run = subprocess.run(
        [sys.executable, "-m", "benchmarks.dynamics.once", code, name],
        cwd=ROOT, capture_output=True, text=True, check=False,
    )  # fmt: skip
    if run.returncode:
        raise UserError(f"bench: {code} on {name} failed: {(run.stderr.strip().splitlines() or ['no message'])[-1]}")
    record = found_in(run.stdout)
    main = list(case(name).limits)[-1]
    return Row(
        name,
        code,
        record["version"],
        settings,
        record["seconds"],
        record["errors"][main],
        record["errors"],
        record["met"],
    )


def _bar(name: str, best: dict[str, Row]) -> Bar:
    """Against the quickest peer that keeps the limits."""
    ours, wanted = best["mbsd"], case(name).bar
    peers = [row for code, row in best.items() if code != "mbsd" and row.within_limits]
    if not peers:
        return Bar(name, wanted, 0.0, "no peer was swept yet, or none keeps the limits", "", met=False)
    peer = min(peers, key=lambda row: row.seconds)
    ratio = peer.seconds / ours.seconds
    return Bar(name, wanted, ratio, peer.code, peer.settings, ours.within_limits and ratio >= wanted)
