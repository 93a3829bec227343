"""Quantities that an animation may show, and their writing: colours, units, round numbers."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal

Head = Literal["open", "open double", "solid", "solid double"]


@dataclass(frozen=True)
class Quantity:
    """One word of ``show``."""

    title: str
    colour: str
    unit: str
    """Unit of its arrows."""
    turning: str
    """Unit of its arcs."""
    head: Head = "solid"
    arcs: str = ""
    """Colour of its arcs, if they have another."""


QUANTITIES = {
    "velocities": Quantity("velocities", "#0a8a72", "m/s", "rad/s", "open"),
    "accelerations": Quantity("accelerations", "#6a1fc0", "m/s²", "rad/s²", "open double"),
    "forces": Quantity("forces", "#e06400", "N", "N m", "solid", "#b5123c"),
    "reactions": Quantity("reactions", "#4a93f0", "N", "N m", "solid double"),
    "energy": Quantity("energy flow", "#a86f00", "W", "W"),
}
"""Colours and heads are those of shared/contract/signals.py."""
WEIGHTS = "#453500"
"""Colour of weights, which are among the forces."""
TRAIL = "#1f9fb5"
"""Colour of the paths of traced points."""
EVERYTHING = (("velocities",), ("accelerations",), ("forces", "reactions"), ("energy",))
"""The pictures side by side of ``show="all"``."""
KINETIC, POTENTIAL, TAKEN = "#c48a00", "#4b6a9b", "#8a3b52"
"""Colours of the bars beside: energies, and power that is taken."""
CARD = "#f7f8fa"
"""Behind a machine."""


def round_below(value: float) -> float:
    """Return the largest of ..., 0.1, 0.2, 0.5, 1, 2, 5, 10, ... that is not above ``value`` > 0."""
    power = 10.0 ** math.floor(math.log10(value) + 1e-9)
    return next(step for step in (5.0, 2.0, 1.0, 0.5) if step * power <= value * (1 + 1e-9)) * power
