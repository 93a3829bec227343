"""Bodies that look like what they are: pistons in cylinders, wheels with rims, bobs, buckets and handles."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Collection, Iterable, Mapping
from dataclasses import dataclass

import cadquery as cq
import numpy as np

from mbsd import Mechanism
from mbsd.model.body import HIDDEN
from mechanisms.stages.automatic.layout.items import Anchor, Heights, Item, Reach
from mechanisms.stages.automatic.layout.layout import Feature, Layout
from mechanisms.stages.automatic.layout.plan import Foot, Plan
from mechanisms.stages.automatic.layout.planar import Rounded, box, convex_hull
from mechanisms.stages.automatic.pins.pins import pins_on
from mechanisms.stages.automatic.slides.slides import HALF_LENGTH, RAIL, Slide
from shared.shapes.build import eased, extruded
from shared.shapes.kernel import first_sound
from shared.shapes.outline import Point, circle, hull
from shared.stage.errors import UserError, did_you_mean

# Which body looks like what: by the keyword ``looks`` of mechanism.py, else by the last word of its name.

WORDS: Mapping[str, tuple[str, ...]] = {
    "piston": ("piston", "plunger"),
    "wheel": ("wheel",),
    "tyre": ("tyre", "tire"),
    "flywheel": ("flywheel",),
    "drum": ("drum",),
    "bob": ("bob", "weight", "counterweight"),
    "bucket": ("bucket", "scoop", "shovel"),
    "handle": ("handle", "grip", "pedal"),
}
"""Looks of bodies, and the words of names that say so."""
PLAIN = "plate"
"""The look of a body that is what it would be without a name."""
KNOWN = (*WORDS, PLAIN, HIDDEN)


def looks_of(m: Mechanism) -> dict[str, str]:
    """Return what each body that has a look of its own looks like.

    Raises UserError for a keyword that is none, with those that there are.
    """
    meant = {word: look for look, words in WORDS.items() for word in words}
    looks: dict[str, str] = {}
    for name, body in m.bodies.items():
        if body.looks and body.looks not in KNOWN:
            raise UserError(
                f"{m.name}: body '{name}' looks like '{body.looks}'; there is: {', '.join(KNOWN)}"
                f"{did_you_mean(body.looks, KNOWN)}"
            )
        words = re.findall(r"[a-z]+", name.lower())
        look = body.looks or (meant.get(words[-1], "") if words else "")
        if name != "ground" and look not in ("", PLAIN, HIDDEN):
            looks[name] = look
    return looks


# One outline that is part of a body's plate (rmm).


@dataclass(frozen=True, eq=False)
class Look(Feature):
    """An outline of a body's plate; eyes within ``holds`` (x, y, radius) need no link."""

    body: str
    looks: str
    wire: cq.Wire
    points: np.ndarray
    holds: tuple[float, float, float]

    @property
    def what(self) -> str:
        """Name of its item."""
        return f"the {self.looks} {self.body}"

    @property
    def shape(self) -> Rounded:
        """Hull in the plane."""
        return Rounded(convex_hull(self.points), 0.0)

    def items(self, layout: Layout) -> Iterable[Item]:
        """Return its convex hull at the height of the plate."""
        return [Item(self.what, self.body, self.shape, Reach((self.body,)), source=self)]

    def build(self, plan: Plan, heights: Heights) -> None:
        """Build a part of the plate."""
        plain = extruded(self.wire, heights.thickness)
        made = first_sound([lambda edge=edge: eased(plain, edge) for edge in (0.8, 0.3)])
        plan.plate(self.body, plain if made is None else made, self.holds)


# A piston, which is wide and has grooves for its rings, and its cylinder: cut open, so that one sees the piston.
#
#        fins |=|     |=|
#             | |_____| |     the head, beyond the way of piston and rail
#             |  _____  |
#             | |     | |     the piston between two walls, in its layer
#
# Walls stand on the base. The piston still runs on the rail of its slide, which is between them.

HALF_BORE = 18.0
"""Half of a piston's width (rmm)."""
RINGS, RING, GROOVE = (5.0, 10.0), 2.4, 1.3
"""Distances of two rings from the crown, their width, and the depth of their grooves."""
WALL, HEAD = 4.5, 8.0
"""Thickness of the walls, and of the head."""
FIN, PITCH = 4.5, 8.0
"""How far fins stand out, and the distance from one to the next."""
DEAD = 2.0
"""Room between the rail's end and the head."""
SKIRT = 5.0
"""How much of the piston looks out of the cylinder at its lowest place."""


