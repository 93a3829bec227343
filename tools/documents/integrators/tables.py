"""The two tables of docs/integrators.md, written between their markers from docs/integrators.json."""

from __future__ import annotations

from typing import Any

from tools.integrators.long_runs import RUNS

MARKERS = {
    "accuracy": ("<!-- order and cost -->", "<!-- end of order and cost -->"),
    "long": ("<!-- long runs -->", "<!-- end of long runs -->"),
}


def with_tables(page: str, measured: dict[str, Any]) -> str:
    """The page with its tables as they should be."""
    for part, text in (("accuracy", accuracy(measured["accuracy"])), ("long", long_runs(measured["long"]))):
        begin, end = MARKERS[part]
        before, mark, rest = page.partition(begin)
        if not mark or end not in rest:
            raise ValueError(f"the page has no '{begin}' ... '{end}'")
        page = f"{before}{begin}\n{text}\n{end}{rest.partition(end)[2]}"
    return page


def accuracy(rows: dict[str, dict[str, Any]]) -> str:
    """Order and cost."""
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


def long_runs(runs: dict[str, dict[str, Any]]) -> str:
    """Energy after all periods, and what it cost."""
    pendulum, four_bar = runs["pendulum"], runs["four-bar"]
    lines = [
        "| method | setting | energy error, pendulum | energy error, four-bar | evaluations a period | time, both |",
        "|---|---|---|---|---|---|",
    ]
    unit = sum(run["dop853"]["seconds"] for run in runs.values())
    for name, setting in RUNS.items():
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
