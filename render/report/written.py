"""Words of a report: speeds, turns with rpm, degrees, moments, lists, tables of Markdown."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from render.magnitudes import floors
from shared.contract import Motion
from shared.contract.quantity import MINUS, counted, figures, written
from shared.stage.console import markdown_table

__all__ = ["Amounts", "counted", "degrees", "first_peak", "listed", "moment", "speed", "table", "turning", "written"]


class Amounts:
    """Writes numbers of one motion; rounding, as :func:`render.magnitudes.floors` has it, is 0."""

    def __init__(self, motion: Motion) -> None:
        self.floors = floors(motion)

    def __call__(self, value: float, unit: str, digits: int = 3) -> str:
        """Return ``value`` (SI) with its unit: ``12.3 mN``."""
        return written(self.without_noise(value, unit), unit, digits)

    def without_noise(self, value: float, unit: str) -> float:
        """Return the value, or 0 where it is rounding."""
        return 0.0 if abs(value) <= self.floors.get(unit, 0.0) else value


def speed(value: float, travels: bool = False) -> str:
    """Return ``1.05 m/s``, of what travels ``1.05 m/s (3.77 km/h)``."""
    return f"{written(value, 'm/s')} ({figures(3.6 * value, 3)} km/h)" if travels else written(value, "m/s")


def turning(value: float) -> str:
    """Return ``6.28 rad/s (60 rpm)``."""
    return f"{written(value, 'rad/s')} ({figures(value * 30 / math.pi, 3)} rpm)"


def degrees(value: float) -> str:
    """Return degrees from radians."""
    return f"{math.degrees(value):.1f}°".replace("-", MINUS)


def moment(t: float) -> str:
    """Return ``0.214 s``."""
    return f"{figures(t)} s"


def listed(words: Sequence[str]) -> str:
    """Return ``a, b and c``."""
    return words[0] if len(words) == 1 else f"{', '.join(words[:-1])} and {words[-1]}"


def first_peak(values: np.ndarray) -> int:
    """Return where the largest value is; the first of several that are as large but for rounding."""
    return int(np.argmax(values >= values.max() - 1e-9 * abs(values.max())))


def table(head: Sequence[str], rows: Sequence[Sequence[str]]) -> list[str]:
    """Return lines of a table; the first column is words, the others numbers."""
    return markdown_table(head, rows, numbers=range(1, len(head)))