@dataclass(frozen=True, eq=False)
class Cylinder(Feature):
    """Two walls and a head about the way of a piston."""

    slide: Slide
    side: float
    """1 if the crown is ahead along the slide's line, -1 if behind."""
    crown: float
    """How far the piston's plate reaches towards the head from its middle."""

    @property
    def what(self) -> str:
        """Name of its items."""
        return f"the cylinder of {self.slide.block}"

    def place(self, along: float, aside: float) -> Point:
        """Return a place of ground, along the line towards the head and beside it."""
        x, y, angle = self.slide.rail_at
        c, s = math.cos(angle), math.sin(angle)
        return x + self.side * along * c - aside * s, y + self.side * along * s + aside * c

    @property
    def reach(self) -> tuple[float, float]:
        """Where walls begin and where they meet the head, along the line."""
        low, high = self.slide.travel if self.side > 0 else (-self.slide.travel[1], -self.slide.travel[0])
        return low - HALF_LENGTH + SKIRT, high + max(HALF_LENGTH + RAIL / 2, self.crown) + DEAD

    def inner(self, layout: Layout) -> float:
        """Return half of the bore."""
        return HALF_BORE + layout.sizes.pivot.fit.axial

    def items(self, layout: Layout) -> Iterable[Item]:
        """Yield walls and head, which keep all but their piston away."""
        slide, (low, top) = self.slide, self.reach
        inner, outer = self.inner(layout), self.inner(layout) + WALL + FIN
        own = frozenset(
            (slide.block, f"the piston {slide.block}", f"the block of {slide.name}", f"the rail of {slide.name}")
        )
        middle, along = self.place(0.0, 0.0), self._along
        for first, last, aside, half in (
            (low, top + HEAD, (inner + outer) / 2, (outer - inner) / 2),
            (low, top + HEAD, -(inner + outer) / 2, (outer - inner) / 2),
            (top, top + HEAD, 0.0, outer),
        ):
            at = middle[0] - aside * along[1] * self.side, middle[1] + aside * along[0] * self.side
            shape = box(at, along, first, last, half)
            reach = Reach((slide.block,), 0, 0, base=True)
            yield Item(self.what, "ground", shape, reach, source=self, meshes=own, stands=f"the rail of {slide.name}")

    @property
    def _along(self) -> Point:
        angle = self.slide.rail_at[2]
        return self.side * math.cos(angle), self.side * math.sin(angle)

    def build(self, plan: Plan, heights: Heights) -> None:
        """Build walls, fins and head as one piece on the base."""
        inner, (low, top) = self.inner(plan.layout), self.reach
        outer = inner + WALL
        corners: list[Point] = [(low, inner), (low, outer)]
        at = low + PITCH / 2
        while at + PITCH / 2 < top + HEAD:
            corners += [(at, outer), (at, outer + FIN), (at + PITCH / 2, outer + FIN), (at + PITCH / 2, outer)]
            at += PITCH
        corners += [(top + HEAD, outer)]
        corners = [*corners, *((u, -v) for u, v in reversed(corners)), (top, -inner), (top, inner)]
        seat = plan.layout.sizes.pivot.fit.seat
        wire = cq.Wire.makePolygon([cq.Vector(*self.place(u, v), 0.0) for u, v in corners], close=True)
        shape = extruded(wire, heights.top(self.slide.block) - seat, seat)
        plan.make("ground", f"cylinder_{self.slide.block}", shape, "aluminium", 0)
        plan.feet += [Foot("", *self.place(u, v), WALL) for u in (low, top + HEAD) for v in (-outer, outer)]


