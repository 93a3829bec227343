"""The table of docs/benchmarks.md, written between its two markers from the rows of the last run."""

from __future__ import annotations

from collections.abc import Sequence

from benchmarks.rows import Row
from shared.files import write_bytes
from shared.paths import ROOT

PAGE = ROOT / "docs" / "benchmarks.md"
BEGIN, END = "<!-- rows of make bench -->", "<!-- end of rows -->"


def write(rows: Sequence[Row]) -> None:
    """Replace the table in the page."""
    page = PAGE.read_text()
    before, _, rest = page.partition(BEGIN)
    _, _, after = rest.partition(END)
    write_bytes(PAGE, f"{before}{BEGIN}\n{text(rows)}\n{END}{after}".encode())


def text(rows: Sequence[Row]) -> str:
    """The rows as a table; films are left to their own section."""
    lines = ["| problem | code | version | time | times mbsd | error | settings |", "|---|---|---|---|---|---|---|"]
    own = {row.problem: row.seconds for row in rows if row.code == "mbsd"}
    for row in rows:
        if row.problem.startswith("film"):
            continue
        ratio = f"{row.seconds / own[row.problem]:.3g}" if row.problem in own else ""
        time = f"{row.seconds * 1000:.3g} ms"
        lines.append(
            f"| {row.problem} | {row.code} | {row.version} | {time} | {ratio} | {row.error:.1e} | {row.settings} |"
        )
    return "\n".join(lines)
