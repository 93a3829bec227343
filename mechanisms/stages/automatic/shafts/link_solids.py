"""Solids of links: rods, carriers, axles and bearers (mm)."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache, partial
from itertools import pairwise

import cadquery as cq
import numpy as np

from mechanisms.stages.automatic.body_shapes import body_shape, first_made
from mechanisms.stages.automatic.layout.planar import convex_hull
from mechanisms.stages.automatic.layout.sizes import Sizes
from mechanisms.stages.automatic.shafts.bearings import BOSS, FOOT, Axle, Bearers, heights_of
from mechanisms.stages.automatic.shafts.bodies import HUB, KNUCKLE_EYE, KNUCKLE_PIN, Link, Machine
from mechanisms.stages.automatic.shafts.cylinders import BIG_END, SHANK
from mechanisms.stages.automatic.shafts.shaft_plan import Journal
from shared.shapes import outline
from shared.shapes.build import eased, extruded
from shared.shapes.kernel import rough_box, through_holes
from shared.shapes.link import Eye, link
from shared.shapes.pin import Head, pin, washer
from shared.shapes.solid import Solid, placed

# Links in one plane: connecting rods with a split big end, and plates round any number of eyes (mm).

KERF = 0.03
"""Between a rod and its cap, on either side of the middle."""
WIDTHS = (4.0, 5.1, 4.4, 6.2)
"""Widths of the box that cuts a rod in two, in its reach: with some the kernel fails for no reason of the shape."""


def plate_shape(own: Link, eyes: list[tuple[float, float, Eye]], thickness: float, unit: float) -> cq.Workplane:
    """Return the plate from z = 0 up; ``unit`` millimetres are one rmm."""
    scaled = [(x / unit, y / unit, Eye(eye.radius / unit, eye.bore / unit)) for x, y, eye in eyes]
    shape, _ = body_shape(scaled, thickness / unit)
    return shape.newObject([shape.val().scale(unit)])


def rod_shape(eyes: list[tuple[float, float, Eye]], thickness: float, bore: float) -> cq.Workplane:
    """Return a connecting rod from z = 0 up, its big end first in ``eyes``."""
    unit = bore / 100
    (x0, y0, big), (x1, y1, small) = eyes
    length, turn = math.hypot(x1 - x0, y1 - y0) / unit, math.atan2(y1 - y0, x1 - x0)
    start, end = (Eye(eye.radius / unit, eye.bore / unit) for eye in (big, small))
    widths, thick = (200 * SHANK, 160 * SHANK), thickness / unit
    ways: list[Callable[[], cq.Workplane]] = [
        partial(link, length, thick, start, end, widths, fillet, edge=0.8, pocket=pocket, rim=3.0)
        for fillet, pocket in ((16.0, 0.3 * thick), (8.0, 0.3 * thick), (8.0, 0.0), (3.0, 0.0))
    ]
    ways.append(lambda: body_shape([(0.0, 0.0, start), (length, 0.0, end)], thick)[0])
    shape = first_made(ways)
    return placed(shape.newObject([shape.val().scale(unit)]), x0, y0, turn=math.degrees(turn))


type Cut = tuple[tuple[float, float], float, float]
"""Where a link is split, the direction (rad) in which its body lies ahead of that, and how far it reaches."""
type Piece = tuple[cq.Workplane, int]
"""A shape and its number of through holes."""


@lru_cache(maxsize=64)
def rod_pieces(
    eyes: tuple[tuple[float, float, Eye], ...], thickness: float, bore: float, cuts: tuple[Cut, ...]
) -> list[Piece]:
    """Return a connecting rod and its caps, once for all rods of an engine that are alike; from z = 0 up."""
    return cut_up(rod_shape([*eyes], thickness, bore), cuts)


def cut_up(shape: cq.Workplane, cuts: Sequence[Cut]) -> list[Piece]:
    """Return the rest of a link, and the cap of each cut."""
    caps = []
    for at, towards, reach in cuts:
        shape, cap = split(shape, at, towards, reach)
        caps.append(cap)
    return [(piece, through_holes(piece)) for piece in (shape, *caps)]


def split(
    shape: cq.Workplane, at: tuple[float, float], towards: float, reach: float
) -> tuple[cq.Workplane, cq.Workplane]:
    """Return the parts of a shape ahead of and behind a line through ``at``; ``towards`` (rad) is ahead."""
    low, high = rough_box(shape)
    along = float(low[2] + high[2]) / 2  # a plate may be far along its shaft

    def half(side: float, wide: float) -> cq.Workplane:
        box = cq.Workplane().box(2 * reach, wide * reach, wide * reach).translate((side * (reach + KERF), 0, along))
        return shape.intersect(placed(box, *at, turn=math.degrees(towards)))

    cuts = ((half(1.0, wide), half(-1.0, wide)) for wide in WIDTHS)
    sound = (cut for cut in cuts if all(piece.solids().size() == 1 for piece in cut))
    return next(sound, (half(1.0, WIDTHS[0]), half(-1.0, WIDTHS[0])))


def splits_at(own: Link, x: float, y: float) -> float | None:
    """Return the direction (rad) in which all other eyes lie ahead of a place; None if some do not."""
    others = [(eye.x - x, eye.y - y) for eye in own.eyes if math.hypot(eye.x - x, eye.y - y) > 1e-6]
    if not others:
        return None
    u, v = sum(o[0] for o in others), sum(o[1] for o in others)
    size = math.hypot(u, v)
    if size < 1e-6 or any(o[0] * u + o[1] * v <= 0.3 * math.hypot(*o) * size for o in others):
        return None
    return math.atan2(v, u)


# A rod that carries others: its shank, its big end with two flanges, and the knuckle pins (mm).

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
    """Sizes of a carrier: height, thickness of each flange and of its shank, bore it goes with."""

    height: float
    flange: float
    middle: float
    bore: float


def carrier_shape(
    main: Point, hole: float, small: tuple[float, float, Eye], pins: Sequence[Point], fork: Fork
) -> cq.Workplane:
    """Return a carrier from z = 0 up.

    ``main`` is on the crank pin with a ``hole`` (diameter); ``small`` is its other end; ``pins`` are knuckle pins.
    """
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
    """Return a tube through both flanges, from z = 0 up."""
    radius = KNUCKLE_PIN * bore
    return extruded(outline.circle(*at, radius), height - 2 * END, END, [outline.circle(*at, HOLLOW * radius)])


def _flange(main: Point, pins: Sequence[Point], height: float, bore: float, edge: float = EDGE) -> cq.Workplane:
    """Return the flange round the big end and all pins, drawn in between them where there is room."""
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
    return first_made([shape for pair in zip(rounded, ways, strict=True) for shape in pair])


def _round(circles: Sequence[outline.Circle], waist: float, height: float, ring: cq.Workplane) -> cq.Workplane:
    return extruded(outline.hull(circles, waist), height).union(ring)


def _eased(way: Callable[[], cq.Workplane], edge: float) -> cq.Workplane:
    return eased(way().clean(), edge, "|Z", True)


# Pins with their heads and spacers, and the columns of those on ground (mm).

COLUMN = 8.5
"""Radius of what carries an axle on ground (rmm)."""
FOOT_HEIGHT = 5.0


def axle_solids(own: Axle, machine: Machine, thickness: Mapping[str, float], sizes: Sizes, low: float) -> list[Solid]:
    """Return the pin with its head, spacers between the links, and on ground the column that carries them."""
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


# Pillars and bearings of a shaft (mm).

ARM = 0.62
"""Thickness of the arms in the length of a bearing."""


def bearer_solids(own: Bearers, low: float, number: str) -> list[Solid]:
    """Return pillars from ``low`` up, and bearings, those between throws of two halves."""
    solids = []
    for k, place in enumerate(own.places, start=1):
        shape = extruded(outline.circle(*place, own.radius), own.top - low, low)
        solids.append(Solid(f"pillar{number}_{k}", eased(shape, 0.15 * own.radius, "|Z", True), "steel", 0))
    last = len(own.journals)
    for k, journal in enumerate(own.journals, start=1):
        shape = _bearing(own, journal)
        if k in (1, last):
            solids.append(Solid(f"bearing{number}_{k}", shape, "aluminium", through_holes(shape)))
            continue
        x, y = own.plan.shaft.at
        upper, lower = split(shape, (x, y), _across(own), 20 * own.plan.journal + 4 * own.plan.swept)
        for name, half in (("bearing", lower), ("cap", upper)):
            solids.append(Solid(f"{name}{number}_{k}", half, "aluminium", through_holes(half)))
    return solids


def _across(own: Bearers) -> float:
    """Return the direction (rad) square to a line through the axis with arms on either side, clear of it."""
    x, y = own.plan.shaft.at
    arms = [math.atan2(v - y, u - x) for u, v in own.places]
    best, clear = 0.0, -1.0
    for turn in np.radians(np.arange(0, 180, 3)):
        sides = [math.sin(arm - turn) for arm in arms]
        if min(sides) < 0 < max(sides) and min(map(abs, sides)) > clear:
            best, clear = float(turn) + math.pi / 2, min(map(abs, sides))
    return best


def _bearing(own: Bearers, journal: Journal) -> cq.Workplane:
    plan = own.plan
    low, high = heights_of(plan, journal)
    x, y = plan.shaft.at
    thick = ARM * (high - low)
    middle = (low + high) / 2
    ring = extruded(outline.circle(x, y, own.hub), high - low, low)
    shape = first_made([partial(eased, ring, 0.03 * plan.unit, "|Z", True), lambda: ring])
    for u, v in own.places:
        arm = outline.hull([(x, y, 0.8 * own.hub), (u, v, BOSS * own.radius)])
        shape = shape.union(extruded(arm, thick, middle - thick / 2))
    tools = [(x, y, plan.journal + own.running), *((u, v, own.radius + SEAT) for u, v in own.places)]
    for u, v, radius in tools:
        shape = shape.cut(extruded(outline.circle(u, v, radius), high - low + 2, low - 1))
    return shape
