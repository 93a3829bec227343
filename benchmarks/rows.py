"""A row of a benchmark, the table on the console, and out/bench.json."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import asdict, dataclass, field

import numpy as np

from shared.stage.errors import UserError
from shared.stage.files import write_bytes
from shared.stage.paths import out_root


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
    """Bar of a problem: at least ``wanted`` (at most, if ``most``), and what was reached against which peer."""

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
