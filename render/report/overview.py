"""The table at the end of ``make run-all``: ``python -m render overview`` reads from standard input what was run."""

from __future__ import annotations

import sys
from collections.abc import Iterable, Mapping, Sequence

import numpy as np

from render.magnitudes import effort_floor
from render.report.facts import fastest
from render.report.written import Amounts, written
from shared.contract import Motion, read_motion, read_parts
from shared.contract.clearance import read_clearance
from shared.stage.console import duration
from shared.stage.errors import UserError
from shared.stage.paths import Out

WIDTH = 120
"""Width of the table where no terminal has one (characters)."""
COLUMNS = ("mechanism", "time", "pieces", "peak speed", "peak effort", "least gap", "outcome")


def run(lines: Iterable[str] = sys.stdin) -> None:
    """Print the table; each line has a mechanism's name, the seconds its run took, and ``done`` or ``failed``."""
    from rich.box import SIMPLE
    from rich.console import Console
    from rich.table import Table

    console = Console(width=None if sys.stdout.isatty() else WIDTH)
    table = Table(box=SIMPLE)
    for column in COLUMNS:
        table.add_column(column, justify="right" if column in ("time", "pieces") else "left", overflow="fold")
    for row in map(row_of, lines):
        table.add_row(*row, style="red" if row[-1] == "failed" else "")
    console.print(table)


def row_of(line: str) -> list[str]:
    """The words of a row. Results of a failed run are left out, because they may be of an earlier one."""
    name, seconds, outcome = line.split()
    numbers = _numbers(Out(name)) if outcome == "done" else [""] * 4
    return [name, duration(float(seconds)), *numbers, outcome]


def _numbers(out: Out) -> list[str]:
    """Pieces, peak speed, peak effort, least gap; empty where a file is missing or cannot be read."""
    try:
        motion = read_motion(out.motion, out.name)
        parts = read_parts(out.parts, out.name)
        clearance = read_clearance(out.clearance)
    except (UserError, OSError):
        return [""] * 4
    name, speed = fastest(motion)
    gap = min((pair.gap for pair in clearance.pairs), default=None)
    return [
        str(sum(len(solids.pieces) for solids in parts.bodies.values())),
        f"{written(speed, 'm/s')} ({name})" if Amounts(motion).without_noise(speed, "m/s") else "",
        _effort(motion),
        "" if gap is None else written(gap, "m"),
    ]


def _effort(motion: Motion) -> str:
    """The largest force or torque of a driver; of forces where nothing is driven, or drivers push by nothing."""
    drivers = {name: (driver.effort, driver.effort_unit == "N") for name, driver in motion.drivers.items()}
    forces = {
        name: (force.effort, force.effort_unit == "N")
        for name, force in motion.forces.items()
        if force.effort is not None
    }
    largest_of = [_largest(efforts, motion) for efforts in (drivers, forces) if efforts]
    if not largest_of:
        return ""
    name, most, pushes = next((largest for largest in largest_of if largest[1] > 0.0), largest_of[0])
    return f"{written(most, 'N' if pushes else 'N m')} ({name})"


def _largest(efforts: Mapping[str, tuple[Sequence[float], bool]], motion: Motion) -> tuple[str, float, bool]:
    """Whose it is, how much, 0 where that is rounding, and whether it is a force."""
    name = max(efforts, key=lambda key: float(np.abs(efforts[key][0]).max()))
    effort, pushes = efforts[name]
    most = float(np.abs(effort).max())
    return name, most if most > effort_floor(motion, pushes) else 0.0, pushes
