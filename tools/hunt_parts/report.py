"""Counts of a hunt for parts: a table for people, JSON for programs."""

from __future__ import annotations

import json
from collections import Counter, defaultdict
from pathlib import Path
from typing import Any

from shared.stage.console import duration
from shared.stage.files import write_bytes
from tools.hunt.outcome import CaseResult, Outcome
from tools.hunt_parts.outcome import BUILT, REFUSED, STATES, WRONG


class Tally:
    """Results as they come."""

    def __init__(self) -> None:
        self.kinds: dict[str, Counter[str]] = defaultdict(Counter)
        self.reasons: Counter[str] = Counter()
        self.built: Counter[str] = Counter()
        self.slowest = (0.0, 0)
        self.findings: list[tuple[CaseResult, Outcome]] = []

    def add(self, result: CaseResult) -> Outcome:
        """One more case; what came of it."""
        outcome = result.outcomes[-1]
        self.kinds[result.family][outcome.state] += 1
        self.slowest = max(self.slowest, (result.seconds, result.seed))
        if outcome.state == REFUSED:
            self.reasons[outcome.reason] += 1
        elif outcome.state == BUILT:
            self.built[outcome.reason] += 1
        elif outcome.state in WRONG:
            self.findings.append((result, outcome))
        return outcome

    def count(self, *states: str) -> int:
        """Cases that came out so."""
        return sum(counts[state] for counts in self.kinds.values() for state in states)

    def document(self, seed: int, n: int, seconds: float) -> dict[str, Any]:
        """All of it as plain data."""
        return {
            "schema": "mbsd.hunt_parts",
            "schema_version": 1,
            "seed": seed,
            "n": n,
            "seconds": round(seconds, 1),
            "cases": {state: self.count(state) for state in STATES},
            "built": dict(self.built.most_common()),
            "refusals": dict(self.reasons.most_common()),
            "slowest": {"seed": self.slowest[1], "seconds": round(self.slowest[0], 1)},
            "kinds": {name: dict(self.kinds[name]) for name in sorted(self.kinds)},
            "findings": [
                {
                    "seed": result.seed,
                    "kind": result.family,
                    "state": finding.state,
                    "reason": finding.reason,
                    "detail": finding.detail,
                }
                for result, finding in sorted(self.findings, key=lambda both: both[0].seed)
            ],
        }

    def write(self, path: Path, seed: int, n: int, seconds: float) -> None:
        """The JSON, whole."""
        path.parent.mkdir(parents=True, exist_ok=True)
        write_bytes(path, json.dumps(self.document(seed, n, seconds), indent=1).encode() + b"\n")

    def show(self, seconds: float) -> None:
        """Tables and findings."""
        from rich.console import Console
        from rich.table import Table

        console = Console(width=None if Console().is_terminal else 140, highlight=False, soft_wrap=True)
        table = Table("kind of mechanism", *STATES)
        for column in table.columns[1:]:
            column.justify = "right"
        for name in sorted(self.kinds):
            table.add_row(name, *(str(self.kinds[name][state]) for state in STATES))
        table.add_row("all", *(str(self.count(state)) for state in STATES), style="bold")
        console.print(table)
        for title, counts in ((BUILT, self.built), (REFUSED, self.reasons)):
            for reason, count in counts.most_common():
                console.print(f"{title} {count:5d}  {reason}", markup=False)
        for result, finding in sorted(self.findings, key=lambda both: both[0].seed):
            console.print(f"{finding.state}: case {result.seed} ({result.family}): {finding.detail}", markup=False)
        slowest, seed = self.slowest
        console.print(f"{self.count(*STATES)} cases in {duration(seconds)}, the slowest {seed} in {slowest:.0f} s")
