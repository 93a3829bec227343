"""Bodies without joints, weights, traced points and marks on rims."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from itertools import combinations
from typing import NamedTuple

import numpy as np

from mechanisms.stages.automatic.layout.items import Anchor, Heights, Item, Levels, Need, Reach
from mechanisms.stages.automatic.layout.layout import Feature, Layout
from mechanisms.stages.automatic.layout.plan import Plan
from mechanisms.stages.automatic.layout.planar import Rounded, disc
from mechanisms.stages.automatic.layout.sizes import holding
from mechanisms.stages.automatic.pins.pins import Pin
from mechanisms.stages.automatic.pins.springs import Stud
from shared.contract.materials import MATERIALS
from shared.shapes import outline
from shared.shapes.build import eased, extruded
from shared.shapes.link import Eye
from shared.shapes.outline import circle
from shared.shapes.pin import Head, pin, stylus
from shared.shapes.screw import ball
from shared.shapes.solid import placed

# Traced points on the rim of a wheel, a disc or a cam, where an eye would break teeth or meet the road.
#
# A brass pointer stands on a collar over the face of the wheel, its tip at the point; a pin within the rim holds it. It
# stays over what the wheel rolls on or meshes with. Where that gap has no room, the pin alone marks the radius of the
# point. Hub and pins of a small wheel may leave no room for either; then the film's trail alone shows the point.

HEIGHT, TIP = 1.4, 0.5
"""Height of a pointer, and radius of its tip (rmm)."""
SHANK, LEAST = 2.0, 0.5
"""Most and least radius of its pin (rmm)."""
WALL, BASE = 0.8, 0.8
"""Between the pin and the rim's end, and of the pointer round its pin (rmm)."""
BESIDE = 0.5
"""From the pointer to the hardware of a pin (rmm)."""
SEEN = 0.05
"""How far a pointer's tip stands out from its collar at least (rmm)."""


class Face(NamedTuple):
    """Face of a wheel in its body's frame (rmm): within ``inner`` it is solid and touches nothing.

    Beyond ``outer`` the body may have an arm.
    """

    x: float
    y: float
    inner: float
    outer: float = math.inf


@dataclass(frozen=True, eq=False)
class RimMark(Feature):
    """A traced point (rmm), and the place and radius of the pin in the rim; ``raised``: with its pointer."""

    name: str
    body: str
    x: float
    y: float
    at: tuple[float, float]
    radius: float
    raised: bool

    @property
    def points(self) -> bool:
        """True if there is a pointer: none where the pin is at the point."""
        return self.raised and math.dist(self.at, (self.x, self.y)) > TIP

    def anchors(self, layout: Layout) -> Iterable[Anchor]:
        """Return the pin, within the rim."""
        return [Anchor(self.body, *self.at, self.radius + WALL)]

    def items(self, layout: Layout) -> Iterable[Item]:
        """Yield the pointer, over the face of its wheel."""
        if self.points:
            shape = Rounded(np.array([self.at, (self.x, self.y)]), self.radius + BASE)
            own = frozenset(joint_pin.what for joint_pin in layout.select(Pin) if self._is_clear_of(joint_pin))
            yield Item(
                f"the pointer of {self.name}", self.body, shape, Reach((self.body,), 1, 1), source=self, meshes=own,
                spared=False,
            )  # fmt: skip

    def needs(self, levels: Levels, layout: Layout) -> Iterable[Need]:
        """Yield the room for the pointer."""
        level = levels[self.body]
        if self.points and layout.is_covered(self, 2 * (level + 1), levels, 1):
            fit = layout.sizes.pivot.fit
            yield Need(level, HEIGHT + 2 * fit.axial)

    def build(self, plan: Plan, heights: Heights) -> None:
        """Build a pin flush with the face, or a pointer with its shank."""
        fit, top, (x, y) = plan.layout.sizes.pivot.fit, heights.top(self.body), self.at
        plan.eye(self.body, x, y, Eye(self.radius + WALL, 2 * self.radius + fit.press))
        if not self.points:
            shape = pin(2 * self.radius, heights.thickness - 0.2, chamfer=0.15 * self.radius)
            plan.make(self.body, f"point_{self.name}", placed(shape, x, y, top - heights.thickness), "brass", 0)
            return
        needle = outline.hull([(x, y, self.radius + BASE), (self.x, self.y, TIP)])
        depth = heights.thickness - 0.4
        low = top + fit.axial
        shank = extruded(outline.circle(x, y, self.radius), low + 0.5 - (top - depth), top - depth)
        collar = extruded(outline.circle(x, y, self.radius + BASE), low + 0.5 - (top + fit.seat), top + fit.seat)
        shape = extruded(needle, HEIGHT, low).union(collar).union(shank)
        plan.make(self.body, f"pointer_{self.name}", shape, "brass", 0)

    def _is_clear_of(self, joint_pin: Pin) -> bool:
        """Return True if a pin of its body is near, from whose hardware it keeps away by its place."""
        return self.body in joint_pin.places and math.dist(joint_pin.places[self.body], self.at) < math.dist(
            joint_pin.places[self.body], (self.x, self.y)
        )


