"""A row of a benchmark, out/bench.json, and tables on the console, in docs/ and in out/bench.md."""

from __future__ import annotations

import json
import math
from collections.abc import Sequence
from dataclasses import asdict, dataclass, field

import numpy as np

from shared.stage.console import markdown_table
from shared.stage.errors import UserError
from shared.stage.files import write_bytes
from shared.stage.paths import out_root
from tools.documents.pages import DOCS, replaced

PAGE = DOCS / "benchmarks.md"
BEGIN, END = "<!-- rows of make bench -->", "<!-- end of rows -->"


@dataclass(frozen=True)
class Row:
    """One code on one problem: seconds for the whole problem, error as the problem defines it."""

    problem: str
    code: str
    version: str
    settings: str
    seconds: float
    error: float
    errors: dict[str, float] = field(default_factory=dict)
    """All errors by name, where the problem has limits for them."""
    within_limits: bool = True


@dataclass(frozen=True)
class Bar:
    """The bar of a problem: at least ``wanted`` (at most, if ``most``), and what was reached.

    ``peer``: the code that it is reached against.
    """

    problem: str
    wanted: float
    reached: float
    peer: str
    settings: str
    met: bool
    most: bool = False

    def __str__(self) -> str:
        return f"{self.problem}: {self.reached:.2f}x {self.peer}, wanted {'at most ' * self.most}{self.wanted:g}x"


def write(rows: Sequence[Row], bars: Sequence[Bar]) -> None:
    """out/bench.json and out/bars.json, whole."""
    for name, entries in (("bench.json", rows), ("bars.json", bars)):
        text = json.dumps([asdict(row) for row in entries], indent=1, default=_plain) + "\n"
        write_bytes(out_root() / name, text.encode())


def _plain(value: object) -> object:
    """A scalar of numpy as Python's. Raises TypeError for anything else."""
    if isinstance(value, np.generic):
        return value.item()
    raise TypeError(f"{value!r} is no number of a benchmark")


def read() -> tuple[list[Row], list[Bar]]:
    """Rows of the last run."""
    try:
        documents = [json.loads((out_root() / name).read_text()) for name in ("bench.json", "bars.json")]
    except FileNotFoundError:
        raise UserError("bench: there is no run to make a table of; make bench") from None
    return [Row(**row) for row in documents[0]], [Bar(**bar) for bar in documents[1]]


def show_all(rows: Sequence[Row]) -> None:
    """Print rows of several problems, each problem with the time against the row of mbsd."""
    for problem in dict.fromkeys(row.problem for row in rows):
        own = [row for row in rows if row.problem == problem]
        base = next((row.seconds for row in own if row.code == "mbsd"), own[0].seconds)
        print(f"\n{problem}")
        for row in own:
            numbers = f"{1000 * row.seconds:>11.3f} ms{row.seconds / base:>9.2f}x{row.error:>10.1e}"
            beyond = "" if row.within_limits else "beyond the limits; "
            print(f"  {row.code:<18}{row.version:<10}{numbers}  {beyond}{row.settings}")


def write_tables(rows: Sequence[Row], bars: Sequence[Bar]) -> None:
    """Replace the table in the page, and write out/bench.md."""
    write_bytes(PAGE, replaced(PAGE.read_text(), BEGIN, END, bars_table(rows, bars)).encode())
    write_bytes(out_root() / "bench.md", f"# Every row of the last run\n\n{rows_table(rows)}\n".encode())


def bars_table(rows: Sequence[Row], bars: Sequence[Bar]) -> str:
    """Return what was asked for and reached, with the time of mbsd where a problem has one such row."""
    lines = []
    for bar in bars:
        wanted = f"at most {bar.wanted:g}" if bar.most else f"{bar.wanted:g}x"
        reached = f"{bar.reached:.3g}{'' if bar.most else 'x'}"
        met = "yes" if bar.met else "**no**"
        own = [_time(row) for row in rows if row.code == "mbsd" and row.problem == bar.problem]
        cells = (bar.problem, own[0] if len(own) == 1 else "", wanted, reached, bar.peer, bar.settings, met)
        lines.append(cells)
    head = ("problem", "mbsd", "asked for", "reached", "against", "its settings", "met")
    return "\n".join(markdown_table(head, lines, numbers=[1]))


def rows_table(rows: Sequence[Row]) -> str:
    """Return every code on every problem; films are left to their own section."""
    lines = []
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
        lines.append(cells)
    head = ("problem", "code", "version", "time", "times mbsd", "errors", "settings")
    return "\n".join(markdown_table(head, lines))


def _time(row: Row) -> str:
    return f"{row.seconds * 1000:.3g} ms"
