"""Joints and drivers that user events release in a simulation, with the times and outputs."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from mbsd.results.solution import Solution


def released_rows(sol: Solution) -> dict[str, np.ndarray]:
    """Return (T,) of each joint and driver that an event releases: True where that has happened."""
    if sol.held is None:
        return {}
    count = len(sol.packed.joints) - sol.packed.contacts
    joints = zip(sol.packed.joints[:count], sol.packed.first_row, strict=False)
    gone = {joint.name: ~sol.held[:, first] for joint, first in joints}
    return {name: since for name, since in gone.items() if since.any()}


def release_times(sol: Solution) -> dict[str, float]:
    """Return the time (s) of the event that released a joint or driver, by its name."""
    times = {}
    for name, gone in released_rows(sol).items():
        row = int(gone.argmax())
        since, until = sol.t[max(row - 1, 0)], sol.t[row]
        events = [event.time for event in sol.events if event.what == "event" and since <= event.time <= until]
        times[name] = float(events[-1] if events else until)
    return times