def face_at(body: str, x: float, y: float, layout: Layout) -> Face | None:
    """Return the face of the wheel whose rim or working surface an eye at a place would break."""
    eye = layout.sizes.stylus_eye
    for feature in layout.features:
        face_of = getattr(feature, "face_of", None)
        face = face_of(body, layout) if face_of else None
        if face is None:
            continue
        away = math.hypot(x - face.x, y - face.y)
        if face.inner < away + eye and away - eye < face.outer + layout.sizes.room:
            return face
    return None


def rim_mark(
    name: str, body: str, x: float, y: float, face: Face, taken: Sequence[Anchor], raised: bool, layout: Layout
) -> RimMark | None:
    """Return the mark, as near to the point as the rim leaves room; None where hub and pins leave none."""
    away, hardware = math.hypot(x - face.x, y - face.y), layout.sizes.hardware
    own = [anchor for anchor in taken if anchor.body == body]
    held = any(math.hypot(a.x - face.x, a.y - face.y) < 0.02 and a.radius > hardware for a in own)
    low, high = hardware + BESIDE + BASE if held else 0.0, face.inner - WALL
    radius = min(SHANK, (high - low) / 2)
    if radius < LEAST or away < radius:
        return None
    reach, hidden = min(high - radius, away), radius + BASE - TIP + SEEN
    if raised and TIP < away - reach < hidden:  # the tip would be under the collar
        inwards = away - radius - BASE
        reach, raised = (inwards, True) if inwards > low + radius else (reach, False)
    part = reach / away
    at = face.x + part * (x - face.x), face.y + part * (y - face.y)
    beside = [a for a in own if math.hypot(a.x - face.x, a.y - face.y) > 0.02]
    needed = radius + BASE + BESIDE
    if any(math.hypot(a.x - at[0], a.y - at[1]) < needed + min(a.radius, hardware) for a in beside):
        return None
    return RimMark(name, body, x, y, at, radius, raised)


# Bodies that no joint shapes: a ball where nothing holds them, a disc about the centre of mass where springs do.
#
#     r of a ball   (3 m / 4 pi rho)^(1/3)        r of a disc   (m / pi rho t)^(1/2)        rho of aluminium
#
# All are made smaller or larger by one factor, so that the largest has a size that suits the mechanism, and balls never
# meet on their ways if that can be helped. So sizes tell masses apart even where no such ball could weigh so much.

LARGEST = (14.0, 20.0)
"""Least and most radius of the largest (rmm)."""
LEAST_DISC = 6.0
APART = 0.9
"""Largest sum of the radii of two balls, as a part of their least distance."""
DENSITY = MATERIALS["aluminium"].density


@dataclass(frozen=True, eq=False)
class FreeBody(Feature):
    """A ball or disc of this radius about a body's centre of mass (rmm)."""

    body: str
    x: float
    y: float
    radius: float
    is_ball: bool

    def anchors(self, layout: Layout) -> Iterable[Anchor]:
        """Return an empty list: a disc is where its body's plate is."""
        return [] if self.is_ball else [Anchor(self.body, self.x, self.y, self.radius)]

    def items(self, layout: Layout) -> Iterable[Item]:
        """Yield a ball in its layer, and in the gaps beside that if it is thicker."""
        if self.is_ball:
            thick = int(self.over(layout) > 0)
            shape = disc(self.x, self.y, self.radius)
            yield Item(f"the ball {self.body}", self.body, shape, Reach((self.body,), -thick, thick), source=self)

    def over(self, layout: Layout) -> float:
        """Return how far a ball reaches beyond its layer (rmm)."""
        return self.radius - layout.sizes.thickness / 2 if self.is_ball else 0.0

    def needs(self, levels: Levels, layout: Layout) -> Iterable[Need]:
        """Yield the room for a ball above and below its layer."""
        if self.over(layout) > 0:
            for gap in (levels[self.body] - 1, levels[self.body]):
                yield Need(gap, self.over(layout) + layout.sizes.pivot.fit.axial)

    def build(self, plan: Plan, heights: Heights) -> None:
        """Build the whole body, or the plate round its centre of mass."""
        if self.is_ball:
            shape = ball(self.radius).translate((self.x, self.y, heights.thickness / 2))
        else:
            shape = eased(extruded(circle(self.x, self.y, self.radius), heights.thickness), 0.8)
        plan.plate(self.body, shape, (self.x, self.y, self.radius))


