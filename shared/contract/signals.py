"""Signal colours: each belongs to one quantity in every picture; arrows differ by their heads too.

open      a line bent to a point: motions            solid      a filled point: loads from outside
double    two of them: what follows from others, accelerations from velocities, reactions from loads

Colours are sRGB, for light and for dark paper; under a simulated deuteranopia and protanopia any two still differ
(tests/shared/test_signals.py). mbsd/drawing/animation/words.py and render/view/page/src/view2d/inks.js have the same.
"""

from __future__ import annotations

from typing import Literal, NamedTuple

Head = Literal["open", "open double", "solid", "solid double"]


class Signal(NamedTuple):
    """Colour and arrow of a quantity."""

    light: str
    """``#rrggbb`` on light paper."""
    dark: str
    """Colours on dark paper, and in films."""
    head: Head = "solid"


SIGNALS = {
    "velocities": Signal("#0a8a72", "#4fd0a4", "open"),
    "accelerations": Signal("#6a1fc0", "#b848fa", "open double"),
    "forces": Signal("#e06400", "#ff9a1a", "solid"),
    "weights": Signal("#453500", "#f5ee7a", "solid"),
    "reactions": Signal("#4a93f0", "#74b4ff", "solid double"),
    "torques": Signal("#b5123c", "#ee3a2e", "solid"),
    "trails": Signal("#1f9fb5", "#a8f4fb"),
}


def rgb(colour: str) -> tuple[float, float, float]:
    """Return ``#rrggbb`` as 0..1 each (sRGB)."""
    red, green, blue = (int(colour[k : k + 2], 16) / 255 for k in (1, 3, 5))
    return red, green, blue


def linear(colour: str) -> tuple[float, float, float]:
    """Return ``#rrggbb`` in linear light, 0..1 each (IEC 61966-2-1)."""
    red, green, blue = (c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4 for c in rgb(colour))
    return red, green, blue
