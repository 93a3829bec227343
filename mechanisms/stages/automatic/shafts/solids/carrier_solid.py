"""A rod that carries others: its shank, its big end with two flanges, and the knuckle pins (mm)."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from mechanisms.stages.automatic.layout.planar import convex_hull
from mechanisms.stages.automatic.shafts.cylinders import BIG_END, SHANK
from mechanisms.stages.automatic.shafts.knuckles import HUB, KNUCKLE_EYE, KNUCKLE_PIN
from mechanisms.stages.automatic.shafts.solids.link_solids import rod_shape
from shared.shapes import outline
from shared.shapes.build import eased, extruded
from shared.shapes.kernel import first_sound
from shared.shapes.link import Eye
from shared.shapes.solid import placed

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    import cadquery as cq

type Point = tuple[float, float]
WAIST = 1.1
"""Radius of a flange between two pins, in their distance from the crank pin."""
EDGE = 0.02
HOLLOW = 0.45
"""Radius of the hole in a knuckle pin, in that of the pin."""
SEAT = 0.02
END = 0.1
"""How far a knuckle pin ends below the face of a flange."""


@dataclass(frozen=True)
class Fork:
    """Sizes of a carrier: its height, the thickness of each flange and of its shank, the bore it goes with."""

    height: float
    flange: float
    middle: float
    bore: float


def carrier_shape(
    main: Point, hole: float, small: tuple[float, float, Eye], pins: Sequence[Point], fork: Fork
) -> cq.Workplane:
    """From z = 0 up: ``main`` on the crank pin with a ``hole`` (diameter), the ``small`` end, knuckle ``pins``."""
    (x, y), bore, height = main, fork.bore, fork.height
    plate = _flange(main, pins, fork.flange, bore)
    shape = plate.union(placed(plate, z=height - fork.flange))
    shape = shape.union(extruded(outline.circle(x, y, HUB * bore), height))
    root = extruded(outline.hull([(x, y, SHANK * bore), (small[0], small[1], 0.8 * SHANK * bore)]), height)
    shape = shape.union(root.intersect(_flange(main, pins, height, bore, edge=0.0)))
    shank = rod_shape([(x, y, Eye(HUB * bore, hole)), small], fork.middle, bore)
    shape = shape.union(placed(shank, z=(height - fork.middle) / 2))
    for u, v, radius in [(x, y, hole / 2), *((u, v, KNUCKLE_PIN * bore + SEAT) for u, v in pins)]:
        shape = shape.cut(extruded(outline.circle(u, v, radius), height + 2, -1))
    return shape


def knuckle_pin(at: Point, height: float, bore: float) -> cq.Workplane:
    """A tube through both flanges, from z = 0 up."""
    radius = KNUCKLE_PIN * bore
    return extruded(outline.circle(*at, radius), height - 2 * END, END, [outline.circle(*at, HOLLOW * radius)])


def _flange(main: Point, pins: Sequence[Point], height: float, bore: float, edge: float = EDGE) -> cq.Workplane:
    """From z = 0 up: round the big end and all pins, drawn in between them where there is room."""
    x, y = main
    own, hub = KNUCKLE_EYE * bore, BIG_END * bore
    ring = extruded(outline.circle(x, y, hub), height)
    corners = [(float(u), float(v)) for u, v in convex_hull(np.array([*pins, main]))]
    away = max(math.dist(main, pin) for pin in pins)
    ways: list[Callable[[], cq.Workplane]] = []
    if len(corners) > 2:
        circles = [(u, v, hub if math.dist(main, (u, v)) < 1e-6 else own) for u, v in corners]
        for waist in (WAIST * away, 3 * away, math.inf):
            ways.append(partial(_round, circles, waist, height, ring))
    arms = ring
    for u, v in pins:
        arms = arms.union(extruded(outline.hull([(x, y, hub), (u, v, own)]), height))
    ways.append(lambda: arms)
    rounded = [partial(_eased, way, edge * bore) for way in ways]
    made = first_sound([shape for pair in zip(rounded, ways, strict=True) for shape in pair])
    return arms if made is None else made


def _round(circles: Sequence[outline.Circle], waist: float, height: float, ring: cq.Workplane) -> cq.Workplane:
    return extruded(outline.hull(circles, waist), height).union(ring)


def _eased(way: Callable[[], cq.Workplane], edge: float) -> cq.Workplane:
    return eased(way().clean(), edge, "|Z", True)
