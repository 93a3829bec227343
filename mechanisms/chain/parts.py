"""Slender links: with thinner pins than parts have by themselves, every other link can share a layer."""

from mechanisms.automatic import automatic
from mechanisms.chain.mechanism import Params, build
from shared.shapes.solid import Solid
from shared.shapes.units import mm

PIN = 0.2
"""Diameter of a pin, in lengths of a link."""


def parts(p: Params) -> dict[str, list[Solid]]:
    """All by itself, but for the pins."""
    return automatic(build(p), pin=PIN * mm(p.length)).solids()
