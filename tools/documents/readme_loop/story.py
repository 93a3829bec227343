"""Story of the loop: its twelve lines, the number that changes, the crank's turns, the parts, reactions and camera.

The lines that are shown are those that are run, with the number as it is at the moment.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from typing import Any

LINES = """\
m = Mechanism("four_bar")
crank = m.bar("crank", {crank:.3f})
coupler = m.bar("coupler", 0.120)
rocker = m.bar("rocker", 0.090)
m.revolute("A", m.ground.at(0, 0), crank.start)
m.revolute("B", crank.end, coupler.start)
m.revolute("C", coupler.end, rocker.end)
m.revolute("D", m.ground.at(0.120, 0), rocker.start)
m.drive_angle("motor", crank, constant_rate(2 * pi))
m.trace("P", coupler.at(0.060, 0.030))
m.start_near(crank=0, coupler=45, rocker=100)
sol = m.sweep()"""
CHANGED = "{crank:.3f}"
"""Where the number stands that changes (m)."""
CRANK = 0.040
"""What it is in mechanisms/four_bar (m)."""
RATE = 12
"""Frames a second."""
SECONDS = 6.4
TURNS = 3
"""Turns of the crank in the loop, a whole number: it has no seam."""
NUMBERS = ((0.5, CRANK), (1.2, 0.025), (2.2, 0.050), (2.8, CRANK))
"""Seconds and lengths of the crank (m); in between it glides, before and after it stays."""
SOLID = ((2.9, 0.0), (3.35, 1.0), (5.85, 1.0), (6.3, 0.0))
"""How much of the solid parts is seen."""
TILTED = ((3.2, 0.0), (4.0, 1.0), (5.3, 1.0), (6.0, 0.0))
"""How far the camera has gone from before the plane to where the film has it."""
REACTIONS = ((3.9, 0.0), (4.1, 1.0), (5.1, 1.0), (5.3, 0.0))
SHOWN = (SOLID, TILTED, REACTIONS)


@dataclass(frozen=True)
class Frame:
    """One picture."""

    crank: float
    """m, in millimetres as it is written"""
    part: float
    """Fraction of a turn, 0 .. 1."""
    solid: float
    tilt: float
    reactions: float


def frames() -> list[Frame]:
    """Return all frames, at equal times."""
    count = round(RATE * SECONDS)
    times = [SECONDS * k / count for k in range(count)]
    return [
        Frame(round(_value(NUMBERS, t), 3), TURNS * t / SECONDS % 1.0, *(_value(steps, t) for steps in SHOWN))
        for t in times
    ]


def _value(steps: tuple[tuple[float, float], ...], t: float) -> float:
    """Return the value at a time, smooth from one step to the next."""
    if t <= steps[0][0]:
        return steps[0][1]
    for (a, low), (b, high) in pairwise(steps):
        if t <= b:
            part = (t - a) / (b - a)
            return low + (high - low) * part * part * (3 - 2 * part)
    return steps[-1][1]


def run(crank: float) -> dict[str, Any]:
    """Return the variables of the lines: the mechanism ``m``, its motion ``sol`` and others."""
    import mbsd

    variables: dict[str, Any] = {
        "Mechanism": mbsd.Mechanism,
        "constant_rate": mbsd.constant_rate,
        "pi": 3.141592653589793,
    }
    exec(LINES.format(crank=round(crank, 3)), variables)
    return variables
