"""The automatic parts, and what makes them a shaping machine: the ram's tool, and the work."""

from __future__ import annotations

import cadquery as cq

from mechanisms.automatic import automatic
from mechanisms.quick_return.mechanism import Params, build
from shared.shapes.bodies import Bodies
from shared.shapes.solid import Solid
from shared.shapes.units import mm

NECK, HEAD = 0.045, 0.075
"""Distance from the ram's pin to the tool and to the end of the ram (m)."""
HALF = 0.009
"""Half the width of the ram (m)."""
TOOL = 0.048
"""Height of the ram's line over the tool's edge (m)."""
CUT = 0.001
"""Between the edge and the work (m)."""
WORK = (0.100, 0.195, 0.045)
"""Left and right side of the work, and its lower side, over the arm's axis (m)."""


def parts(p: Params) -> Bodies:
    """By body."""
    made = automatic(build(p))
    made.join("ram", _ram())
    solids = made.solids()
    _, top = made.span("ram")
    solids["ground"].append(Solid("work", _work(p, top), "brass", 0))
    return solids


def _ram() -> cq.Wire:
    """A bar from the pin to the right, and a tool that ends in an edge below it."""
    middle = (NECK + HEAD) / 2
    corners = [
        (0.0, HALF),
        (0.0, -HALF),
        (NECK, -HALF),
        (NECK, -0.7 * TOOL),
        (middle, -TOOL),
        (HEAD, -0.7 * TOOL),
        (HEAD, HALF),
    ]
    return cq.Wire.makePolygon([cq.Vector(mm(x), mm(y), 0.0) for x, y in corners], close=True)


def _work(p: Params, top: float) -> cq.Workplane:
    """A block on the base, whose upper side the edge passes."""
    left, right, low = (mm(value) for value in WORK)
    high = mm(p.ram - TOOL - CUT)
    block = cq.Workplane().box(right - left, high - low, top, centered=False).translate((left, low, 0.0))
    return block.edges("|Z").chamfer(2.0).faces(">Z").edges().chamfer(0.8)
