"""Facts of a run: those of a card, the table of runs, and reasons for a moment."""

from __future__ import annotations

import sys
from collections.abc import Iterable, Iterator, Mapping, Sequence

import numpy as np

from render.film.story.frame import Kind, Reason
from render.magnitudes import effort_floor, force_scale
from render.report.transmission import FEW, loops
from render.report.written import Amounts, counted, degrees, first_peak, moment, speed, written
from shared.contract import BodyMotion, Motion, Parts, read_motion, read_parts
from shared.contract.clearance import Clearance, read_clearance
from shared.stage.console import duration
from shared.stage.errors import UserError
from shared.stage.paths import Out

# Chooses the few numbers of a mechanism that fit into a line.


def facts(motion: Motion, parts: Parts | None, clearance: Clearance | None) -> list[str]:
    """Return freedoms, time, speed, effort, reaction, transmission angle, mass and clearance.

    Speed is that of the fastest place; effort and reaction are the largest."""
    span, amount = motion.time[-1] - motion.time[0], Amounts(motion)
    out = [f"{counted(motion.diagnostics.dof, 'degree')} of freedom"]
    out.append(f"repeats after {moment(motion.period)}" if motion.period else f"{moment(span)} of motion")
    name, most = fastest(motion)
    if amount.without_noise(most, "m/s"):
        out.append(f"{name} reaches {speed(most)}")
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
    if clearance is not None and clearance.pairs:
        out.append(f"parts stay {written(min(pair.gap for pair in clearance.pairs), 'm')} apart")
    return out


def fastest(motion: Motion) -> tuple[str, float]:
    """Return the fastest traced point, joint or body (by its centre of mass), and its speed (m/s)."""
    speeds = {name: _speed_of(body) for name, body in motion.bodies.items()}
    speeds |= {name: float(np.hypot(point.vx, point.vy).max()) for name, point in motion.points.items()}
    speeds |= {name: v for name, v in _joint_speeds(motion).items() if name not in speeds}
    name = max(speeds, key=lambda entry: speeds[entry])
    return name, speeds[name]


def _speed_of(body: BodyMotion) -> float:
    """Return the speed of its centre of mass (m/s)."""
    (x, y), omega, theta = body.com, np.array(body.omega), np.array(body.theta)
    vx = np.array(body.vx) - omega * (np.sin(theta) * x + np.cos(theta) * y)
    vy = np.array(body.vy) + omega * (np.cos(theta) * x - np.sin(theta) * y)
    return float(np.hypot(vx, vy).max())


def _efforts(motion: Motion) -> list[tuple[str, str]]:
    """Return the peak efforts of forces that move the mechanism without a driver, most power first."""
    efforts = []
    for name, force in motion.forces.items():
        if force.drives and force.effort is not None and np.any(force.effort) and max(force.power) > 0:
            efforts.append((max(force.power), name, written(float(np.abs(force.effort).max()), force.effort_unit)))
    return [(name, size) for _, name, size in sorted(efforts, key=lambda entry: -entry[0])]


def _joint_speeds(motion: Motion) -> dict[str, float]:
    """Return speeds of the second markers of joints, from their bodies' frames (m/s)."""
    out = {}
    for name, joint in motion.joints.items():
        body = motion.bodies.get(joint.bodies[1])
        if body is None:
            continue
        omega = np.array(body.omega)
        vx = np.array(body.vx) - omega * (np.array(joint.y) - np.array(body.y))
        vy = np.array(body.vy) + omega * (np.array(joint.x) - np.array(body.x))
        out[name] = float(np.hypot(vx, vy).max())
    return out


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


# Reasons to stop in a story: impacts, dead points, events, and the peaks of efforts, reactions and speeds.

LEVEL = 0.02
"""A quantity that changes by less than this part of its largest has no peak that is worth a stop."""
EDGE = 0.02
"""Part of a motion without a period at its start: a stop there has nothing before it, and comes after others."""


def reasons(motion: Motion) -> list[Reason]:
    """Return all of them; the best first: what happens once, then what is largest."""
    everything = [
        *(*_impacts(motion), *_dead_points(motion), *_events(motion)),
        *(*_effort_peaks(motion), *_reactions(motion), *_speeds(motion)),
    ]
    if motion.period is not None:
        return everything
    start, span = motion.time[0], motion.time[-1] - motion.time[0]
    return sorted(everything, key=lambda reason: reason.time - start < EDGE * span)


