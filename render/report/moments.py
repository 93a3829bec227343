"""What happens at one moment of a motion: dead points, impacts and others. Plots and the page mark them."""

from __future__ import annotations

import numpy as np

from render.report.transmission import loops
from shared.contract import Motion

STEP = 1e-6
"""Fraction of the motion: times that are nearer are one."""
FEW = 6
"""Dead points at most; of a crank that turns and turns they would say nothing."""


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
