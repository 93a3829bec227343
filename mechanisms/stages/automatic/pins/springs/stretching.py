"""What stretches between two points, and the ball studs that hold its ends: in a body's plate, on a post on ground, or
on the end of a joint's pin.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from mechanisms.stages.automatic.layout.items import Anchor, Item, Need, Reach
from mechanisms.stages.automatic.layout.planar import Rounded, disc

if TYPE_CHECKING:
    from mechanisms.stages.automatic.layout.items import Levels
    from mechanisms.stages.automatic.layout.layout import Layout
    from mechanisms.stages.automatic.layout.order.heights import Heights
    from mechanisms.stages.automatic.layout.plan import Plan
    from mechanisms.stages.automatic.pins.pins import Pin

BALL = 3.8
"""Radius of a stud's ball."""
SHANK, COLLAR_HEIGHT = 4.6, 1.4
"""Diameter of a stud's shank, and height of the collar between a plate and a ball."""
EYE, POST, FOOT = 9.0, 5.5, 9.0
"""Radii of a stud's eye, of the room for studs and posts, and of a post's foot."""
HOOK = 0.1
"""Part of the way at either end where there is no barrel yet."""


@dataclass(frozen=True, eq=False)
class Stretching:
    """One spring, damper or actuator: its ends (body, x, y in its frame) and their ways in the world, in rmm."""

    force: str
    radius: float
    """Radius of the coil that the film draws, or from which it draws a cylinder."""
    outer: float
    """Outer radius of all that it draws."""
    ends: tuple[tuple[str, float, float], tuple[str, float, float]]
    path: np.ndarray
    """(T, 2, 2): both ends at every pose."""
    sags: np.ndarray | None = None
    """(T, 2): of a rope, from the middle between its ends to the corner of its tangents."""

    @property
    def layer(self) -> str:
        """The name of its layer, and of what takes its room."""
        return f"spring {self.force}"

    @property
    def names(self) -> tuple[str, str]:
        """Names of its barrel and of its whole length on the axis."""
        return f"the spring {self.force}", f"the ends of spring {self.force}"

    def z(self, heights: Heights) -> float:
        """Height (rmm) of its axis: the middle of its layer."""
        return heights.bottom(self.layer) + heights.thickness / 2

    def anchors(self, layout: Layout) -> Iterable[Anchor]:
        """None: the studs have them."""
        return []

    def items(self, layout: Layout) -> Iterable[Item]:
        """Its barrel in its layer and both gaps beside it, and its whole length in its layer."""
        barrel, ends = self.names
        held = self._studs(layout)
        own = {stud.what for stud in held} | {stud.pin.what for stud in held if stud.pin}
        others = [f for f in layout.features if isinstance(f, Stretching) and f is not self]
        first, last = self.path[:, :1], self.path[:, 1:]
        inner = np.concatenate([first + HOOK * (last - first), last - HOOK * (last - first)], axis=1)
        if self.sags is not None and self.sags.any():
            inner = _corners(inner, (first + last) / 2 + self.sags[:, None])
        layer, beside = Reach((self.layer,)), Reach((self.layer,), -1, 1)
        studs_alone = frozenset(stud.what for stud in held)
        yield Item(ends, self.layer, Rounded(self.path, BALL + 0.4), layer, source=self, meshes=studs_alone)
        wide = Rounded(inner, self.outer)
        meshes = frozenset(own | {spring.names[0] for spring in others})
        yield Item(barrel, self.layer, wide, beside, source=self, meshes=meshes)
        if others:
            cores = frozenset(_core(spring) for spring in others)
            yield Item(_core(self), self.layer, wide, layer, source=self, only=cores)

    def _studs(self, layout: Layout) -> list[Stud]:
        return [f for f in layout.features if isinstance(f, Stud) and any(spring is self for spring, _ in f.ends)]

    def needs(self, levels: Levels, layout: Layout) -> Iterable[Need]:
        """Room for its barrel, beside that of another and above a pin that its end stands on."""
        sizes, level, over = layout.sizes, levels[self.layer], self.over(layout)
        others = [f for f in layout.features if isinstance(f, Stretching) and f is not self]
        pins = [max(levels[body] for body in stud.pin.movers) for stud in self._studs(layout) if stud.pin]
        for gap, next_to in ((level - 1, level - 1), (level, level + 1)):
            beside = [spring.over(layout) for spring in others if levels[spring.layer] == next_to]
            extra = max([0.0, *beside, *(sizes.end_room for top in pins if top == gap)])
            if over + extra > 0:
                yield Need(gap, over + sizes.pivot.fit.axial + extra)

    def over(self, layout: Layout) -> float:
        """How far it reaches beyond its layer, up and down (rmm)."""
        return self.outer - layout.sizes.thickness / 2

    def build(self, plan: Plan, heights: Heights) -> None:
        """Nothing: the film draws it."""