def _piston(body: str, layout: Layout) -> list[Feature]:
    """Return a piston and its cylinder, for a body that slides on ground by itself; else nothing.

    A body with a place beside the bore, such as the arm of a crosshead, would not fit between the walls.
    """
    slides = [slide for slide in layout.select(Slide) if slide.block == body and slide.rail == "ground"]
    if len(slides) != 1 or slides[0].host or slides[0].guests or any(end is not None for end in slides[0].ends):
        return []
    slide = slides[0]
    x, y, angle = slide.block_at
    c, s = math.cos(angle), math.sin(angle)
    beyond = []
    for own in pins_on(layout, body):
        for other in (name for name in own.movers if name != body):
            places = [pin.places[other] for pin in pins_on(layout, other) if pin is not own]
            beyond += [layout.seen(other, place, body).mean(axis=0) for place in places]
    away = float(np.mean([(u - x) * c + (v - y) * s for u, v in beyond])) if beyond else -1.0
    side = -1.0 if away > 0 else 1.0
    own = [((a.x - x) * c + (a.y - y) * s, (a.y - y) * c - (a.x - x) * s, a.radius) for a in _own_anchors(body, layout)]
    if any(abs(aside) + radius > HALF_BORE for _, aside, radius in own):
        return []
    crown = max([side * along + radius for along, _, radius in own], default=0.0)
    half = [(-HALF_LENGTH, HALF_BORE - 1.0), (-HALF_LENGTH + 1.0, HALF_BORE)]
    for ring in reversed(RINGS):
        low = HALF_LENGTH - ring - RING / 2
        half += [(low, HALF_BORE), (low, HALF_BORE - GROOVE), (low + RING, HALF_BORE - GROOVE), (low + RING, HALF_BORE)]
    half += [(HALF_LENGTH - 1.0, HALF_BORE), (HALF_LENGTH, HALF_BORE - 1.0)]
    local = [*half, *((u, -v) for u, v in reversed(half))]
    points = np.array([(x + side * u * c - v * s, y + side * u * s + v * c) for u, v in local])
    wire = cq.Wire.makePolygon([cq.Vector(float(u), float(v), 0.0) for u, v in points], close=True)
    return [Look(body, "piston", wire, points, (x, y, HALF_BORE - GROOVE)), Cylinder(slide, side, crown)]


# Wheels: a disc about a pin, with a pocket between hub and rim; a tyre has a ring of rubber round it.

RIM, POCKET = 7.0, 2.2
"""Width of the rim, and depth of the pocket in the upper face."""
BEYOND = 4.0
"""How far the rim is beyond what the body carries."""
LEAST_RADIUS = {"wheel": 30.0, "tyre": 30.0, "flywheel": 42.0, "drum": 26.0}
RUBBER = 6.0
"""Thickness of a tyre."""


@dataclass(frozen=True, eq=False)
class Wheel(Look):
    """A disc of ``radius`` about ``holds``."""

    radius: float = 0.0

    def build(self, plan: Plan, heights: Heights) -> None:
        """Build the disc with its pocket, and a tyre."""
        x, y, _ = self.holds
        plain = extruded(circle(x, y, self.radius), heights.thickness)
        plan.plate(self.body, eased(plain, 0.8), (x, y, self.radius - 1.0))
        eyes = [(a.x, a.y, a.radius) for a in plan.layout.anchors[self.body]]
        hub = max([r for u, v, r in eyes if math.hypot(u - x, v - y) < 0.02], default=plan.layout.sizes.eye) + 2.0
        inner = self.radius - RIM
        if self.looks != "drum" and inner > hub + 3.0:
            depth = heights.thickness - POCKET
            tool = extruded(circle(x, y, inner), POCKET + 1.0, depth).cut(
                extruded(circle(x, y, hub), 20.0, depth - 5.0)
            )
            for u, v, r in eyes:
                if math.hypot(u - x, v - y) >= 0.02:
                    tool = tool.cut(extruded(circle(u, v, r + 1.0), 20.0, depth - 5.0))
            plan.cut(self.body, tool, 0)
        if self.looks == "tyre":
            seat = plan.layout.sizes.pivot.fit.seat
            ring = extruded(circle(x, y, self.radius + RUBBER), heights.thickness, heights.bottom(self.body),
                            [circle(x, y, self.radius + seat)])  # fmt: skip
            plan.make(self.body, f"tyre_{self.body}", ring, "rubber", 1)


def _wheel(looks: str) -> Callable[[str, Layout], list[Feature]]:
    def wheel(body: str, layout: Layout) -> list[Feature]:
        """Return a disc about the pin on ground, or the only one; nothing for what is a wheel already."""
        pins = pins_on(layout, body)
        hub = next((pin for pin in pins if pin.on_ground), pins[0] if len(pins) == 1 else None)
        filled = any(getattr(feature, "fills", "") == body for feature in layout.features)
        if hub is None or filled or layout.wheels.get(body) or any(key[0] == body for key in layout.rounds):
            return []
        x, y = hub.places[body]
        radius = max([LEAST_RADIUS[looks], *(math.hypot(a.x - x, a.y - y) + a.radius + BEYOND
                                             for a in _own_anchors(body, layout))])  # fmt: skip
        turn = np.linspace(0.0, 2 * np.pi, 48, endpoint=False)
        outer = radius + (RUBBER if looks == "tyre" else 0.0)
        points = np.stack([x + outer * np.cos(turn), y + outer * np.sin(turn)], axis=1)
        return [Wheel(body, looks, circle(x, y, radius), points, (x, y, radius), radius)]

    return wheel


