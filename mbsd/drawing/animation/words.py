"""What an animation may show, and how its quantities are written: colours, units, round numbers."""

from __future__ import annotations

import math
from dataclasses import dataclass


@dataclass(frozen=True)
class Quantity:
    """One word of ``show``."""

    title: str
    colour: str
    unit: str
    """Of its arrows."""
    turning: str
    """Of its arcs."""


QUANTITIES = {
    "velocities": Quantity("velocities", "#0c9a62", "m/s", "rad/s"),
    "accelerations": Quantity("accelerations", "#8a3ffc", "m/s²", "rad/s²"),
    "forces": Quantity("forces", "#ee6c0a", "N", "N m"),
    "reactions": Quantity("reactions", "#1660d0", "N", "N m"),
    "energy": Quantity("energy flow", "#c48a00", "W", "W"),
}
EVERYTHING = (("velocities",), ("accelerations",), ("forces", "reactions"), ("energy",))
"""The pictures side by side of ``show="all"``."""
KINETIC, POTENTIAL, TAKEN = "#c48a00", "#4b6a9b", "#8a3b52"
"""Of the bars beside: energies, and power that is taken."""
CARD = "#f7f8fa"
"""Behind a machine."""
SLATE = ("#51606e", "#6a5f57", "#4a6668", "#655a70", "#5f6650")
"""Of bodies where arrows are to be seen."""
PREFIXES = {-12: "p", -9: "n", -6: "µ", -3: "m", 0: "", 3: "k", 6: "M", 9: "G", 12: "T"}


def round_below(value: float) -> float:
    """The largest of ..., 0.1, 0.2, 0.5, 1, 2, 5, 10, ... that is not above ``value`` > 0."""
    power = 10.0 ** math.floor(math.log10(value) + 1e-9)
    return next(step for step in (5.0, 2.0, 1.0, 0.5) if step * power <= value * (1 + 1e-9)) * power


def with_unit(value: float, unit: str, digits: int = 3) -> str:
    """``value`` with a prefix: 0.0052 N is ``5.2 mN``. Degrees of a second stay as they are."""
    if value == 0.0 or not math.isfinite(value):
        return f"0 {unit}"
    power = 0 if unit.startswith("rad") else min(max(3 * math.floor(math.log10(abs(value)) / 3 + 1e-9), -12), 12)
    if unit.startswith("m") and power > 0:
        power = 0  # metres by second stay metres
    number = f"{value / 10.0**power:.{digits}g}"
    if "e" in number:
        number = f"{value / 10.0**power:.0f}"
    return f"{number.replace('-', chr(0x2212))} {PREFIXES[power]}{unit}"
