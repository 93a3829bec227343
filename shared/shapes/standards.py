"""Hardware from a shop, by its standard: sizes in mm, and the words to order it.

Only sizes that the standard lists are here; what has none is to be made.
"""

from __future__ import annotations

from dataclasses import dataclass

# Fits: the clearances between parts, in one place for all machines and printers.


@dataclass(frozen=True)
class Fit:
    """Clearances in mm. The defaults suit turned and milled parts; printed ones run well with running=0.3."""

    running: float = 0.2
    """Diametral, between a pin and what turns on it."""
    press: float = 0.02
    """Diametral, between a pin or bushing and the part that holds it."""
    axial: float = 0.4
    """Between faces that move past each other."""
    seat: float = 0.02
    """Between faces of one body that rest on each other; keeps them from sharing a face in a picture."""


@dataclass(frozen=True)
class ShimRing:
    """A shim ring for a pin, DIN 988."""

    inner: float
    outer: float
    thickness: float

    @property
    def name(self) -> str:
        """Words to order it."""
        return f"shim ring {self.inner:g}x{self.outer:g}x{self.thickness:g} DIN 988"


@dataclass(frozen=True)
class Circlip:
    """A retaining ring for a shaft, DIN 471, and the groove that it needs."""

    shaft: float
    thickness: float
    groove: float
    """Diameter of the groove."""
    width: float
    """Least width of the groove."""

    @property
    def name(self) -> str:
        """Words to order it."""
        return f"circlip {self.shaft:g}x{self.thickness:g} DIN 471"


SHIM_OUTER: dict[float, float] = {
    3: 6,
    4: 8,
    5: 10,
    6: 12,
    8: 14,
    10: 16,
    12: 18,
    16: 22,
    20: 28,
    25: 35,
    30: 42,
    40: 50,
    50: 62,
}
"""Shaft to outer diameter of shim rings, DIN 988; up to 50 mm."""
SHIM_THICKNESS = (0.1, 0.2, 0.3, 0.5, 1.0)
CIRCLIPS = {
    c.shaft: c
    for c in (
        Circlip(3, 0.4, 2.8, 0.5),
        Circlip(4, 0.4, 3.8, 0.5),
        Circlip(5, 0.6, 4.8, 0.7),
        Circlip(6, 0.7, 5.7, 0.8),
        Circlip(8, 0.8, 7.6, 0.9),
        Circlip(10, 1.0, 9.6, 1.1),
        Circlip(12, 1.0, 11.5, 1.1),
        Circlip(16, 1.0, 15.2, 1.1),
        Circlip(20, 1.2, 19.0, 1.3),
        Circlip(25, 1.2, 23.9, 1.3),
        Circlip(30, 1.5, 28.6, 1.6),
        Circlip(40, 1.75, 37.5, 1.85),
        Circlip(50, 2.0, 47.0, 2.15),
    )
}
"""Circlips by the diameter of the shaft, DIN 471."""
SHORTEST = {1.6: 2.5, 2: 3, 2.5: 4, 3: 5, 4: 6, 5: 8, 6: 10, 8: 12, 10: 16, 12: 20, 16: 25, 20: 30, 24: 40}
LONGEST = {1.6: 16, 2: 20, 2.5: 25, 3: 30, 4: 40, 5: 50, 6: 60, 8: 80, 10: 100, 12: 120, 16: 160, 20: 200, 24: 200}
LENGTHS = (2.5, 3, 4, 5, 6, 8, 10, 12, 16, 20, 25, 30, 35, 40, 45, 50, 55, 60, 65, 70, 80, 90, 100, 110, 120, 130)
LENGTHS += (140, 150, 160, 180, 200)
"""Lengths of socket head cap screws, ISO 4762; the range of each thread is in :data:`SHORTEST` and :data:`LONGEST`."""


def shim_ring(shaft: float, thickness: float) -> ShimRing | None:
    """Return the ring for a shaft that is nearest in thickness; None if there is none."""
    outer = SHIM_OUTER.get(shaft)
    nearest = min(SHIM_THICKNESS, key=lambda t: abs(t - thickness))
    return ShimRing(shaft, outer, nearest) if outer else None


def screw_length(nominal: float, longest: float) -> float | None:
    """Return the standard length of a cap screw next below ``longest``; None if there is none."""
    if nominal not in SHORTEST:
        return None
    return max((n for n in LENGTHS if SHORTEST[nominal] <= n <= min(LONGEST[nominal], longest + 1e-9)), default=None)


def screw_name(nominal: float, length: float) -> str:
    """Return the words to order this screw; empty if the standard does not list it."""
    if screw_length(nominal, length) != length:
        return ""
    return f"M{nominal:g}x{length:g} socket head cap screw ISO 4762"
