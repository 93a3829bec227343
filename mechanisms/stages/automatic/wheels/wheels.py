"""Toothed and plain wheels: their sizes, and the solids of gears."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass, field
from functools import singledispatch
from itertools import pairwise
from typing import Protocol

import cadquery as cq
import numpy as np

from mechanisms.stages.automatic.layout.items import Anchor, Heights, Item, Reach
from mechanisms.stages.automatic.layout.layout import Carrier, Feature, Layout
from mechanisms.stages.automatic.layout.plan import Foot, Plan, build
from mechanisms.stages.automatic.layout.planar import Rounded, disc, least_gap
from mechanisms.stages.automatic.pins.free_bodies import Face
from mechanisms.stages.automatic.pins.pins import pins_at
from shared.shapes.build import extruded, turned
from shared.shapes.involute import DEDENDUM, toothed, wire
from shared.shapes.link import Eye
from shared.shapes.outline import circle
from shared.shapes.solid import placed

# A wheel: its teeth in numbers, its layer, what room it takes. External wheels, and rings with teeth inside.
#
# A moving body has one wheel in its own layer, the largest. Each other one (a stepped gear) lies in a layer of its own
# on a tube that leaves the hardware of the body's pins free. A ring that turns is the rim of a cup: the bottom is its
# body's plate, the wall reaches to the layer of the teeth. Wheels of ground stand on posts.

SECTORS = 36
"""Pieces of an annulus in the plane."""
RIM = 7.0
"""Width of a ring gear outside its teeth (rmm)."""
TUBE = (10.2, 13.2)
"""Inner and outer radius of what carries a wheel in a layer of its own: inside is room for a pin's hardware."""
CROSSES = (45, 60, 30, 75, 15, 0)
"""Angles (degrees) of the posts of a ring on ground that are tried, the most wanted first."""
LEAST, LEAST_ON_TUBE = 15.2, 18.0
"""Least pitch radii (rmm): a pin and its flanges, or a tube, stay inside of the teeth."""


class Mate(Protocol):
    """An element that meshes with a wheel: another wheel, or a rack."""

    @property
    def what(self) -> str:
        """In messages."""
        ...