def free_bodies(layout: Layout) -> list[Feature]:
    """Return one for each body without a joint or a shape of its own."""
    m = layout.m
    shaped = {body for thing in holding(m) for body in thing.bodies}
    others = [feature for feature in layout.features if not isinstance(feature, Stud)]
    shaped |= {item.body for feature in others for item in feature.items(layout)}
    names = [name for name in layout.bodies if name not in shaped]
    if not names:
        return []
    held = {a.body for feature in layout.features for a in feature.anchors(layout)}
    scale = layout.sizes.scale * 1e-3
    radii = {}
    for name in names:
        mass = m.bodies[name].mass
        if name in held:
            radii[name] = math.sqrt(mass / (math.pi * DENSITY * layout.sizes.thickness * scale)) / scale
        else:
            radii[name] = (3 * mass / (4 * math.pi * DENSITY)) ** (1 / 3) / scale
    largest = max(radii.values())
    factor = min(max(largest, LARGEST[0]), LARGEST[1]) / largest if largest > 0 else 0.0
    radii = {name: max(factor * radius, LEAST_DISC) for name, radius in radii.items()}
    places = {name: _place(layout, name) for name in names}
    ways = {name: layout.seen(name, places[name], "ground") for name in names}
    crowded = [
        APART * float(np.linalg.norm(ways[a] - ways[b], axis=1).min()) / (radii[a] + radii[b])
        for a, b in combinations([name for name in names if name not in held], 2)
    ]
    shrink = max(min([1.0, *crowded]), LEAST_DISC / LARGEST[1])
    features: list[Feature] = []
    for name in names:
        radius = radii[name] if name in held else radii[name] * shrink
        features.append(FreeBody(name, *places[name], radius, name not in held))
    return features


def _place(layout: Layout, name: str) -> tuple[float, float]:
    x, y = layout.m.bodies[name].com
    return layout.sizes.of_metres(x), layout.sizes.of_metres(y)


# Points that no joint shapes: traced points get a stylus, free ends of bars and lone centres of mass a weight.

STYLUS_SHANK = 4.0
"""Diameter of what holds a stylus (rmm)."""
STYLUS = 14.4
"""Height of a stylus above its plate (rmm), at least."""
BOSS = 1.5
WEIGHT = 4.0
"""Height of a weight above its plate (rmm)."""


@dataclass(frozen=True, eq=False)
class Stylus(Feature):
    """A traced point: a brass tip where all above can pass, else a brass pin flush with the plate."""

    name: str
    body: str
    x: float
    y: float
    tall: bool

    def anchors(self, layout: Layout) -> Iterable[Anchor]:
        """Return a small eye."""
        return [Anchor(self.body, self.x, self.y, layout.sizes.stylus_eye)]

    def items(self, layout: Layout) -> Iterable[Item]:
        """Return all above it, if it is tall."""
        if not self.tall:
            return []
        shape = disc(self.x, self.y, layout.sizes.stylus_eye - 1.0)
        return [Item(f"the stylus of {self.name}", self.body, shape, Reach((self.body,), 1, top=True), source=self)]

    def build(self, plan: Plan, heights: Heights) -> None:
        """Build the stylus in an eye."""
        press = plan.layout.sizes.pivot.fit.press
        seat, top = plan.layout.sizes.pivot.fit.seat, heights.top(self.body)
        if not self.tall:
            plan.eye(self.body, self.x, self.y, Eye(7.0, STYLUS_SHANK + press))
            shape = pin(STYLUS_SHANK, heights.thickness - 0.2, chamfer=0.3)
            plan.make(
                self.body, f"point_{self.name}", placed(shape, self.x, self.y, top - heights.thickness), "brass", 0
            )
            return
        plan.eye(self.body, self.x, self.y, Eye(7.0, STYLUS_SHANK + press, above=BOSS, boss=5.2))
        highest = heights.bottoms[-1] + heights.thickness + 6.0
        height = max(STYLUS, highest - top - BOSS)
        shape = stylus(STYLUS_SHANK, heights.thickness + 1.0, height, 0.9)
        plan.make(self.body, f"stylus_{self.name}", placed(shape, self.x, self.y, top + BOSS + seat), "brass", 0)


