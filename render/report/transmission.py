"""Transmission angles and events of a motion in sentences and tables."""

from __future__ import annotations

import math

import numpy as np

from render.insights.loops import LEAST, Loop, loops
from render.report.written import Amounts, degrees, listed, moment, table, written
from shared.contract import EventMark, Motion

# Transmission angle, dead points, stroke and Grashof's condition in sentences.

SAME = math.radians(1.0)
"""Dead points whose angles differ by less are one."""


def transmission_section(motion: Motion) -> list[str]:
    """Return the section on every four-bar and slider-crank in the mechanism."""
    lines: list[str] = []
    for loop in loops(motion):
        lines += [*_loop_lines(loop, np.array(motion.time)), ""]
    return lines[:-1]


def _different(dead: list[tuple[float, float]]) -> list[tuple[float, float]]:
    """Return the dead points of the first turn: later ones are at the same angles of the crank."""
    first: list[tuple[float, float]] = []
    for at, angle in dead:
        if all(abs(math.remainder(angle - other, 2 * math.pi)) > SAME for _, other in first):
            first.append((at, angle))
    return first


def _loop_lines(loop: Loop, time: np.ndarray) -> list[str]:
    mu = loop.transmission
    k = int(mu.argmin())
    kind = "slider-crank" if loop.slides else "four-bar"
    lines = [
        f"{loop.crank}, {loop.coupler} and {loop.follower} are a {kind}. Its transmission angle lies between "
        f"{degrees(mu.min())} (crank at {degrees(loop.angle[k] % (2 * math.pi))}, t = {moment(time[k])}) and "
        f"{degrees(mu.max())}"
        + (f"; {degrees(LEAST)} are usually asked for." if mu.min() < LEAST else ".")
    ]  # fmt: skip
    passed = loop.dead_points(time)
    dead = _different(passed)
    if dead:
        places = listed([f"{degrees(angle)} (t = {moment(at)})" for at, angle in dead[:4]])
        travel = written(loop.travel, "m") if loop.slides else degrees(loop.travel)
        does = f"strokes {travel}" if loop.slides else f"swings {travel}"
        lines.append(
            f"{loop.coupler} and {loop.crank} are in line with the crank at {places}: there the {loop.follower} turns "
            f"back, and could not drive. The {loop.follower} {does}."
        )
    else:
        lines.append(f"There is no dead point in this motion: {loop.crank} and {loop.coupler} are never in line.")
    if not loop.slides:
        short, *middle, long = sorted(loop.lengths)
        turns = (
            "some link can turn fully (Grashof)" if short + long <= sum(middle) else "no link can turn fully (Grashof)"
        )
        lines.append(
            f"Shortest and longest link are {written(short + long, 'm', 4)} together, the two others "
            f"{written(sum(middle), 'm', 4)}: {turns}."
        )
    return [" ".join(lines)]


# Events of a motion, each or in groups.

MOST = 24
"""Rows of the list of events; of more, those of one name and kind share a row."""


def event_section(motion: Motion) -> list[str]:
    """Return a table of all events with their times; of many, those of one name and kind are grouped."""
    if not motion.events:
        return []
    amount = Amounts(motion)
    if len(motion.events) <= MOST:
        rows = [
            [f"{event.name}: {event.what}", moment(event.time), _impulse(motion, [event]), amount(event.energy, "J")]
            for event in motion.events
        ]
        return table(["event", "at", "impulse", "change of kinetic energy"], rows)
    groups: dict[str, list[EventMark]] = {}
    for event in motion.events:
        groups.setdefault(f"{event.name}: {event.what}", []).append(event)
    rows = [
        [words, str(len(group)), moment(group[0].time), moment(group[-1].time), _impulse(motion, group)]
        for words, group in groups.items()
    ]
    lines = [f"{len(motion.events)} events, in groups; data.json has each.", ""]
    return [*lines, *table(["event", "how often", "first at", "last at", "largest impulse"], rows)]


def _impulse(motion: Motion, events: list[EventMark]) -> str:
    """Return the largest impulse of impacts, in words; empty for other events."""
    size = max(abs(event.impulse) for event in events)
    contact = motion.contacts.get(events[0].name)
    unit = "N m s" if contact is not None and contact.effort_unit == "N m" else "N s"
    return written(size, unit) if size else ""
