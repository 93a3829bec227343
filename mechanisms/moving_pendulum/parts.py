"""A slender rod: its pins are thinner than those of automatic parts."""

from mechanisms.automatic import automatic
from mechanisms.moving_pendulum.mechanism import Params, build
from shared.shapes.solid import Solid
from shared.shapes.units import mm

PIN = 0.04
"""Diameter of a pin, in lengths of the rod."""


def parts(p: Params) -> dict[str, list[Solid]]:
    """All is automatic but the pins."""
    return automatic(build(p), pin=PIN * mm(p.length)).solids()
