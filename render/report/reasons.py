"""What a story may stop for: impacts, dead points, events, and the peaks of efforts, reactions and speeds."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from render.film.story.reason import Kind, Reason
from render.magnitudes import effort_floor, force_scale
from render.report.facts import fastest
from render.report.moments import FEW
from render.report.transmission import loops
from render.report.written import first_peak, speed, written
from shared.contract import Motion

LEVEL = 0.02
"""A quantity that changes by less than this part of its largest has no peak that is worth a stop."""
EDGE = 0.02
"""Part of a motion without a period at its start: a stop there has nothing before it, and comes after others."""


def reasons(motion: Motion) -> list[Reason]:
    """All of them; the best first: what happens once, then what is largest."""
    everything = [*_impacts(motion), *_dead_points(motion), *_events(motion), *_efforts(motion), *_reactions(motion),
                  *_speeds(motion)]  # fmt: skip
    if motion.period is not None:
        return everything
    start, span = motion.time[0], motion.time[-1] - motion.time[0]
    return sorted(everything, key=lambda reason: reason.time - start < EDGE * span)


def _impacts(motion: Motion) -> Iterator[Reason]:
    """The hardest impact of each contact, the hardest of all first."""
    hardest: dict[str, tuple[float, float]] = {}
    for event in motion.events:
        if event.what == "impact" and abs(event.impulse) > hardest.get(event.name, (0.0, 0.0))[0]:
            hardest[event.name] = abs(event.impulse), event.time
    for name, (impulse, at) in sorted(hardest.items(), key=lambda entry: -entry[1][0]):
        unit = motion.contacts[name].effort_unit if name in motion.contacts else "N"
        yield _reason(motion, at, "impact", name, written(impulse, f"{unit} s"), (f"{name}: impact",))


def _dead_points(motion: Motion) -> Iterator[Reason]:
    """Where followers of cranks turn back, the one with the largest reaction first."""
    time = np.asarray(motion.time)
    rows = [(at, loop.follower) for loop in loops(motion) for at, _ in loop.dead_points(time)]
    if len(rows) > FEW:
        rows = rows[:2]  # of a crank that turns and turns, those of its first turn
    for at, follower in sorted(rows, key=lambda row: -_carried(motion, row[0])[1]):
        yield _reason(motion, at, "turns_back", follower, "", (f"{follower} turns back",))


def _events(motion: Motion) -> Iterator[Reason]:
    """Other events, in their order."""
    for event in motion.events:
        if event.what not in ("end", "impact"):
            yield _reason(
                motion, event.time, "event", f"{event.name}: {event.what}", "", (f"{event.name}: {event.what}",)
            )


def _efforts(motion: Motion) -> Iterator[Reason]:
    """Peaks of drivers and of forces that drive, those that give or take most power first."""
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
    """Peaks of joints, the largest first."""
    floor, rows = 1e-6 * force_scale(motion), []
    for name, joint in motion.joints.items():
        size = np.hypot(joint.fx, joint.fy)
        if size.max() > floor and np.ptp(size) > LEVEL * size.max():
            k = first_peak(size)
            rows.append((-float(size[k]), name, float(motion.time[k])))
    for least, name, at in sorted(rows):
        yield _reason(motion, at, "reaction", name, written(-least, "N"), (name,))


def _speeds(motion: Motion) -> Iterator[Reason]:
    """The fastest of all, and every traced point at its fastest."""
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
    """The joint that carries most at a time, and how much (N)."""
    sizes = {
        name: float(np.interp(at, motion.time, np.hypot(joint.fx, joint.fy))) for name, joint in motion.joints.items()
    }
    name = max(sizes, key=lambda joint: sizes[joint], default="")
    return name, sizes.get(name, 0.0)