def _core(spring: Stretching) -> str:
    return f"{spring.names[0]} in its layer"


def _corners(ends: np.ndarray, corner: np.ndarray) -> np.ndarray:
    """(T, 3, 2) triangles, counter-clockwise, of two ends (T, 2, 2) and a corner (T, 1, 2)."""
    way, off = ends[:, 1] - ends[:, 0], corner[:, 0] - ends[:, 0]
    left = way[:, 0] * off[:, 1] - way[:, 1] * off[:, 0] >= 0
    return np.concatenate([np.where(left[:, None, None], ends, ends[:, ::-1]), corner], axis=1)


@dataclass(frozen=True, eq=False)
class Stud:
    """One place of a body (rmm) and the ends (0 or 1) that it holds; ``pin`` where a joint's pin is there."""

    body: str
    x: float
    y: float
    ends: tuple[tuple[Stretching, int], ...]
    pin: Pin | None

    @property
    def name(self) -> str:
        """Name of its first end."""
        spring, end = self.ends[0]
        return f"{spring.force}_{end + 1}"

    @property
    def what(self) -> str:
        """What its item is called."""
        return f"the stud {self.name}"

    @property
    def layers(self) -> tuple[str, ...]:
        """Layers of all that it holds."""
        return tuple(dict.fromkeys(spring.layer for spring, _ in self.ends))

    def anchors(self, layout: Layout) -> Iterable[Anchor]:
        """An eye in the plate, or the foot of a post."""
        if self.pin is not None:
            return []
        return [Anchor(self.body, self.x, self.y, FOOT if self.body == "ground" else EYE)]

    def items(self, layout: Layout) -> Iterable[Item]:
        """All between its body, or its pin, and what it holds; and that this lies over it."""
        held = frozenset(spring.names[1] for spring, _ in self.ends)
        if self.pin is not None:
            under = Reach(self.pin.movers, high=1, base=True)
            reach, spares = Reach((*self.pin.movers, *self.layers), 1, -1), frozenset(self.pin.places)
        elif self.body == "ground":
            under, reach, spares = None, Reach(self.layers, -1, -1, base=True), frozenset[str]()
        else:
            under = Reach((self.body,), base=True) if layout.springs.above else None
            reach, spares = Reach((self.body, *self.layers), 1, -1), frozenset[str]()
        stands = "post" if self.pin is None and self.body == "ground" else ""
        yield Item(self.what, self.body, disc(self.x, self.y, POST), reach, spares, self, stands=stands)
        if under is not None:
            yield Item(f"{self.what} from below", self.body, disc(self.x, self.y, EYE), under, spares, self, only=held)

    def needs(self, levels: Levels, layout: Layout) -> Iterable[Need]:
        """Room for its collar between its plate and a ball in the next layer; springs and pins ask for the rest."""
        if self.pin is not None or self.body == "ground":
            return
        fit, ball = layout.sizes.pivot.fit, math.sqrt(BALL**2 - (SHANK / 2) ** 2)
        for layer in self.layers:
            if abs(levels[layer] - levels[self.body]) == 1:
                height = COLLAR_HEIGHT + 2 * fit.seat + ball - layout.sizes.thickness / 2
                yield Need(min(levels[layer], levels[self.body]), height)
