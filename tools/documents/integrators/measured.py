"""Integrators measured: docs/integrators.json and the tables of docs/integrators.md (``make integrators``).

Orders and costs take two minutes, ten thousand periods by each method another three. The picture is drawn from the
numbers by figures/pages/integrators.py. Methods of packages that are not installed keep their old numbers.
"""

from __future__ import annotations

import json
from collections.abc import Sequence
from typing import Any

from tools.documents.integrators import accuracy, long_runs
from tools.documents.pages import DOCS, replaced

FILE = DOCS / "integrators.json"
ACCURACY = "<!-- order and cost -->", "<!-- end of order and cost -->"
LONG = "<!-- long runs -->", "<!-- end of long runs -->"


def main(words: Sequence[str]) -> None:
    """Measure all integrators and write the numbers and the tables."""
    kept = json.loads(FILE.read_text())["accuracy"] if FILE.exists() else {}
    measured = {"accuracy": kept | accuracy.measured(_report), "long": long_runs.measured(_report)}
    for runs in measured["long"].values():
        unit = runs["dop853"]["seconds"]
        for run in runs.values():
            run["seconds"] = float(f"{run['seconds'] / unit:.2g}")
    FILE.write_text(json.dumps(measured, indent=1) + "\n")
    page = DOCS / "integrators.md"
    page.write_text(with_tables(page.read_text(), json.loads(json.dumps(measured))))


def _report(line: str) -> None:
    print(line, flush=True)


def with_tables(page: str, measured: dict[str, Any]) -> str:
    """Return the page with the tables of these numbers."""
    page = replaced(page, *ACCURACY, accuracy_table(measured["accuracy"]))
    return replaced(page, *LONG, long_table(measured["long"]))


def accuracy_table(rows: dict[str, dict[str, Any]]) -> str:
    """Return the table of orders and costs."""
    lines = [
        "| method | order | measured, pendulum | measured, four-bar | cost, four-bar | cost, stiff bush |",
        "|---|---|---|---|---|---|",
    ]
    for name, row in rows.items():
        stated = row["stated"] or "varies"
        costs = " | ".join(_ratio(*row[which]) for which in ("cost", "stiff cost"))
        lines.append(f"| `{name}` | {stated} | {row['pendulum']} | {row['four-bar']} | {costs} |")
    return "\n".join(lines)


def _ratio(value: float, reached: bool) -> str:
    text = f"{value:.0f}" if value >= 10 else f"{value:.2g}"
    return text if reached else f"over {text}" if value else "none"


def long_table(runs: dict[str, dict[str, Any]]) -> str:
    """Return the table of energy errors after all periods, and costs."""
    pendulum, four_bar = runs["pendulum"], runs["four-bar"]
    lines = [
        "| method | setting | energy error, pendulum | energy error, four-bar | evaluations a period | time, both |",
        "|---|---|---|---|---|---|",
    ]
    unit = sum(run["dop853"]["seconds"] for run in runs.values())
    for name, setting in long_runs.RUNS.items():
        setting_words = (
            f"{setting['steps']} steps a period" if "steps" in setting else f"tolerance {setting['tolerance']:.0e}"
        ).replace("e-0", "e-")
        first, other = pendulum[name], four_bar[name]
        seconds = (first["seconds"] + other["seconds"]) / unit
        lines.append(
            f"| `{name.partition(',')[0]}` | {setting_words} | {first['errors'][-1]:.0e} | {other['errors'][-1]:.0e} "
            f"| {first['evaluations']}, {other['evaluations']} | {seconds:.2g} |"
        )
    return "\n".join(lines)
