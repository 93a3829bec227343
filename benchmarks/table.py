"""The tables of docs/benchmarks.md, written between its two markers from the rows of the last run."""

from __future__ import annotations

import math
from collections.abc import Sequence

from benchmarks.rows import Bar, Row
from shared.stage.files import write_bytes
from tools.documents.pages import DOCS, replaced

PAGE = DOCS / "benchmarks.md"
BEGIN, END = "<!-- rows of make bench -->", "<!-- end of rows -->"


def write(rows: Sequence[Row], bars: Sequence[Bar]) -> None:
    """Replace the tables in the page."""
    write_bytes(PAGE, replaced(PAGE.read_text(), BEGIN, END, text(rows, bars)).encode())


def text(rows: Sequence[Row], bars: Sequence[Bar]) -> str:
    """What was asked for, then all rows; films are left to their own section."""
    lines = ["| problem | asked for | reached | against | its settings | met |", "|---|---|---|---|---|---|"]
    for bar in bars:
        wanted = f"at most {bar.wanted:g}" if bar.most else f"{bar.wanted:g}x"
        times = "" if bar.most else "x"
        met = "yes" if bar.met else "**no**"
        lines.append(f"| {bar.problem} | {wanted} | {bar.reached:.3g}{times} | {bar.peer} | {bar.settings} | {met} |")
    lines += [
        "",
        "| problem | code | version | time | times mbsd | errors | settings |",
        "|---|---|---|---|---|---|---|",
    ]
    own: dict[str, float] = {}
    for row in rows:
        if row.code == "mbsd":  # the fastest, where it goes several ways
            own[row.problem] = min(row.seconds, own.get(row.problem, row.seconds))
    for row in rows:
        if row.problem.startswith("film"):
            continue
        ratio = f"{row.seconds / own[row.problem]:.3g}" if row.problem in own else ""
        known = "" if math.isnan(row.error) else f"{row.error:.1e}"
        errors = ", ".join(f"{name} {value:.1e}" for name, value in row.errors.items()) or known
        errors += "" if row.within_limits else "; **beyond the limits**"
        time = f"{row.seconds * 1000:.3g} ms"
        lines.append(f"| {row.problem} | {row.code} | {row.version} | {time} | {ratio} | {errors} | {row.settings} |")
    return "\n".join(lines)
