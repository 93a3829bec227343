"""A ram with its clevises and pins, and on ground its columns and the deck in which they stand (mm)."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from mechanisms.stages.automatic.shafts.rams import COLUMN, HUB
from shared.shapes.build import extruded
from shared.shapes.genus import through_holes
from shared.shapes.outline import circle
from shared.shapes.solid import Solid, placed

if TYPE_CHECKING:
    import cadquery as cq

    from mechanisms.stages.automatic.shafts.rams import RamPlan

SEAT = 0.02


def ram_solids(own: RamPlan, pin: float, material: str) -> list[Solid]:
    """The ram, its main piece first, and its pins of radius ``pin``."""
    first, last = own.span
    shape = _box(own.low, own.high, own.middle, own.half, first, last)
    for clevis, room, bottom, top in own.clevises:
        for low, high in ((bottom, clevis.z - room), (clevis.z + room, top)):
            cheek = extruded(circle(clevis.s, clevis.q, own.eye), high - low, low)
            shape = shape.union(cheek).union(_box(clevis.s, own.low + 1.0, clevis.q, own.eye, low, high))
    for clevis, _, bottom, top in own.clevises:
        shape = shape.cut(extruded(circle(clevis.s, clevis.q, pin + SEAT), top - bottom + 2, bottom - 1))
    running = max(0.12, 0.02 * own.unit)
    for z in own.columns:
        shape = shape.cut(_column(own, own.low - 1, own.high + 1, z, COLUMN * own.unit + running))
    solids = [Solid(own.ram.body, _on_body(own, shape), material, through_holes(shape))]
    for s, q, bottom, top in _merged(own):
        bolt = extruded(circle(s, q, pin), top - bottom, bottom)
        solids.append(Solid(f"pin_{own.ram.body}", _on_body(own, bolt), "brass", 0))
    return solids


def guide_solids(own: RamPlan, low: float) -> list[Solid]:
    """Columns and deck, from the base plate (z = ``low``) up."""
    begin, (below, above) = own.begin, own.deck
    wide = own.half + HUB * own.unit
    deck = _box(below, above, own.middle, wide, low, own.span[1])
    solids = []
    for k, z in enumerate(own.columns, start=1):
        column = _column(own, begin, above, z, COLUMN * own.unit)
        deck = deck.cut(_column(own, below - 1, above + 1, z, COLUMN * own.unit + SEAT))
        solids.append(Solid(f"column_{own.ram.body}_{k}", _on_ground(own, column), "steel", 0))
    solids.append(Solid(f"deck_{own.ram.body}", _on_ground(own, deck), "aluminium_blue", through_holes(deck)))
    return solids


def _merged(own: RamPlan) -> list[tuple[float, float, float, float]]:
    """Place and ends of the pins: one through clevises of one place whose cheeks touch."""
    merged: list[tuple[float, float, float, float]] = []
    for clevis, _, bottom, top in own.clevises:
        for k, (s, q, low, high) in enumerate(merged):
            if math.hypot(s - clevis.s, q - clevis.q) < SEAT and bottom < high + SEAT:
                merged[k] = (s, q, low, max(high, top))
                break
        else:
            merged.append((clevis.s, clevis.q, bottom, top))
    return merged


def _box(x0: float, x1: float, y: float, half: float, z0: float, z1: float) -> cq.Workplane:
    import cadquery as cq

    box = cq.Workplane().box(x1 - x0, 2 * half, z1 - z0, centered=(False, True, False))
    return box.translate((x0, y, z0))


def _column(own: RamPlan, begin: float, end: float, z: float, radius: float) -> cq.Workplane:
    along = extruded(circle(0, 0, radius), end - begin, begin).rotate((0, 0, 0), (0, 1, 0), 90)
    return along.translate((0, own.middle, z))


def _on_body(own: RamPlan, shape: cq.Workplane) -> cq.Workplane:
    return placed(shape, *own.ram.origin, turn=math.degrees(own.ram.turn))


def _on_ground(own: RamPlan, shape: cq.Workplane) -> cq.Workplane:
    u, v = own.ram.along
    return placed(shape, *own.ram.line, turn=math.degrees(math.atan2(v, u)))
