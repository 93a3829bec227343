"""Facts of a run: those of a card, and the table of runs."""

from __future__ import annotations

import sys
from collections.abc import Iterable, Mapping, Sequence

import numpy as np

from render.insights.loops import loops
from render.insights.stops import fastest
from render.magnitudes import effort_floor, travels
from render.report.space import facts_in_space
from render.report.written import Amounts, counted, degrees, moment, speed, written
from shared.contract import AnyMotion, Motion, Motion3, Parts, read_motion, read_parts
from shared.contract.clearance import Clearance, read_clearance
from shared.stage.console import duration
from shared.stage.errors import UserError
from shared.stage.paths import Out

# Chooses the few numbers of a mechanism that fit into a line.


def facts(motion: AnyMotion, parts: Parts | None, clearance: Clearance | None) -> list[str]:
    """Return freedoms, time, speed, effort, reaction, transmission angle, mass and clearance.

    Speed is that of the fastest place; effort and reaction are the largest."""
    if isinstance(motion, Motion3):
        return facts_in_space(motion, parts) + _apart(clearance)
    span, amount = motion.time[-1] - motion.time[0], Amounts(motion)
    out = [f"{counted(motion.diagnostics.dof, 'degree')} of freedom"]
    out.append(f"repeats after {moment(motion.period)}" if motion.period else f"{moment(span)} of motion")
    name, most = fastest(motion)
    if amount.without_noise(most, "m/s"):
        out.append(f"{name} reaches {speed(most, travels(motion, name))}")
    forces = {name: float(np.hypot(joint.fx, joint.fy).max()) for name, joint in motion.joints.items()}
    largest = max(forces.values(), default=0.0)
    for name, driver in motion.drivers.items():
        effort = float(np.abs(driver.effort).max())
        if amount.without_noise(effort, driver.effort_unit):
            out.append(f"{name} up to {written(effort, driver.effort_unit)}")
    if not any(np.any(driver.effort) for driver in motion.drivers.values()):
        out += [f"{name} up to {size}" for name, size in _efforts(motion)[:2]]
    if amount.without_noise(largest, "N"):
        most = max(forces, key=lambda name: forces[name])
        out.append(f"largest reaction {written(largest, 'N')} at {most}")
    out += [f"transmission angle from {degrees(float(loop.transmission.min()))}" for loop in loops(motion)[:1]]
    moving = sum(body.mass for body in motion.bodies.values())
    if parts is not None:
        pieces = sum(len(body.pieces) for body in parts.bodies.values())
        out.append(f"{written(moving, 'kg')} moving, {counted(pieces, 'piece')}")
    return out + _apart(clearance)


def _apart(clearance: Clearance | None) -> list[str]:
    """Return the least gap in words; empty without a proof."""
    pairs = clearance.pairs if clearance is not None else []
    return [f"parts stay {written(min(pair.gap for pair in pairs), 'm')} apart"] if pairs else []


def _efforts(motion: Motion) -> list[tuple[str, str]]:
    """Return the peak efforts of forces that move the mechanism without a driver, most power first."""
    efforts = []
    for name, force in motion.forces.items():
        if force.drives and force.effort is not None and np.any(force.effort) and max(force.power) > 0:
            efforts.append((max(force.power), name, written(float(np.abs(force.effort).max()), force.effort_unit)))
    return [(name, size) for _, name, size in sorted(efforts, key=lambda entry: -entry[0])]


# The table at the end of ``make run-all``: ``python -m render overview`` reads from standard input what was run.

WIDTH = 120
"""Width of the table where no terminal has one (characters)."""
COLUMNS = ("mechanism", "time", "pieces", "peak speed", "peak effort", "least gap", "outcome")


def run(lines: Iterable[str] = sys.stdin) -> None:
    """Print the table, a line for each mechanism: name, seconds of its run, ``done`` or ``failed``."""
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
    """Return the words of a row.

    Results of a failed run are left out, because they may be of an earlier one.
    """
    name, seconds, outcome = line.split()
    numbers = _numbers(Out(name)) if outcome == "done" else [""] * 4
    return [name, duration(float(seconds)), *numbers, outcome]


def _numbers(out: Out) -> list[str]:
    """Return pieces, peak speed, peak effort, least gap; empty where a file is missing or cannot be read."""
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
        largest_effort(motion),
        "" if gap is None else written(gap, "m"),
    ]


def largest_effort(motion: Motion) -> str:
    """Return the largest force or torque of a driver, else of a force.

    Forces count where nothing is driven, or drivers push by nothing.
    """
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
    """Return whose it is, how much, 0 where that is rounding, and whether it is a force."""
    name = max(efforts, key=lambda key: float(np.abs(efforts[key][0]).max()))
    effort, pushes = efforts[name]
    most = float(np.abs(effort).max())
    return name, most if most > effort_floor(motion, pushes) else 0.0, pushes