@dataclass(frozen=True, eq=False)
class Weight(Feature):
    """A brass weight at the free end of a bar, or at the centre of mass of a body with one joint."""

    body: str
    x: float
    y: float

    def anchors(self, layout: Layout) -> Iterable[Anchor]:
        """Return an eye as large as a joint's."""
        return [Anchor(self.body, self.x, self.y, layout.sizes.eye)]

    def items(self, layout: Layout) -> Iterable[Item]:
        """Return the weight's head above the plate."""
        shape = disc(self.x, self.y, layout.sizes.eye)
        return [Item(f"the weight of {self.body}", self.body, shape, Reach((self.body,), 1, 1), source=self)]

    def needs(self, levels: Levels, layout: Layout) -> Iterable[Need]:
        """Yield the room for its head."""
        level = levels[self.body]
        if layout.is_covered(self, 2 * (level + 1), levels, 1):
            yield Need(level, WEIGHT + layout.sizes.pivot.fit.seat + layout.sizes.pivot.fit.axial)

    def build(self, plan: Plan, heights: Heights) -> None:
        """Build a plug with a wide head."""
        sizes = plan.layout.sizes
        fit = sizes.pivot.fit
        plan.eye(self.body, self.x, self.y, Eye(sizes.eye, sizes.pivot.held))
        head = Head(2 * sizes.eye - 3.0, WEIGHT, 1.6)
        bolt = pin(sizes.pivot.pin, heights.thickness - 0.3 + fit.seat, head)
        plan.make(
            self.body, f"weight_{self.body}", placed(bolt, self.x, self.y, heights.bottom(self.body) + 0.3), "brass", 0
        )


def styluses(layout: Layout, tall: bool, pointers: bool) -> list[Feature]:
    """Return a stylus for every traced point of a moving body, except on balls, eyes and weights.

    Points on rims get marks there, with ``pointers`` where these are wanted.
    """
    features: list[Feature] = []
    balls = {feature.body for feature in layout.select(FreeBody) if feature.is_ball}
    taken = [a for feature in layout.features for a in feature.anchors(layout)]
    for name, marker in layout.m.traces.items():
        body, (x, y) = marker.body.name, layout.place(marker)
        near = layout.sizes.eye + layout.sizes.stylus_eye
        face = face_at(body, x, y, layout) if body in layout.moving else None
        if face is not None:
            mark = rim_mark(name, body, x, y, face, taken, pointers, layout)
            features += [mark] if mark else []
            continue
        if (
            body not in layout.moving
            or body in balls
            or any(a.body == body and math.hypot(a.x - x, a.y - y) < near for a in taken)
        ):
            continue
        features.append(Stylus(name, body, x, y, tall))
    return features


def weights(layout: Layout, heavy: bool) -> list[Feature]:
    """Return weights for bars with a free end, and for bodies with one joint and their mass elsewhere.

    Wheels and tyres get none.

    ``heavy``: only for ends of bars where their centre of mass is, even if they are traced.
    """
    features: list[Feature] = []
    free = {feature.body for feature in layout.select(FreeBody)}
    round_bodies = {*layout.wheels, *(body for body, _, _ in layout.rounds)}
    taken = [a for feature in layout.features for a in feature.anchors(layout)]
    for name in layout.bodies:
        body = layout.m.bodies[name]
        here = [a for a in taken if a.body == name]
        centre = _place(layout, name)
        if body.length is not None:
            ends = [(0.0, 0.0), (layout.sizes.of_metres(body.length), 0.0)]
        elif len(here) < 2 and name not in free and name not in round_bodies:
            ends = [centre]
        else:
            continue
        for x, y in ends:
            if heavy and (body.length is None or math.dist((x, y), centre) > layout.sizes.eye):
                continue
            if all(math.hypot(a.x - x, a.y - y) > 2 * layout.sizes.eye for a in here):
                features.append(Weight(name, x, y))
    return features
