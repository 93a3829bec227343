"""Numbers of teeth and the module of wheels that are given by pitch radii: a standard module if one fits."""

from __future__ import annotations

import math
from collections.abc import Sequence
from fractions import Fraction

STANDARD = (0.05, 0.06, 0.08, 0.1, 0.12, 0.15, 0.2, 0.25, 0.3, 0.4, 0.5, 0.6, 0.8, 1, 1.25, 1.5, 2, 2.5, 3, 4, 5, 6, 8)
STANDARD += (10, 12, 16, 20, 25, 32, 40, 50)
"""Modules (mm) of ISO 54, first choice."""
WISH = 18
"""Teeth that the smallest wheel gets, about."""
FEWEST, MOST = 8, 400


def module_of(radii: Sequence[float]) -> float | None:
    """The module (mm) for wheels that mesh with each other, from their pitch radii (mm): a standard one if it gives
    whole numbers of teeth; else the one that gives them nearest to :data:`WISH`; None where the radii allow no whole
    numbers.
    """
    smallest, largest = min(radii), max(radii)
    fitting = [m for m in STANDARD if all(_whole(2 * radius / m) for radius in radii)]
    fitting = [m for m in fitting if 2 * smallest / m >= FEWEST and 2 * largest / m <= MOST]
    wished = 2 * smallest / WISH
    if fitting:
        return min(fitting, key=lambda m: abs(math.log(m / wished)))
    parts = [Fraction(radius / smallest).limit_denominator(60) for radius in radii]
    if any(abs(float(part) * smallest - radius) > 1e-6 * radius for part, radius in zip(parts, radii, strict=True)):
        return None
    least = math.lcm(*(part.denominator for part in parts))
    count = least * max(1, round(WISH / least))
    return 2 * smallest / count if count * largest / smallest <= MOST else None


def _whole(number: float) -> bool:
    return abs(number - round(number)) < 1e-6 * number
