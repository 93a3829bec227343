"""The automatic parts, and a fan on the large pulley, which is what the belt drives."""

from __future__ import annotations

import cadquery as cq

from mechanisms.automatic import automatic
from mechanisms.belt_drive.mechanism import Params, build
from shared.shapes.bodies import Bodies
from shared.shapes.build import extruded
from shared.shapes.outline import circle, hull
from shared.shapes.solid import Solid
from shared.shapes.units import mm

BLADES, LONG = 5, 1.9
"""Number of blades, and their reach in the radius of the large pulley."""
HUB, THICK, PITCH = 1.55, 2.4, 28.0
"""Radius of the hub, in that of an eye; thickness of a blade (mm); its angle against the plane (degrees)."""


def parts(p: Params) -> Bodies:
    """By body."""
    made = automatic(build(p))
    radius, eye = mm(p.radius * p.ratio), made.sizes.eye * made.sizes.scale
    made.base_under(*((mm(p.distance), side * (LONG * radius + 6.0)) for side in (-1.0, 1.0)))
    solids = made.solids()
    low = made.span("large")[1] + made.sizes.pivot.fit.seat
    wide = 0.30 * radius
    top = (
        max(solid.shape.val().BoundingBox().zmax for body in made.m.bodies for solid in solids[body]) + 1.0 + 0.5 * wide
    )
    solids.dress("large", Solid("fan", _fan(LONG * radius, HUB * eye, wide, low, top), "aluminium_orange", 1))
    return solids


def _fan(reach: float, hub: float, wide: float, low: float, middle: float) -> cq.Workplane:
    """Blades about a hub that stands on the pulley round its pin."""
    high = middle + 0.3 * wide
    shape = extruded(circle(0, 0, hub), high - low, low)
    outline = hull([(0.9 * hub, 0.0, 0.32 * wide), (reach - wide, 0.0, wide)])
    blade = extruded(outline, THICK, -THICK / 2).rotate((0, 0, 0), (1, 0, 0), PITCH).translate((0, 0, middle))
    for k in range(BLADES):
        shape = shape.union(blade.rotate((0, 0, 0), (0, 0, 1), 360.0 / BLADES * k))
    return shape.cut(extruded(circle(0, 0, hub / 1.5), high - low + 4 * wide, low - 1.0))
