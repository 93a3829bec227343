"""Writes numbers as people do: three digits, SI prefixes, km/h beside m/s; tables of Markdown."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

PREFIXES = {-12: "p", -9: "n", -6: "µ", -3: "m", 0: "", 3: "k", 6: "M", 9: "G"}
PLAIN = ("m/s²", "rad/s", "rad/s²", "cm³", "°", "%")
"""Units without prefixes."""


def written(value: float, unit: str, digits: int = 3) -> str:
    """``12.3 mN``; kilograms count from grams, and metres go down alone."""
    if value == 0.0 or not math.isfinite(value):
        return f"0 {unit}"
    if unit == "kg":
        return written(1000.0 * value, "g", digits) if abs(value) < 1.0 else f"{_digits(value, digits)} kg"
    power = 0
    if unit not in PLAIN and not unit.startswith("kg"):
        power = int(np.clip(3 * math.floor(math.log10(abs(value)) / 3 + 1e-9), -12, 9))
        if unit in ("m", "m/s", "s") and power > 0:
            power = 0
    return f"{_digits(value / 10.0**power, digits)} {PREFIXES[power]}{unit}"


def speed(value: float) -> str:
    """``1.05 m/s (3.77 km/h)``."""
    return f"{written(value, 'm/s')} ({_digits(3.6 * value, 3)} km/h)"


def turning(value: float) -> str:
    """``6.28 rad/s (60 rpm)``."""
    return f"{written(value, 'rad/s')} ({_digits(value * 30 / math.pi, 3)} rpm)"


def degrees(value: float) -> str:
    """Of radians."""
    return f"{math.degrees(value):.1f}°".replace("-", "\N{MINUS SIGN}")


def moment(t: float) -> str:
    """``0.214 s``."""
    return f"{t:.4g} s"


def listed(words: Sequence[str]) -> str:
    """``a, b and c``."""
    return words[0] if len(words) == 1 else f"{', '.join(words[:-1])} and {words[-1]}"


def counted(count: int, noun: str) -> str:
    """``1 event``, ``no events``, ``3 events``."""
    return f"{'no' if count == 0 else count} {noun}{'s' * (count != 1)}"


def first_peak(values: np.ndarray) -> int:
    """Where the largest value is; the first of several that are as large but for rounding."""
    return int(np.argmax(values >= values.max() - 1e-9 * abs(values.max())))


def table(head: Sequence[str], rows: Sequence[Sequence[str]]) -> list[str]:
    """Lines of a table; the first column is words, the others numbers."""
    lines = [f"| {' | '.join(head)} |", f"|---|{'---:|' * (len(head) - 1)}"]
    return [*lines, *(f"| {' | '.join(row)} |" for row in rows)]


def _digits(value: float, digits: int) -> str:
    text = f"{value:.{digits}g}"
    if "e" in text and abs(value) < 1e9 and abs(value) >= 1:
        text = f"{value:.0f}"
    return text.replace("-", "\N{MINUS SIGN}")
