"""A wheel: its teeth in numbers, its layer, what room it takes. External wheels, and rings with teeth inside.

A moving body has one wheel in its own layer, the largest. Each other one (a stepped gear) lies in a layer of its own on
a tube that leaves the hardware of the body's pins free. A ring that turns is the rim of a cup: the bottom is its
body's plate, the wall reaches to the layer of the teeth. Wheels of ground stand on posts.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass, field
from itertools import pairwise
from typing import TYPE_CHECKING, Protocol

import numpy as np

from mechanisms.stages.automatic.layout.items import Anchor, Item, Need, Reach
from mechanisms.stages.automatic.layout.planar import Rounded, disc, least_gap
from mechanisms.stages.automatic.pins.free.rim_marks import Face
from mechanisms.stages.automatic.pins.pins import SAME, Pin
from shared.shapes.involute import DEDENDUM

if TYPE_CHECKING:
    from mechanisms.stages.automatic.layout.items import Levels
    from mechanisms.stages.automatic.layout.layout import Layout

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
    """What meshes with a wheel: another one, or a rack."""

    @property
    def what(self) -> str:
        """In messages."""
        ...


@dataclass(eq=False)
class Wheel:
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
    """Whether it lies in its body's layer."""

    @property
    def layer(self) -> str:
        """What decides its layer: its body, or itself."""
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
        """The wheel is no part of the outline; what carries it is."""
        if self.body == "ground":
            return [Anchor("ground", self.x, self.y, self.outside)]
        if self.ring:
            return [Anchor(self.body, self.x, self.y, layout.sizes.eye)]
        return [] if self.shares else [Anchor(self.body, self.x, self.y, TUBE[1])]

    def items(self, layout: Layout) -> Iterable[Item]:
        """A disc, or an annulus in pieces, and what carries it."""
        reach, spares = Reach((self.layer,)), frozenset[str]()
        meshes = frozenset(mate.what for mate in self.mates)
        if not self.ring:
            on_tube = self.body != "ground" and not self.shares
            meshes = meshes | self._pins(layout) if on_tube else meshes
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
        """Within its teeth, where it is its body's plate."""
        if body != self.body or self.ring or not self.shares:
            return None
        fills = any(getattr(feature, "fills", "") == body for feature in layout.features)
        in_ring = any(isinstance(mate, Wheel) and mate.ring for mate in self.mates)  # an arm would meet its teeth
        return None if fills else Face(self.x, self.y, self.root, math.inf if in_ring else max(self.tip, self.radius))

    def _pins(self, layout: Layout) -> frozenset[str]:
        """Names of the pins that its tube goes round."""
        pins = (pin for pin in layout.features if isinstance(pin, Pin) and self.body in pin.places)
        return frozenset(pin.what for pin in pins if math.dist(pin.places[self.body], (self.x, self.y)) < SAME)

    def posts(self, layout: Layout) -> list[tuple[float, float]]:
        """Posts under the rim of a ring fixed to ground: a cross turned so that the fewest bodies come near it."""
        return min((self._cross(degrees) for degrees in CROSSES), key=lambda cross: _near(cross, layout))

    def _cross(self, degrees: float) -> list[tuple[float, float]]:
        at = self.outside - RIM / 2
        angles = [math.radians(degrees + quarter) for quarter in (0, 90, 180, 270)]
        return [(self.x + at * math.cos(a), self.y + at * math.sin(a)) for a in angles]

    def needs(self, levels: Levels, layout: Layout) -> Iterable[Need]:
        """None."""
        return []


def _near(posts: list[tuple[float, float]], layout: Layout) -> int:
    """How many pairs of a post and a body's plate meet in the plane at some time."""
    plates = [(layout.outline(body), layout.poses[body]) for body in layout.moving if layout.anchors[body]]
    still = layout.poses["ground"]
    room = layout.sizes.room
    gaps = (least_gap(disc(x, y, RIM), plate, (still, poses), room)[0] for x, y in posts for plate, poses in plates)
    return sum(gap < room for gap in gaps)
