"""Millimetres in CAD, metres everywhere else: the one place that converts."""

from __future__ import annotations

MILLIMETRES = 1000.0
"""Millimetres in a metre."""


def mm(metres: float) -> float:
    """Return a length for CAD (mm) from a length of the mechanism (m)."""
    return metres * MILLIMETRES


def metres(millimetres: float) -> float:
    """Return a length (m) from CAD (mm)."""
    return millimetres / MILLIMETRES


def cubic_metres(cubic_millimetres: float) -> float:
    """Return a volume (m^3) from CAD (mm^3)."""
    return cubic_millimetres / MILLIMETRES**3


def inertia_metres(fifth_power_millimetres: float) -> float:
    """Return a volume inertia (m^5) from CAD (mm^5); times a density it is kg m^2."""
    return fifth_power_millimetres / MILLIMETRES**5
