"""What round parts touch on ground: roads with the profile of a terrain, straight walls that meet in mitred corners."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import TYPE_CHECKING

import cadquery as cq
import numpy as np

from mechanisms.stages.automatic.layout.items import Anchor, Item, Need, Reach
from mechanisms.stages.automatic.layout.plan import Foot
from mechanisms.stages.automatic.layout.planar import around
from mechanisms.stages.automatic.layout.profiles import simplified
from shared.shapes.build import extruded

if TYPE_CHECKING:
    from mechanisms.stages.automatic.layout.items import Levels
    from mechanisms.stages.automatic.layout.layout import Layout
    from mechanisms.stages.automatic.layout.order.heights import Heights
    from mechanisms.stages.automatic.layout.plan import Plan
    from mechanisms.stages.automatic.rolling.rounds import Round

THICK = 10.0
"""Of a road under its surface, and of a wall (rmm)."""
CHORD = 0.006
"""How far the facets of a surface may stray from it (rmm)."""
PIECES = 48
"""Of a road in the plane."""


@dataclass(frozen=True, eq=False)
class Road:
    """A wall on the base (rmm, ground's axes)."""

    name: str
    rounds: Sequence[Round]
    """What runs on it; it reaches from the base to the highest of them."""
    path: np.ndarray
    """(n, 2) the surface; the free side is on its left."""
    feet: np.ndarray
    """(2, 2) the other corners: behind the last place of the path, and behind the first."""

    @property
    def is_square(self) -> bool:
        """Whether it ends square, and in no mitred corner with another wall."""
        way = self.path[-1] - self.path[0]
        return bool(np.abs((self.feet - self.path[[-1, 0]]) @ way).max() < 1e-9 * float(way @ way))

    def anchors(self, layout: Layout) -> Iterable[Anchor]:
        """Nothing."""
        return []

    def items(self, layout: Layout) -> Iterable[Item]:
        """The wall up to the height of what it carries."""
        bodies = tuple(dict.fromkeys(part.body for part in self.rounds))
        high = max(int(part.look == "ball") for part in self.rounds)
        reach, spares = Reach(bodies, high=high, base=True), frozenset(bodies)
        for corners in self.pieces():
            piece = around([(float(x), float(y)) for x, y in corners], 0.2)
            yield Item(f"the road of {self.name}", "ground", piece, reach, spares, self, stands="road")

    def pieces(self) -> Iterable[np.ndarray]:
        """(4, 2) corners of convex pieces."""
        back = self.feet[0] - self.feet[1]
        for a, b in pairwise(_thinned(self.path)):
            behind = [self.feet[1] + ((p - self.feet[1]) @ back / (back @ back)) * back for p in (a, b)]
            if len(self.path) == 2:
                behind = [self.feet[1], self.feet[0]]
            yield np.array([a, b, *behind])

    def needs(self, levels: Levels, layout: Layout) -> Iterable[Need]:
        """Nothing."""
        return []

    def build(self, plan: Plan, heights: Heights) -> None:
        """The wall; the base plate goes on beside it, under what it carries."""
        seat = plan.layout.sizes.pivot.fit.seat
        top = max(part.top(heights) for part in self.rounds)
        name = plan.make("ground", f"road_{self.name}", self._wall(seat, top), "aluminium", 0)
        plan.pressed_into("ground", name, self.rounds)
        under = _behind(self.path[-1] - self.path[0])
        widest = max(part.radius for part in self.rounds)
        ends = [*self.path[[0, -1]], *self.feet, *(self.path[[0, -1]] - widest * under)]
        plan.feet += [Foot("", float(u), float(v), THICK) for u, v in ends]

    def _wall(self, low: float, high: float) -> cq.Workplane:
        """Of flat facets as long as its bends allow: of a spline's many short ones the proof of clearance is long."""
        corners = [*simplified(self.path, CHORD), *self.feet]
        outline = cq.Wire.makePolygon([cq.Vector(float(u), float(v), 0.0) for u, v in corners], close=True)
        return extruded(outline, high - low, low)


def along(name: str, rounds: Sequence[Round], path: np.ndarray, thick: float = THICK) -> Road:
    """A road with its surface on ``path`` and a straight lower side."""
    under = _behind(path[-1] - path[0])
    lowest = float((path @ under).max()) + thick
    feet = [path[k] + (lowest - path[k] @ under) * under for k in (-1, 0)]
    return Road(name, rounds, path, np.array(feet))


def _behind(way: np.ndarray) -> np.ndarray:
    """(2,) the unit vector to the right of a way."""
    return np.array([way[1], -way[0]]) / np.hypot(*way)


def _thinned(path: np.ndarray) -> np.ndarray:
    """About so many places of a path, with both of its ends."""
    step = max(1, len(path) // PIECES)
    return path if step == 1 else np.vstack([path[:-1:step], path[-1:]])
