"""Slender links: with pins thinner than those of automatic parts, every other link can share a layer."""

from mechanisms.automatic import automatic
from mechanisms.chain.mechanism import Params, build
from shared.shapes.solid import Solid
from shared.shapes.units import mm

PIN, THICK = 0.2, 0.27
"""Diameter of a pin, in lengths of a link; of many links, which from afar would be a thread otherwise."""
MANY = 50


def parts(p: Params) -> dict[str, list[Solid]]:
    """All is automatic but the pins."""
    return automatic(build(p), pin=(THICK if p.links > MANY else PIN) * mm(p.length)).solids()
