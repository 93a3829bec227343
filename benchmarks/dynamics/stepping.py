"""Rungs of the ladders of settings: numbers of steps and tolerances in even ratios."""

from __future__ import annotations

import math


def steps_of(first: int, last: int, ratio: float = 1.15) -> list[int]:
    """Numbers of steps from ``first`` to ``last``."""
    count = round(math.log(last / first) / math.log(ratio))
    return [round(first * ratio**k) for k in range(count + 1)]


def tolerances(first: float, last: float, per_decade: int = 3) -> list[float]:
    """From loose to tight."""
    count = round(math.log10(first / last) * per_decade)
    return [float(f"{first * 10 ** (-k / per_decade):.2g}") for k in range(count + 1)]
