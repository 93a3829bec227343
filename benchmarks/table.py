"""The tables of the last run: what was asked for in docs/benchmarks.md, every row in out/bench.md."""

from __future__ import annotations

import math
from collections.abc import Sequence

from benchmarks.rows import Bar, Row
from shared.stage.files import write_bytes
from shared.stage.paths import out_root
from tools.documents.pages import DOCS, replaced

PAGE = DOCS / "benchmarks.md"
BEGIN, END = "<!-- rows of make bench -->", "<!-- end of rows -->"


def write(rows: Sequence[Row], bars: Sequence[Bar]) -> None:
    """Replace the table in the page, and write out/bench.md."""
    write_bytes(PAGE, replaced(PAGE.read_text(), BEGIN, END, bars_table(rows, bars)).encode())
    write_bytes(out_root() / "bench.md", f"# Every row of the last run\n\n{rows_table(rows)}\n".encode())


def bars_table(rows: Sequence[Row], bars: Sequence[Bar]) -> str:
    """Return what was asked for and reached, with the time of mbsd where a problem has one such row."""
    lines = ["| problem | mbsd | asked for | reached | against | its settings | met |", "|---|--:|---|---|---|---|---|"]
    for bar in bars:
        wanted = f"at most {bar.wanted:g}" if bar.most else f"{bar.wanted:g}x"
        reached = f"{bar.reached:.3g}{'' if bar.most else 'x'}"
        met = "yes" if bar.met else "**no**"
        own = [_time(row) for row in rows if row.code == "mbsd" and row.problem == bar.problem]
        cells = (bar.problem, own[0] if len(own) == 1 else "", wanted, reached, bar.peer, bar.settings, met)
        lines.append(f"| {' | '.join(cells)} |")
    return "\n".join(lines)


def rows_table(rows: Sequence[Row]) -> str:
    """Return every code on every problem; films are left to their own section."""
    lines = ["| problem | code | version | time | times mbsd | errors | settings |", "|---|---|---|---|---|---|---|"]
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
        cells = (row.problem, row.code, row.version, _time(row), ratio, errors, row.settings)
        lines.append(f"| {' | '.join(cells)} |")
    return "\n".join(lines)


def _time(row: Row) -> str:
    return f"{row.seconds * 1000:.3g} ms"
