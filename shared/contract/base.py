"""Common parts of the files that cross a process: units, provenance, kinds of numbers.

Metres, seconds, kilograms, radians, newtons everywhere; x right, y up, angles counter-clockwise and never wrapped.
"""

from __future__ import annotations

from typing import Annotated

import msgspec

UNITS = {
    "length": "m",
    "angle": "rad",
    "time": "s",
    "mass": "kg",
    "inertia": "kg m^2",
    "force": "N",
    "torque": "N m",
    "power": "W",
    "energy": "J",
}

NonNegative = Annotated[float, msgspec.Meta(ge=0)]
Positive = Annotated[float, msgspec.Meta(gt=0)]
Count = Annotated[int, msgspec.Meta(ge=0)]
Series = list[float]


class Strict(msgspec.Struct, forbid_unknown_fields=True, kw_only=True):
    """Struct that rejects unknown and missing fields."""


class Provenance(Strict, kw_only=True):
    """Inputs of the file. Nothing here depends on when or where it was written."""

    inputs: str
    """SHA-256 over every input: the mechanism's file, the solver's sources, the masses."""
    versions: dict[str, str]