@dataclass(eq=False)
class Wheel(Feature):
    """One wheel (rmm, rad in its body's frame)."""

    name: str
    body: str
    x: float
    y: float
    radius: float
    ring: bool = False
    teeth: int = 0
    module: float = 0.0
    tip: float = 0.0
    play: float = 0.0
    phase: float | None = None
    mates: list[Mate] = field(default_factory=list)
    shares: bool = True
    """True if it lies in its body's layer."""

    @property
    def layer(self) -> str:
        """Name that decides the layer: that of the body, or its own."""
        return self.body if self.shares and self.body != "ground" else self.what

    @property
    def what(self) -> str:
        """In messages."""
        return f"the {'ring' if self.ring else 'wheel'} of {self.body} at {self.name}"

    @property
    def root(self) -> float:
        """Radius where its teeth begin."""
        return self.radius + (DEDENDUM if self.ring else -DEDENDUM) * self.module

    @property
    def outside(self) -> float:
        """Its outer radius."""
        return self.root + RIM if self.ring else self.tip

    @property
    def pitch(self) -> float:
        """The angle of a tooth and a space (rad)."""
        return 2 * math.pi / self.teeth

    def anchors(self, layout: Layout) -> Iterable[Anchor]:
        """Return anchors of what carries the wheel; the wheel is no part of the outline."""
        if self.body == "ground":
            return [Anchor("ground", self.x, self.y, self.outside)]
        if self.ring:
            return [Anchor(self.body, self.x, self.y, layout.sizes.eye)]
        return [] if self.shares else [Anchor(self.body, self.x, self.y, TUBE[1])]

    def items(self, layout: Layout) -> Iterable[Item]:
        """Yield a disc, or an annulus in pieces, and what carries it."""
        reach, spares = Reach((self.layer,)), frozenset[str]()
        meshes = frozenset(mate.what for mate in self.mates)
        if not self.ring:
            on_tube = self.body != "ground" and not self.shares
            if on_tube:  # it goes round the pins there
                meshes |= {pin.what for pin in pins_at(layout, self.body, (self.x, self.y))}
            teeth = disc(self.x, self.y, self.tip)
            yield Item(self.what, self.body, teeth, reach, spares, self, meshes, spared=not on_tube)
            if self.body == "ground":
                post = disc(self.x, self.y, self.root - 1.0)
                yield Item(self.what, self.body, post, Reach((self.layer,), -1, -1, base=True), spares, self, meshes)
            elif on_tube:
                tube, between = disc(self.x, self.y, TUBE[1]), Reach((self.body, self.layer), 1, -1)
                yield Item(f"the tube of {self.what}", self.body, tube, between, spares, self, meshes, spared=False)
            return
        if self.body != "ground":
            reach = Reach((self.body, self.layer))
            cup = disc(self.x, self.y, self.outside)
            yield Item(f"the bottom of {self.what}", self.body, cup, Reach((self.body,)), source=self)
        middle, half = (self.outside + self.tip) / 2, (self.outside - self.tip) / 2
        angles = np.linspace(0, 2 * np.pi, SECTORS + 1)
        places = np.column_stack([self.x + middle * np.cos(angles), self.y + middle * np.sin(angles)])
        for a, b in pairwise(places):
            yield Item(self.what, self.body, Rounded(np.array([a, b]), half), reach, spares, self, meshes)
        if self.body == "ground":
            for x, y in self.posts(layout):
                reach = Reach((self.layer,), -1, -1, base=True)
                yield Item(f"a post of {self.what}", self.body, disc(x, y, RIM), reach, spares, self, meshes)

    def face_of(self, body: str, layout: Layout) -> Face | None:
        """Return the disc within its teeth, where it is its body's plate."""
        if body != self.body or self.ring or not self.shares:
            return None
        fills = any(getattr(feature, "fills", "") == body for feature in layout.features)
        in_ring = any(isinstance(mate, Wheel) and mate.ring for mate in self.mates)  # an arm would meet its teeth
        return None if fills else Face(self.x, self.y, self.root, math.inf if in_ring else max(self.tip, self.radius))

    def posts(self, layout: Layout) -> list[tuple[float, float]]:
        """Return posts under the rim of a ring fixed to ground: a cross that the fewest bodies come near."""
        return min((self._cross(degrees) for degrees in CROSSES), key=lambda cross: _near(cross, layout))

    def _cross(self, degrees: float) -> list[tuple[float, float]]:
        at = self.outside - RIM / 2
        angles = [math.radians(degrees + quarter) for quarter in (0, 90, 180, 270)]
        return [(self.x + at * math.cos(a), self.y + at * math.sin(a)) for a in angles]


def _near(posts: list[tuple[float, float]], layout: Layout) -> int:
    """Return how many pairs of a post and a body's plate meet in the plane at some time."""
    plates = [(layout.outline(body), layout.poses[body]) for body in layout.moving if layout.anchors[body]]
    still = layout.poses["ground"]
    room = layout.sizes.room
    gaps = (least_gap(disc(x, y, RIM), plate, (still, poses), room)[0] for x, y in posts for plate, poses in plates)
    return sum(gap < room for gap in gaps)


# The solids of wheels (rmm): a toothed disc with a milled-out web, a ring or a cup, and what holds them.

WEB = 2.0
"""Depth to which a web is milled out on both faces."""
HUB = 14.0
"""Radius of a hub that stays."""
RIM_WALL = 4.0
POST = 3.2
"""Radius of a post under a ring: it stays under the rim, out of the way of planets that are as high as its top."""
WINDOWS = 5
"""In the bottom of a cup."""
BESIDE = 36.0
"""How far inside of a cup's rim the base plate counts it as standing."""


