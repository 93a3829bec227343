"""The table of docs/engines.md: what each engine does at constant speed, and in a slow and a fast run-up.

``runs`` is the table (pandas) of the study.
"""

from __future__ import annotations

from typing import Any

BEGIN, END = "<!-- run-up: written by make study-run-up -->", "<!-- end of run-up -->"
DAMPING_RATIO = 0.1
RATES = (100.0, 2000.0)
"""rpm/s"""


def with_table(page: str, runs: Any) -> str:
    """The page with its table as it should be. Raises ValueError where its markers are missing."""
    before, mark, rest = page.partition(BEGIN)
    if not mark or END not in rest:
        raise ValueError(f"the page has no '{BEGIN}' ... '{END}'")
    return f"{before}{BEGIN}\n{table(runs)}\n{END}{rest.partition(END)[2]}"


def table(runs: Any) -> str:
    """Largest displacement and angle with the speed at which they come, of the runs with one damping ratio."""
    rates = " | ".join(f"{rate:g} rpm/s" for rate in RATES)
    lines = [
        f"| engine | mounts | displacement, steady | {rates} | angle, steady | {rates} |",
        f"|{'---|' * (4 + 2 * len(RATES))}",
    ]
    shown = runs[runs["damping_ratio"] == DAMPING_RATIO]
    for (layout, frequency), rows in shown.groupby(["layout", "frequency"], sort=False):
        cells = [str(layout), f"{frequency:g} Hz"]
        at = rows.set_index("rate")
        for name, unit in (("displacement", "mm"), ("angle", "mrad")):
            cells.append(_cell(at.loc[RATES[0]], f"steady {name}", unit))
            cells += [_cell(at.loc[rate], name, unit) for rate in RATES]
        lines.append(f"| {' | '.join(cells)} |")
    return "\n".join(lines)


def _cell(row: Any, name: str, unit: str) -> str:
    return f"{row[name]:.3g} {unit} at {row[f'speed of {name}']:.0f}"
