"""What round parts run on or in where it is no road on ground: rings and discs about closed curves, and roads of moving
bodies.

A track on ground stands on the base. One of a moving body stands on its plate and reaches through to the layer of what
it carries, so a ring with its plate is a cup.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from itertools import pairwise
from typing import TYPE_CHECKING

import cadquery as cq
import numpy as np

from mechanisms.stages.automatic.layout.items import Anchor, Item, Need, Reach
from mechanisms.stages.automatic.layout.plan import Foot
from mechanisms.stages.automatic.layout.planar import Rounded, around, convex_hull
from mechanisms.stages.automatic.layout.profiles import simplified
from mechanisms.stages.automatic.rolling.roads import CHORD, PIECES, THICK, along
from shared.shapes import outline
from shared.shapes.build import eased, extruded

if TYPE_CHECKING:
    from mechanisms.stages.automatic.layout.items import Levels
    from mechanisms.stages.automatic.layout.layout import Layout
    from mechanisms.stages.automatic.layout.order.heights import Heights
    from mechanisms.stages.automatic.layout.plan import Plan
    from mechanisms.stages.automatic.rolling.rounds import Round

EDGE = 2.0
"""Of the plate under a track beyond that (rmm)."""


@dataclass(frozen=True, eq=False)
class Track:
    """A wall of a body (rmm, its frame)."""

    name: str
    body: str
    carried: Round
    path: np.ndarray
    """(n, 2) the surface; what is carried is on its left. Closed: its last place is its first."""
    feet: np.ndarray | None = None
    """(2, 2) of an open one: the other corners, behind the last place of the path and behind the first."""

    @property
    def inside(self) -> bool:
        """Whether it lies round what it carries."""
        return self.feet is None and turns_left(self.path)

    @property
    def what(self) -> str:
        """In messages."""
        return f"the track of {self.name}"

    def anchors(self, layout: Layout) -> Iterable[Anchor]:
        """The plate below it."""
        if self.body == "ground":
            return []
        if self.feet is not None:
            behind = self.feet[::-1]
            ends = (self.path[[0, -1]] + behind) / 2
            return [Anchor(self.body, float(x), float(y), THICK / 2 + EDGE) for x, y in ends]
        return [Anchor(self.body, float(x), float(y), THICK) for x, y in _few(convex_hull(self.path))]

    def items(self, layout: Layout) -> Iterable[Item]:
        """Convex pieces, from the base or the plate to the height of what it carries."""
        other, ball = self.carried.body, int(self.carried.look == "ball")
        if self.body == "ground":
            reach = Reach((other,), high=ball, base=True)
        else:
            reach = Reach((self.body, other), -ball, ball)
        stands = "road" if self.body == "ground" else ""
        for piece in self.pieces():
            yield Item(self.what, self.body, piece, reach, frozenset((other,)), self, stands=stands)

    def pieces(self) -> Iterable[Rounded]:
        """Convex ones that cover it."""
        if self.feet is not None:
            road = along(self.name, [self.carried], self.path)
            for corners in road.pieces():
                yield around([(float(x), float(y)) for x, y in corners], 0.2)
        elif not self.inside:
            yield Rounded(convex_hull(self.path), 0.2)
        else:
            few = self.path[:: max(1, len(self.path) // PIECES)]
            middle = few - THICK / 2 * normals(few)
            for a, b in pairwise([*middle, middle[0]]):
                yield Rounded(np.array([a, b]), THICK / 2 + 0.2)

    def needs(self, levels: Levels, layout: Layout) -> Iterable[Need]:
        """Nothing."""
        return []

    def build(self, plan: Plan, heights: Heights) -> None:
        """The wall."""
        seat, other = plan.layout.sizes.pivot.fit.seat, self.carried.body
        if self.body == "ground":
            low, high = seat, self.carried.top(heights)
            plan.feet += [Foot("", float(x), float(y), THICK) for x, y in _corners(self.path)]
        elif heights.bottom(self.body) < heights.bottom(other):
            low, high = heights.top(self.body) + seat, self.carried.top(heights)
        else:
            middle = heights.bottom(other) + heights.thickness / 2
            low, high = 2 * middle - self.carried.top(heights), heights.bottom(self.body) - seat
        name = plan.make(self.body, f"track_{self.name}", self._wall(low, high), "aluminium", int(self.inside))
        plan.pressed_into(self.body, name, [self.carried])

    def _wall(self, low: float, high: float) -> cq.Workplane:
        corners = simplified(self.path, CHORD)
        if self.feet is not None:
            return extruded(_polygon(np.vstack([corners, self.feet])), high - low, low)
        surface = extruded(_polygon(corners[:-1]), high - low, low)
        if not self.inside:
            return surface
        hull = convex_hull(simplified(self.path, CHORD)[:-1], 1e-5)
        block = extruded(outline.hull([(float(x), float(y), THICK) for x, y in hull]), high - low, low)
        return eased(block, 0.8, ">Z", chamfer=True).cut(extruded(_polygon(corners[:-1]), high - low + 2, low - 1))


def track(name: str, body: str, carried: Round, path: np.ndarray, closed: bool) -> Track:
    """On a path (n, 2) (rmm, the body's frame) with what it carries on its left; a closed one is closed here."""
    if closed:
        return Track(name, body, carried, np.vstack([path, path[:1]]))
    return Track(name, body, carried, path, along(name, [carried], path).feet)


def circle(at: tuple[float, float], radius: float, inside: bool) -> np.ndarray:
    """(n, 2) places of a circle with what it carries on its left."""
    count = max(64, int(np.ceil(2 * np.pi * np.sqrt(radius / (8 * CHORD)))) * 4)
    angle = np.linspace(0.0, 2 * np.pi if inside else -2 * np.pi, count, endpoint=False)
    return np.array(at) + radius * np.column_stack([np.cos(angle), np.sin(angle)])


def turns_left(path: np.ndarray) -> bool:
    """Whether a closed path has its inside on its left."""
    x, y = path.T
    return float(x @ np.roll(y, -1) - y @ np.roll(x, -1)) > 0


def normals(path: np.ndarray) -> np.ndarray:
    """(n, 2) unit vectors to the left of a closed path."""
    way = np.roll(path, -1, axis=0) - np.roll(path, 1, axis=0)
    if np.allclose(path[0], path[-1]):
        way[[0, -1]] = path[1] - path[-2]
    return np.column_stack([-way[:, 1], way[:, 0]]) / np.hypot(*way.T)[:, None]


def _polygon(corners: np.ndarray) -> cq.Wire:
    return cq.Wire.makePolygon([cq.Vector(float(x), float(y), 0.0) for x, y in corners], close=True)


def _few(border: np.ndarray) -> np.ndarray:
    """Some of many places round a border."""
    return border[:: max(1, len(border) // 16)]


def _corners(border: np.ndarray) -> list[tuple[float, float]]:
    (x0, y0), (x1, y1) = border.min(axis=0), border.max(axis=0)
    return [(float(x), float(y)) for x in (x0, x1) for y in (y0, y1)]
