"""Events at one moment of a motion: dead points, impacts and others. Plots and the page mark them, the report
lists them.
"""

from __future__ import annotations

import numpy as np

from render.report.transmission import loops
from render.report.written import Amounts, moment, table, written
from shared.contract import EventMark, Motion

STEP = 1e-6
"""Fraction of the motion: times that are nearer are one."""
FEW = 6
"""Dead points at most; of a crank that turns and turns they would say nothing."""
MOST = 24
"""Rows of the list of events; of more, those of one name and kind share a row."""


def marks(motion: Motion) -> list[tuple[float, str]]:
    """Times (s) and words, in their order: dead points of driven cranks, and all events but the end."""
    time = np.asarray(motion.time)
    moments = [(at, f"{loop.follower} turns back") for loop in loops(motion) for at, _ in loop.dead_points(time)]
    if motion.period:  # what is at the start of a period is at its end
        close = STEP * (time[-1] - time[0])
        ends = (time[0], time[-1])
        moments += [
            (other, words) for at, words in moments for end, other in (ends, ends[::-1]) if abs(at - end) < close
        ]
    moments = moments if len(moments) <= FEW else []
    moments += [(event.time, f"{event.name}: {event.what}") for event in motion.events if event.what != "end"]
    return sorted(set(moments))


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
