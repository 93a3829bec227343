"""Straight walls on ground from contacts with lines: as long as the way along them, and meeting in mitred corners.

The lines of one disc leave it the region in which it is on the free side of them all. So each wall ends where it
crosses another one, and has its matter outside.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from mechanisms.stages.automatic.rolling.backings import THICK
from mechanisms.stages.automatic.rolling.roads import Road
from mechanisms.stages.automatic.rolling.rounds import Round

BEYOND = 1.2
"""How far a wall goes on beyond the way of what touches it, in that one's radii."""
CORNER = 3.0
"""A wall that ends nearer than this to another one (radii) goes on to it."""
SHARPEST = math.radians(20.0)
"""Walls at a smaller angle have no mitred corner."""
PARALLEL = 1e-3
"""Walls at a smaller angle (rad) do not meet."""
NOSE = 4.0
"""The least radius of what touches (rmm); the wall of a smaller one lies back by the difference."""


@dataclass(eq=False)
class Line:
    """A line on ground (rmm): a place, its direction, and the round parts that it carries with their ways along it."""

    name: str
    start: np.ndarray
    way: np.ndarray
    rounds: list[Round] = field(default_factory=list)
    travel: list[tuple[float, float]] = field(default_factory=list)

    @property
    def free(self) -> np.ndarray:
        """(2,) the unit vector to the free side."""
        return np.array([-self.way[1], self.way[0]])

    def carry(self, part: Round, places: np.ndarray) -> None:
        """Add a round part that goes along (T, 2) places."""
        along = (places - self.start) @ self.way
        beyond = BEYOND * part.radius
        self.rounds.append(part)
        self.travel.append((float(along.min()) - beyond, float(along.max()) + beyond))

    def is_same(self, other: Line) -> bool:
        """Whether both are one line with one free side."""
        return bool(np.abs(self.way - other.way).max() < 1e-9 and abs((other.start - self.start) @ self.free) < 1e-6)


def roads(lines: Sequence[Line]) -> list[Road]:
    """A wall for each line."""
    walls = []
    for line in lines:
        low, high = min(low for low, _ in line.travel), max(high for _, high in line.travel)
        shared = [other for other in lines if other is not line and {*other.rounds} & {*line.rounds}]
        reach = CORNER * max(part.radius for part in line.rounds)
        behind = [THICK * -line.free] * 2  # of the last and of the first place
        first, last = low - reach, high + reach
        for other in shared:
            turn = float(line.way @ other.free)  # sine of the angle between them; below 0: it ends here
            if abs(turn) < PARALLEL:
                continue
            at = float((other.start - line.start) @ other.free) / turn
            if turn < 0 and at < last:
                high, behind[0], last = at, _mitre(line, other), at
            elif turn > 0 and at > first:
                low, behind[1], first = at, _mitre(line, other), at
        path = np.array([line.start + low * line.way, line.start + high * line.way])
        walls.append(Road(line.name, line.rounds, path, np.array([path[1] + behind[0], path[0] + behind[1]])))
    return walls


def _mitre(line: Line, other: Line) -> np.ndarray:
    """(2,) from where two walls meet to where their outer faces meet; square where that would be far."""
    cosine = float(line.free @ other.free)
    if math.pi - math.acos(max(-1.0, min(1.0, cosine))) < SHARPEST:
        return -THICK * line.free
    return -THICK * (line.free + other.free) / (1.0 + cosine)