@build.register(Wheel)
def build_wheel(wheel: Wheel, plan: Plan, heights: Heights) -> None:
    """Give the plan the wheel as its body's plate, on its body's plate, or as a piece of the ground."""
    if wheel.body == "ground":
        _on_ground(wheel, plan, heights)
    elif wheel.ring:
        _cup(wheel, plan, heights)
    elif wheel.shares:
        plan.wheels[wheel.body] = wheel
    else:
        _on_tube(wheel, plan, heights)


def _on_ground(wheel: Wheel, plan: Plan, heights: Heights) -> None:
    thickness, seat = heights.thickness, plan.layout.sizes.pivot.fit.seat
    z = heights.bottom(wheel.layer)
    shape, holes = shape_of(wheel, thickness, [])
    if not wheel.ring:
        pivot, here = plan.layout.sizes.pivot, (wheel.x, wheel.y)
        bore = pivot.held if pins_at(plan.layout, "ground", here) else pivot.bushing + 1.0
        shape = shape.cut(extruded(circle(0, 0, bore / 2), thickness + 2, -1.0))
        post = extruded(circle(0, 0, wheel.root - 1.5), z - 2 * seat, seat, [circle(0, 0, bore / 2)])
        plan.make("ground", f"post_{wheel.name}", placed(post, wheel.x, wheel.y), "aluminium", 1)
        plan.feet.append(Foot("", wheel.x, wheel.y, wheel.root))
        holes += 1
    for k, (x, y) in enumerate(wheel.posts(plan.layout) if wheel.ring else []):
        post = extruded(circle(0, 0, POST), z - 2 * seat, seat)
        plan.make("ground", f"post_{wheel.name}_{k + 1}", placed(post, x, y), "steel", 0)
        plan.feet.append(Foot("", x, y, 6.0))
    plan.make("ground", f"gear_{wheel.name}", placed(shape, wheel.x, wheel.y, z), "aluminium", holes)


def _on_tube(wheel: Wheel, plan: Plan, heights: Heights) -> None:
    """A wheel in a layer of its own: one piece with the tube that reaches to its body's plate."""
    inner, outer = TUBE
    thickness = heights.thickness
    shape, windows = shape_of(wheel, thickness, [(0.0, 0.0, Eye(outer, 0.0))])
    low, high = heights.between(wheel.body, wheel.layer, plan.layout.sizes.pivot.fit.seat, 0.0)
    z = heights.bottom(wheel.layer)
    if high > low:
        tube = extruded(circle(0, 0, outer), high - low + 1.0, low - z - (1.0 if low > z else 0.0))
        shape = shape.union(tube)
    shape = shape.cut(extruded(circle(0, 0, inner), high - low + thickness + 4.0, min(low - z, 0.0) - 2.0))
    plan.make(wheel.body, f"gear_{wheel.name}", placed(shape, wheel.x, wheel.y, z), "aluminium", 1 + windows)


def _cup(wheel: Wheel, plan: Plan, heights: Heights) -> None:
    """A ring that turns: rim and wall are a piece, the bottom is the body's plate."""
    thickness = heights.thickness
    shape, holes = shape_of(wheel, thickness, [])
    low, high = heights.between(wheel.body, wheel.layer, plan.layout.sizes.pivot.fit.seat, 0.0)
    z = heights.bottom(wheel.layer)
    if high > low:
        wall = extruded(circle(0, 0, wheel.outside), high - low, low - z, [circle(0, 0, wheel.root)])
        shape = shape.union(wall)
    plan.make(wheel.body, f"ring_{wheel.name}", placed(shape, wheel.x, wheel.y, z), "aluminium", holes)
    bottom = extruded(circle(0, 0, wheel.outside), thickness).faces("|Z").edges().chamfer(0.4)
    alone = all(math.hypot(a.x - wheel.x, a.y - wheel.y) < 0.01 for a in plan.layout.anchors[wheel.body])
    eye = plan.layout.sizes.eye
    room = wheel.root - eye - 4.0
    windows = WINDOWS if alone and room > 16.0 else 0
    for k in range(windows):
        at = (wheel.root + eye) / 2 - 1.0
        radius = min(0.38 * room, 0.8 * at * math.sin(math.pi / WINDOWS))
        tool = extruded(circle(at, 0, radius), thickness + 2.0, -1.0)
        bottom = bottom.cut(placed(tool, turn=360.0 * k / WINDOWS))
    holds = (wheel.x, wheel.y, eye + 0.1 if windows else wheel.outside - 0.5)
    plan.plate(wheel.body, placed(bottom, wheel.x, wheel.y), holds, windows)
    way = plan.layout.seen(wheel.body, (wheel.x, wheel.y), "ground")
    if np.ptp(way, axis=0).max() < 0.01:  # the base plate goes on under it
        aside = wheel.outside - BESIDE
        plan.feet += [
            Foot("", float(way[0, 0]) + u, float(way[0, 1]) + v, 1.0) for u in (-aside, aside) for v in (-aside, aside)
        ]