# What ends a body: a bob about its centre of mass, a bucket, a handle.

BOB = 20.0
"""Radius of a bob (rmm)."""
GRIP = (17.0, 5.5)
"""Half length and radius of a handle, across the body."""
BELLY, LIP = 0.55, -0.08
"""How far the back of a bucket bulges, and its other side, as parts of its length: the plate's link is within."""


def _own_anchors(body: str, layout: Layout) -> list[Anchor]:
    return [anchor for feature in layout.features for anchor in feature.anchors(layout) if anchor.body == body]


def _end(body: str, layout: Layout) -> tuple[Point, Point] | None:
    """Return the middle of a body's pins and the place farthest from it; None of a body without pins."""
    pins = [pin.places[body] for pin in pins_on(layout, body)]
    if not pins:
        return None
    own = layout.m.bodies[body]
    places = [(a.x, a.y) for a in _own_anchors(body, layout)]
    places.append((layout.sizes.of_metres(own.com[0]), layout.sizes.of_metres(own.com[1])))
    if own.length is not None:
        places.append((layout.sizes.of_metres(own.length), 0.0))
    x, y = (float(value) for value in np.mean(pins, axis=0))
    end = max(places, key=lambda place: math.dist(place, (x, y)))
    return ((x, y), end) if math.dist(end, (x, y)) > layout.sizes.eye else None


def _bob(body: str, layout: Layout) -> list[Feature]:
    """Return a disc at the end of a body; nothing where a pin is there."""
    ends = _end(body, layout)
    if ends is None or any(math.dist(pin.places[body], ends[1]) < BOB for pin in pins_on(layout, body)):
        return []
    (x, y), turn = ends[1], np.linspace(0.0, 2 * np.pi, 32, endpoint=False)
    points = np.stack([x + BOB * np.cos(turn), y + BOB * np.sin(turn)], axis=1)
    return [Look(body, "bob", circle(x, y, BOB), points, (x, y, BOB))]


def _bucket(body: str, layout: Layout) -> list[Feature]:
    """Return a crescent from the pins to the farthest place."""
    ends = _end(body, layout)
    if ends is None:
        return []
    start, tip = (np.array(place) for place in ends)
    way = tip - start
    aside = np.array([-way[1], way[0]])
    u = np.linspace(0.0, 1.0, 13)[:, None]
    back, hollow = (start + u * way + 4 * u * (1 - u) * bulge * aside for bulge in (BELLY, LIP))
    points = np.concatenate([back, hollow[-2:0:-1]])
    wire = cq.Wire.makePolygon([cq.Vector(float(a), float(b), 0.0) for a, b in points], close=True)
    middle = (back[6] + hollow[6]) / 2
    return [Look(body, "bucket", wire, points, (float(middle[0]), float(middle[1]), 0.0))]


def _handle(body: str, layout: Layout) -> list[Feature]:
    """Return a grip across the end of a body."""
    ends = _end(body, layout)
    if ends is None:
        return []
    (x, y), (u, v) = ends
    length = math.hypot(u - x, v - y)
    across, (half, radius) = np.array([-(v - y), u - x]) / length, GRIP
    tips = [(u + k * half * across[0], v + k * half * across[1], radius) for k in (-1.0, 1.0)]
    turn = np.linspace(0.0, 2 * np.pi, 16, endpoint=False)
    points = np.array([(a + r * math.cos(t), b + r * math.sin(t)) for a, b, r in tips for t in turn])
    return [Look(body, "handle", hull(tips), points, (u, v, radius))]


SHAPES: dict[str, Callable[[str, Layout], list[Feature]]] = {
    "piston": _piston,
    "bob": _bob,
    "bucket": _bucket,
    "handle": _handle,
    **{look: _wheel(look) for look in LEAST_RADIUS},
}


def shaped(layout: Layout, taken: Collection[str]) -> list[Feature]:
    """Return the features of all bodies that have a look, but those that are ``taken``: an author shapes them."""
    looks = looks_of(layout.m)
    return [
        feature
        for body, look in looks.items()
        if body not in taken and body not in layout.apart
        for feature in SHAPES[look](body, layout)
    ]
