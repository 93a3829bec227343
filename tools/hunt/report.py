"""Counts of a hunt: tables for people, JSON for programs."""

from __future__ import annotations

import json
from collections import Counter, defaultdict
from dataclasses import asdict
from pathlib import Path
from typing import Any

from shared.stage.console import duration
from shared.stage.files import write_bytes
from tools.hunt.outcome import HUNG, REFUSED, STATES, UNCLEAR, WRONG, CaseResult, Outcome

SHOWN = 20
"""Findings that the table names; the file has all."""


class Tally:
    """Results as they come."""

    def __init__(self) -> None:
        self.cases: Counter[str] = Counter()
        self.seconds: dict[str, float] = defaultdict(float)
        self.families: dict[str, Counter[str]] = defaultdict(Counter)
        self.variations: dict[str, Counter[str]] = defaultdict(Counter)
        self.reasons: Counter[str] = Counter()
        self.not_compared: Counter[str] = Counter()
        self.findings: list[tuple[CaseResult, Outcome]] = []

    def add(self, result: CaseResult) -> list[Outcome]:
        """One more case; what it found."""
        wrong = [outcome for outcome in result.outcomes if outcome.state in (WRONG, HUNG)]
        self.findings += [(result, outcome) for outcome in wrong]
        self.cases[result.family] += 1
        self.seconds[result.family] += result.seconds
        for outcome in result.outcomes:
            self.families[result.family][outcome.state] += 1
            self.variations[outcome.variation][outcome.state] += 1
            if outcome.state == REFUSED:
                self.reasons[outcome.reason] += 1
            elif outcome.state == UNCLEAR:
                self.not_compared[outcome.reason] += 1
        return wrong

    def count(self, state: str) -> int:
        """Solutions that came out so."""
        return sum(states[state] for states in self.families.values())

    def cases_that(self, state: str) -> int:
        """Cases with at least one such solution."""
        return len({result.seed for result, outcome in self.findings if outcome.state == state})

    def document(self, seed: int, n: int, seconds: float) -> dict[str, Any]:
        """All of it as plain data."""
        return {
            "schema": "mbsd.hunt",
            "schema_version": 1,
            "seed": seed,
            "n": n,
            "cases": sum(self.cases.values()),
            "seconds": round(seconds, 1),
            "solutions": {state: self.count(state) for state in STATES},
            "wrong_cases": self.cases_that(WRONG),
            "hung_cases": self.cases_that(HUNG),
            "kinds": {
                name: {"cases": self.cases[name], "seconds": round(self.seconds[name], 2)} | dict(self.families[name])
                for name in sorted(self.cases)
            },
            "variations": {name: dict(self.variations[name]) for name in sorted(self.variations)},
            "refusals": dict(self.reasons.most_common()),
            "not_compared": dict(self.not_compared.most_common()),
            "findings": [
                {"seed": result.seed, "kind": result.family} | asdict(outcome)
                for result, outcome in sorted(self.findings, key=lambda wrong: wrong[0].seed)
            ],
        }

    def write(self, path: Path, seed: int, n: int, seconds: float) -> None:
        """The JSON, whole."""
        path.parent.mkdir(parents=True, exist_ok=True)
        write_bytes(path, json.dumps(self.document(seed, n, seconds), indent=1).encode() + b"\n")

    def show(self, seconds: float) -> None:
        """Tables and findings."""
        from rich.console import Console

        console = Console(width=None if Console().is_terminal else 140, highlight=False, soft_wrap=True)
        console.print(self._table("kind of mechanism", self._grouped(), self._cases_grouped()))
        console.print(self._table("variation", self.variations, None))
        for title, counts in (("refused", self.reasons), ("not compared", self.not_compared)):
            for reason, count in counts.most_common():
                console.print(f"{title} {count:6d}  {reason}", markup=False)
        for result, outcome in sorted(self.findings, key=lambda wrong: wrong[0].seed)[:SHOWN]:
            console.print(
                f"{outcome.state}: case {result.seed} ({result.family}), {outcome.variation}: {outcome.reason}: "
                f"{outcome.detail}",
                markup=False,
            )
        if len(self.findings) > SHOWN:
            console.print(f"... and {len(self.findings) - SHOWN} more")
        cases = sum(self.cases.values())
        console.print(
            f"{cases} cases, {sum(map(self.count, STATES))} solutions in {duration(seconds)}: "
            f"wrong {self.count(WRONG)} (in {self.cases_that(WRONG)} cases), hung {self.count(HUNG)}"
        )

    def _grouped(self) -> dict[str, Counter[str]]:
        out: dict[str, Counter[str]] = defaultdict(Counter)
        for name, states in self.families.items():
            out[_group(name)].update(states)
        return out

    def _cases_grouped(self) -> Counter[str]:
        out: Counter[str] = Counter()
        for name, count in self.cases.items():
            out[_group(name)] += count
        return out

    def _table(self, title: str, rows: dict[str, Counter[str]], cases: Counter[str] | None):
        from rich.table import Table

        table = Table(title, *(["cases"] if cases else []), *STATES)
        for column in table.columns[1:]:
            column.justify = "right"
        total: Counter[str] = Counter()
        for name in sorted(rows):
            own = [str(cases[name])] if cases else []
            table.add_row(name, *own, *(str(rows[name][state]) for state in STATES))
            total.update(rows[name])
        own = [str(sum(cases.values()))] if cases else []
        table.add_row("all", *own, *(str(total[state]) for state in STATES), style="bold")
        return table


def _group(name: str) -> str:
    """Examples of the registries in one row for joints, drivers, forces, contacts, laws each."""
    return " ".join(name.split()[:3]) + "s" if name.startswith("example of") else name