@singledispatch
def shape_of(wheel: Carrier, thickness: float, eyes: list[tuple[float, float, Eye]]) -> tuple[cq.Workplane, int]:
    """Return a wheel about the z axis from z = 0 up, with its eyes, and its number of through holes."""
    raise TypeError(f"{type(wheel).__name__} has no shape")


@shape_of.register(Wheel)
def wheel_shape(wheel: Wheel, thickness: float, eyes: list[tuple[float, float, Eye]]) -> tuple[cq.Workplane, int]:
    """Return the wheel about the z axis from z = 0 up, with its eyes, and its number of through holes."""
    phase = wheel.phase or 0.0
    if wheel.ring:
        space = phase + math.pi / wheel.teeth
        hole = toothed(wheel.teeth, wheel.module, wheel.root, wheel.tip, -wheel.play / 2, space)
        return extruded(circle(0, 0, wheel.outside), thickness, holes=[wire(hole)]), 1
    outline = toothed(wheel.teeth, wheel.module, wheel.tip, wheel.root, wheel.play / 2, phase)
    return with_hub(extruded(wire(outline), thickness), wheel.root, thickness, eyes)


def with_hub(
    shape: cq.Workplane, root: float, thickness: float, eyes: list[tuple[float, float, Eye]]
) -> tuple[cq.Workplane, int]:
    """Return a disc with a milled-out web and its eyes, and its number of through holes.

    ``root`` is its radius.
    """
    alone = all(math.hypot(x, y) < 0.01 for x, y, _ in eyes)
    holes = 0
    if alone and root - RIM_WALL > HUB + 5.0:
        shape, holes = _milled(shape, root - RIM_WALL, thickness)
    for x, y, eye in eyes:
        if eye.above > 0:
            boss = extruded(circle(x, y, eye.boss_radius), eye.above + 1.0, thickness - 1.0)
            shape = shape.union(boss)
        if eye.below > 0:
            shape = shape.union(extruded(circle(x, y, eye.boss_radius), eye.below + 1.0, -eye.below))
        if eye.bore > 0:
            depth = thickness + eye.above + eye.below + 2.0
            shape = shape.cut(extruded(circle(x, y, eye.bore / 2), depth, -eye.below - 1.0))
            holes += 1
    return shape, holes


def _milled(shape: cq.Workplane, outer: float, thickness: float) -> tuple[cq.Workplane, int]:
    """Return a web between hub and rim, with round windows where there is room."""
    for z0, z1 in ((thickness - WEB, thickness + 1.0), (-1.0, WEB)):
        shape = shape.cut(turned([(HUB, z0), (outer, z0), (outer, z1), (HUB, z1)]))
    room = outer - HUB - 4.0
    if room < 8.0:
        return shape, 0
    middle, radius = (outer + HUB) / 2, 0.5 * room
    count = min(6, int(math.pi / math.asin(min((radius + 2.0) / middle, 1.0))))
    if count < 3:
        return shape, 0
    for k in range(count):
        angle = 2 * math.pi * k / count
        at = circle(middle * math.cos(angle), middle * math.sin(angle), radius)
        shape = shape.cut(extruded(at, thickness + 2.0, -1.0))
    return shape, count
