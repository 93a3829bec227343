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
    """Results as they come.

    ``states`` are all that a solution can have, ``wrong`` those that a hunt looks for, and reasons of ``counted`` ones
    are counted.
    """

    def __init__(
        self,
        schema: str = "mbsd.hunt",
        states: tuple[str, ...] = STATES,
        wrong: tuple[str, ...] = (WRONG, HUNG),
        counted: tuple[str, ...] = (REFUSED, UNCLEAR),
    ) -> None:
        self.schema, self.states, self.wrong = schema, states, wrong
        self.cases: Counter[str] = Counter()
        self.seconds: dict[str, float] = defaultdict(float)
        self.slowest = (0.0, 0)
        self.families: dict[str, Counter[str]] = defaultdict(Counter)
        self.variations: dict[str, Counter[str]] = defaultdict(Counter)
        self.reasons: dict[str, Counter[str]] = {state: Counter() for state in counted}
        self.findings: list[tuple[CaseResult, Outcome]] = []

    def add(self, result: CaseResult) -> list[Outcome]:
        """Count one more case and return what it found."""
        wrong = [outcome for outcome in result.outcomes if outcome.state in self.wrong]
        self.findings += [(result, outcome) for outcome in wrong]
        self.cases[result.family] += 1
        self.seconds[result.family] += result.seconds
        self.slowest = max(self.slowest, (result.seconds, result.seed))
        for outcome in result.outcomes:
            self.families[result.family][outcome.state] += 1
            self.variations[outcome.variation][outcome.state] += 1
            if outcome.state in self.reasons:
                self.reasons[outcome.state][outcome.reason] += 1
        return wrong

    def count(self, state: str) -> int:
        """Return the number of solutions with this state."""
        return sum(states[state] for states in self.families.values())

    def cases_that(self, state: str) -> int:
        """Return the number of cases with at least one such finding."""
        return len({result.seed for result, outcome in self.findings if outcome.state == state})

    def document(self, seed: int, n: int, seconds: float) -> dict[str, Any]:
        """Return all of it as plain data."""
        return {
            "schema": self.schema,
            "schema_version": 2,
            "seed": seed,
            "n": n,
            "cases": sum(self.cases.values()),
            "seconds": round(seconds, 1),
            "slowest": {"seed": self.slowest[1], "seconds": round(self.slowest[0], 1)},
            "solutions": {state: self.count(state) for state in self.states},
            "found_cases": {state: self.cases_that(state) for state in self.wrong},
            "kinds": {
                name: {"cases": self.cases[name], "seconds": round(self.seconds[name], 2)} | dict(self.families[name])
                for name in sorted(self.cases)
            },
            "variations": {name: dict(self.variations[name]) for name in sorted(self.variations)},
            "reasons": {state: dict(counts.most_common()) for state, counts in self.reasons.items()},
            "findings": [
                {"seed": result.seed, "kind": result.family} | asdict(outcome) for result, outcome in self._sorted()
            ],
        }

    def write(self, path: Path, seed: int, n: int, seconds: float) -> None:
        """Write the JSON, whole."""
        path.parent.mkdir(parents=True, exist_ok=True)
        write_bytes(path, json.dumps(self.document(seed, n, seconds), indent=1).encode() + b"\n")

    def show(self, seconds: float) -> None:
        """Print tables and findings."""
        from rich.console import Console

        console = Console(width=None if Console().is_terminal else 140, highlight=False, soft_wrap=True)
        families: dict[str, Counter[str]] = defaultdict(Counter)
        cases: Counter[str] = Counter()
        for name, states in self.families.items():
            families[_group(name)].update(states)
            cases[_group(name)] += self.cases[name]
        console.print(self._table("kind of mechanism", families, cases))
        if len(self.variations) > 1:
            console.print(self._table("variation", self.variations, None))
        for state, counts in self.reasons.items():
            for reason, count in counts.most_common():
                console.print(f"{state} {count:6d}  {reason}", markup=False)
        for result, outcome in self._sorted()[:SHOWN]:
            console.print(
                f"{outcome.state}: case {result.seed} ({result.family}), {outcome.variation}: {outcome.reason}: "
                f"{outcome.detail}",
                markup=False,
            )
        if len(self.findings) > SHOWN:
            console.print(f"... and {len(self.findings) - SHOWN} more")
        sums = ", ".join(f"{state} {self.count(state)} (in {self.cases_that(state)} cases)" for state in self.wrong)
        console.print(
            f"{sum(self.cases.values())} cases, {sum(map(self.count, self.states))} solutions in {duration(seconds)}, "
            f"the slowest {self.slowest[1]} in {self.slowest[0]:.0f} s: {sums}"
        )

    def _sorted(self) -> list[tuple[CaseResult, Outcome]]:
        return sorted(self.findings, key=lambda finding: finding[0].seed)

    def _table(self, title: str, rows: dict[str, Counter[str]], cases: Counter[str] | None):
        from rich.table import Table

        table = Table(title, *(["cases"] if cases else []), *self.states)
        for column in table.columns[1:]:
            column.justify = "right"
        total: Counter[str] = Counter()
        for name in sorted(rows):
            own = [str(cases[name])] if cases else []
            table.add_row(name, *own, *(str(rows[name][state]) for state in self.states))
            total.update(rows[name])
        own = [str(sum(cases.values()))] if cases else []
        table.add_row("all", *own, *(str(total[state]) for state in self.states), style="bold")
        return table


def _group(name: str) -> str:
    """Return one name for examples of the registries: joints, drivers, forces, contacts, laws each."""
    return " ".join(name.split()[:3]) + "s" if name.startswith("example of") else name
