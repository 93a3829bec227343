"""Pins with their heads and spacers, and the columns of those on ground (mm)."""

from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING

from mechanisms.stages.automatic.shafts.pins_along import FOOT
from shared.shapes import outline
from shared.shapes.build import eased, extruded
from shared.shapes.pin import Head, pin, washer
from shared.shapes.solid import Solid, placed

if TYPE_CHECKING:
    from collections.abc import Mapping

    import cadquery as cq

    from mechanisms.stages.automatic.layout.sizes import Sizes
    from mechanisms.stages.automatic.shafts.bodies.kinds import Machine
    from mechanisms.stages.automatic.shafts.pins_along import Axle

COLUMN = 8.5
"""Radius of what carries an axle on ground (rmm)."""
FOOT_HEIGHT = 5.0


def axle_solids(own: Axle, machine: Machine, thickness: Mapping[str, float], sizes: Sizes, low: float) -> list[Solid]:
    """The pin with its head, spacers between the links, and on ground the column that carries them."""
    unit, pivot = sizes.scale, sizes.pivot
    x, y = own.places[own.holder]
    faces = [(machine.links[b].z - thickness[b] / 2, machine.links[b].z + thickness[b] / 2) for b in own.stack]
    axial = max(0.15, pivot.fit.axial * unit)
    top = faces[-1][1] + axial
    solids: list[Solid] = []
    if own.holder == "ground":
        solids.append(
            Solid(
                f"column_{own.joint}", _column(low, faces[0][0] - axial, pivot.held * unit, unit, x, y), "aluminium", 1
            )
        )
        start = low + 0.5
    else:
        start = faces[0][0] + 0.02
    head = Head(sizes.head.diameter * unit, sizes.head.height * unit, sizes.head.dome * unit)
    bolt = placed(pin(pivot.pin * unit, top - start, head, chamfer=0.6 * unit), x, y, start)
    solids.append(Solid(f"pin_{own.joint}", bolt, "steel" if own.holder == "ground" else "brass", 0))
    for k, (below, above) in enumerate(pairwise(faces)):
        held = own.holder != "ground" and k == 0
        bottom, end = below[1] + (0.02 if held else axial), above[0] - axial
        if end - bottom > 0.2:
            tube = washer((pivot.pin + pivot.fit.running) * unit, pivot.washer * unit, end - bottom, 0.1 * unit)
            solids.append(Solid(f"spacer_{own.joint}_{k + 1}", placed(tube, x, y, bottom), "steel", 1))
    return solids


def _column(low: float, high: float, bore: float, unit: float, x: float, y: float) -> cq.Workplane:
    shape = extruded(outline.circle(0, 0, COLUMN * unit), high - low - 0.02, low + 0.02)
    if high - low > 2 * FOOT_HEIGHT * unit:
        shape = shape.union(extruded(outline.circle(0, 0, FOOT * unit), FOOT_HEIGHT * unit, low + 0.02))
    shape = eased(shape, 0.6 * unit, "|Z", True)
    hole = extruded(outline.circle(0, 0, bore / 2), high - low + 2, low - 1)
    return placed(shape.cut(hole), x, y)
