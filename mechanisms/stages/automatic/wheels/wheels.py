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
from mechanisms.stages.automatic.layout.planar import Rounded, disc
from shared.shapes.involute import DEDENDUM

if TYPE_CHECKING:
    from mechanisms.stages.automatic.layout.items import Levels
    from mechanisms.stages.automatic.layout.layout import Layout

SECTORS = 36
"""Pieces of an annulus in the plane."""
RIM = 7.0
"""Of a ring gear outside its teeth (rmm)."""
TUBE = (10.2, 13.2)
"""Inner and outer radius of what carries a wheel in a layer of its own: inside is room for a pin's hardware."""
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
            yield Item(self.what, self.body, disc(self.x, self.y, self.tip), reach, spares, self, meshes)
            if self.body == "ground":
                post = disc(self.x, self.y, self.root - 1.0)
                yield Item(self.what, self.body, post, Reach((self.layer,), -1, -1, base=True), spares, self, meshes)
            elif not self.shares:
                tube, between = disc(self.x, self.y, TUBE[1]), Reach((self.body, self.layer), 1, -1)
                yield Item(f"the tube of {self.what}", self.body, tube, between, source=self)
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
            for x, y in self.posts():
                reach = Reach((self.layer,), -1, -1, base=True)
                yield Item(f"a post of {self.what}", self.body, disc(x, y, RIM), reach, spares, self, meshes)

    def posts(self) -> list[tuple[float, float]]:
        """Of a ring that is fixed to ground, under its rim."""
        at = self.outside - RIM / 2
        angles = [math.radians(degrees) for degrees in (45, 135, 225, 315)]
        return [(self.x + at * math.cos(a), self.y + at * math.sin(a)) for a in angles]

    def needs(self, levels: Levels, layout: Layout) -> Iterable[Need]:
        """None."""
        return []
