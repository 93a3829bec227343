"""What the loop shows when: the number, the crank's turns, the skeleton, the solid parts, the reactions, the camera."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

from tools.readme_loop.lines import CRANK

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
    """All of them, at equal times."""
    count = round(RATE * SECONDS)
    times = [SECONDS * k / count for k in range(count)]
    return [
        Frame(
            round(_at(NUMBERS, t), 3), TURNS * t / SECONDS % 1.0, _at(SOLID, t), _at(TILTED, t), _at(REACTIONS, t)
        )
        for t in times
    ]  # fmt: skip


def _at(steps: tuple[tuple[float, float], ...], t: float) -> float:
    """Smooth from one step to the next."""
    if t <= steps[0][0]:
        return steps[0][1]
    for (a, low), (b, high) in pairwise(steps):
        if t <= b:
            part = (t - a) / (b - a)
            return low + (high - low) * part * part * (3 - 2 * part)
    return steps[-1][1]
