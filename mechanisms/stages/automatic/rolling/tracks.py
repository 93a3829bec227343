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
from mechanisms.stages.automatic.layout.planar import Rounded, around, convex_hull, disc
from mechanisms.stages.automatic.layout.profiles import turns_left
from mechanisms.stages.automatic.pins.pins import Pin
from mechanisms.stages.automatic.rolling.backings import CHORD, PIECES, THICK, Band, polygon
from mechanisms.stages.automatic.rolling.roads import Road, along
from shared.shapes import outline
from shared.shapes.build import eased, extruded
from shared.shapes.polyline import distances, simplified
from shared.stage.errors import UserError

if TYPE_CHECKING:
    from mechanisms.stages.automatic.layout.items import Levels
    from mechanisms.stages.automatic.layout.layout import Layout
    from mechanisms.stages.automatic.layout.order.heights import Heights
    from mechanisms.stages.automatic.layout.plan import Plan
    from mechanisms.stages.automatic.rolling.rounds import Round

EVERYWHERE = 1e5
"""Radius of a disc that meets all (rmm)."""
EDGE = 2.0
"""Edge of the plate under a track beyond that (rmm)."""


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
    band: Band | None = None
    """Band of an open one: what lies behind the surface where that is no straight lower side."""

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
        if self.band is not None:
            return [Anchor(self.body, float(x), float(y), EDGE) for x, y in _few(convex_hull(self.band.border))]
        if self.feet is not None:
            behind = self.feet[::-1]
            ends = (self.path[[0, -1]] + behind) / 2
            return [Anchor(self.body, float(x), float(y), THICK / 2 + EDGE) for x, y in ends]
        return [Anchor(self.body, float(x), float(y), THICK) for x, y in _few(convex_hull(self.path))]

    def items(self, layout: Layout) -> Iterable[Item]:
        """Convex pieces, from the base or the plate to the height of what it carries; and a rule: that is in another
        layer than the plate, even where they never meet.
        """
        other, ball = self.carried.body, int(self.carried.look == "ball")
        if self.body == "ground":
            reach = Reach((other,), high=ball, base=True)
        else:
            reach = Reach((self.body, other), -ball, ball)
        stands = "road" if self.body == "ground" else ""
        for piece in self.pieces():
            yield Item(self.what, self.body, piece, reach, frozenset((other,)), self, stands=stands)
        if self.body != "ground":
            rule, only = f"the layer of {self.what}", frozenset((other,))
            yield Item(rule, self.body, disc(0.0, 0.0, EVERYWHERE), Reach((self.body,)), source=self, only=only)

    def pieces(self) -> Iterable[Rounded]:
        """Convex ones that cover it."""
        if self.feet is not None:
            for corners in Road(self.name, [self.carried], self.path, self.feet, self.band).pieces():
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
        wall, holes = self._wall(low, high), len(self.band.holes) if self.band is not None else int(self.inside)
        for x, y in [] if self.inside or self.feet is not None else self._pins(plan.layout):
            wall = wall.cut(extruded(outline.circle(x, y, _hole(plan.layout)), high - low + 2, low - 1))
            holes += 1
        name = plan.make(self.body, f"track_{self.name}", wall, "aluminium", holes)
        plan.pressed_into(self.body, name, [self.carried])

    def _pins(self, layout: Layout) -> list[tuple[float, float]]:
        """Places of pins that go through what lies within the curve. Raises UserError where one breaks its edge."""
        pins = [pin for pin in layout.features if isinstance(pin, Pin) and self.body in pin.places]
        pins = [pin for pin in pins if _holds(self.path, pin.places[self.body])]
        for pin in pins:
            near = float(distances(np.array([pin.places[self.body]]), self.path)[0])
            if near < _hole(layout) + EDGE:
                scale = layout.sizes.scale
                raise UserError(
                    f"{layout.m.name}: the closed curve of '{self.name}' on '{self.body}' comes within "
                    f"{near * scale:.3g} mm of joint '{pin.name}', whose hardware needs "
                    f"{(_hole(layout) + EDGE) * scale:.3g} mm; make the curve larger or the pins thinner "
                    "(automatic(m, pin=...))"
                )
        return [pin.places[self.body] for pin in pins]

    def _wall(self, low: float, high: float) -> cq.Workplane:
        if self.band is not None:
            return self.band.wall(low, high)
        corners = simplified(self.path, CHORD)
        if self.feet is not None:
            return extruded(polygon(np.vstack([corners, self.feet])), high - low, low)
        surface = extruded(polygon(corners[:-1]), high - low, low)
        if not self.inside:
            return surface
        hull = convex_hull(simplified(self.path, CHORD)[:-1], 1e-5)
        block = extruded(outline.hull([(float(x), float(y), THICK) for x, y in hull]), high - low, low)
        return eased(block, 0.8, ">Z", chamfer=True).cut(extruded(polygon(corners[:-1]), high - low + 2, low - 1))


def track(name: str, body: str, carried: Round, path: np.ndarray, closed: bool, road: Road | None = None) -> Track:
    """On a path (n, 2) (rmm, the body's frame) with what it carries on its left; a closed one is closed here.

    An open one has behind it what a ``road`` on the same path has, by default a straight lower side.
    """
    if closed:
        return Track(name, body, carried, np.vstack([path, path[:1]]))
    road = along(name, [carried], path) if road is None else road
    return Track(name, body, carried, path, road.feet, road.band)


def circle(at: tuple[float, float], radius: float, inside: bool) -> np.ndarray:
    """(n, 2) places of a circle with what it carries on its left."""
    count = max(64, int(np.ceil(2 * np.pi * np.sqrt(radius / (8 * CHORD)))) * 4)
    angle = np.linspace(0.0, 2 * np.pi if inside else -2 * np.pi, count, endpoint=False)
    return np.array(at) + radius * np.column_stack([np.cos(angle), np.sin(angle)])


def normals(path: np.ndarray) -> np.ndarray:
    """(n, 2) unit vectors to the left of a closed path."""
    way = np.roll(path, -1, axis=0) - np.roll(path, 1, axis=0)
    if np.allclose(path[0], path[-1]):
        way[[0, -1]] = path[1] - path[-2]
    return np.column_stack([-way[:, 1], way[:, 0]]) / np.hypot(*way.T)[:, None]


def _hole(layout: Layout) -> float:
    """Radius of a hole that all that turns about a pin goes through."""
    return layout.sizes.hardware + layout.sizes.room / 2


def _holds(path: np.ndarray, place: tuple[float, float]) -> bool:
    """Whether a closed path goes round a place."""
    way = path - place
    turns = np.diff(np.unwrap(np.arctan2(way[:, 1], way[:, 0])))
    return abs(float(turns.sum())) > np.pi


def _few(border: np.ndarray) -> np.ndarray:
    """Some of many places round a border."""
    return border[:: max(1, len(border) // 16)]


def _corners(border: np.ndarray) -> list[tuple[float, float]]:
    (x0, y0), (x1, y1) = border.min(axis=0), border.max(axis=0)
    return [(float(x), float(y)) for x in (x0, x1) for y in (y0, y1)]