def _impacts(motion: Motion) -> Iterator[Reason]:
    """Yield the hardest impact of each contact, the hardest of all first."""
    hardest: dict[str, tuple[float, float]] = {}
    for event in motion.events:
        if event.what == "impact" and abs(event.impulse) > hardest.get(event.name, (0.0, 0.0))[0]:
            hardest[event.name] = abs(event.impulse), event.time
    for name, (impulse, at) in sorted(hardest.items(), key=lambda entry: -entry[1][0]):
        unit = motion.contacts[name].effort_unit if name in motion.contacts else "N"
        yield _reason(motion, at, "impact", name, written(impulse, f"{unit} s"), (f"{name}: impact",))


def _dead_points(motion: Motion) -> Iterator[Reason]:
    """Yield where followers of cranks turn back, the one with the largest reaction first."""
    time = np.asarray(motion.time)
    rows = [(at, loop.follower) for loop in loops(motion) for at, _ in loop.dead_points(time)]
    if len(rows) > FEW:
        rows = rows[:2]  # of a crank that turns and turns, those of its first turn
    for at, follower in sorted(rows, key=lambda row: -_carried(motion, row[0])[1]):
        yield _reason(motion, at, "turns_back", follower, "", (f"{follower} turns back",))


def _events(motion: Motion) -> Iterator[Reason]:
    """Yield other events, in their order."""
    for event in motion.events:
        if event.what not in ("end", "impact"):
            yield _reason(
                motion, event.time, "event", f"{event.name}: {event.what}", "", (f"{event.name}: {event.what}",)
            )


def _effort_peaks(motion: Motion) -> Iterator[Reason]:
    """Yield peaks of drivers and of forces that drive, those that give or take most power first."""
    rows = []
    for name, load in (*motion.drivers.items(), *motion.forces.items()):
        if load.effort is None or (name in motion.forces and not motion.forces[name].drives):
            continue
        size = np.abs(np.asarray(load.effort, float))
        if size.max() > effort_floor(motion, load.effort_unit == "N") and np.ptp(size) > LEVEL * size.max():
            k = first_peak(size)
            amount = written(float(size[k]), load.effort_unit)
            rows.append((-float(np.abs(load.power).max()), name, float(motion.time[k]), amount))
    for _, name, at, amount in sorted(rows):
        yield _reason(motion, at, "effort", name, amount, (name,))


def _reactions(motion: Motion) -> Iterator[Reason]:
    """Yield peaks of joints, the largest first."""
    floor, rows = 1e-6 * force_scale(motion), []
    for name, joint in motion.joints.items():
        size = np.hypot(joint.fx, joint.fy)
        if size.max() > floor and np.ptp(size) > LEVEL * size.max():
            k = first_peak(size)
            rows.append((-float(size[k]), name, float(motion.time[k])))
    for least, name, at in sorted(rows):
        yield _reason(motion, at, "reaction", name, written(-least, "N"), (name,))


def _speeds(motion: Motion) -> Iterator[Reason]:
    """Yield the fastest of all, and every traced point at its fastest."""
    name, most = fastest(motion) if motion.bodies else ("", 0.0)
    sizes = {point: np.hypot(p.vx, p.vy) for point, p in motion.points.items()}
    if name and name not in sizes and most > 1e-9:
        place = motion.bodies.get(name) or motion.joints[name]
        time = np.asarray(motion.time)
        rates = [np.gradient(np.asarray(part), np.maximum.accumulate(time + 1e-12 * np.arange(len(time))))
                 for part in (place.x, place.y)]  # fmt: skip
        sizes = {name: np.hypot(*rates), **sizes}
    for point, size in sizes.items():
        if size.max() > 1e-9 and np.ptp(size) > LEVEL * size.max():
            k = first_peak(size)
            amount = speed(most if point == name else float(size[k]))
            yield _reason(motion, float(motion.time[k]), "speed", point, amount, (point,))


def _reason(motion: Motion, at: float, kind: Kind, name: str, amount: str, words: tuple[str, ...]) -> Reason:
    joint, force = _carried(motion, at)
    known = force > 1e-9 * max(force_scale(motion), 1e-300)
    return Reason(float(at), kind, name, amount, joint if known else "", written(force, "N") if known else "", words)


def _carried(motion: Motion, at: float) -> tuple[str, float]:
    """Return the joint that carries most at a time, and how much (N)."""
    sizes = {
        name: float(np.interp(at, motion.time, np.hypot(joint.fx, joint.fy))) for name, joint in motion.joints.items()
    }
    name = max(sizes, key=lambda joint: sizes[joint], default="")
    return name, sizes.get(name, 0.0)
