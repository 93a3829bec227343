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
from mechanisms.stages.automatic.rolling.backings import (
    CHORD,
    PIECES,
    THICK,
    Band,
    band,
    behind,
    is_clear,
    is_free,
    polygon,
    straight_back,
)
from shared.shapes.build import extruded
from shared.shapes.polyline import simplified

if TYPE_CHECKING:
    from mbsd import Mechanism
    from mechanisms.stages.automatic.layout.items import Levels
    from mechanisms.stages.automatic.layout.layout import Layout
    from mechanisms.stages.automatic.layout.order.heights import Heights
    from mechanisms.stages.automatic.layout.plan import Plan
    from mechanisms.stages.automatic.rolling.rounds import Round


HELD = 0.7
"""Cosine of the angle between gravity and what is under a road on which it holds a wheel."""


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
    band: Band | None = None
    """What lies behind the surface where that is no straight lower side."""

    @property
    def is_square(self) -> bool:
        """Whether it ends square, and in no mitred corner with another wall."""
        way = self.path[-1] - self.path[0]
        if self.band is not None:
            return False
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
        """(n, 2) corners of convex pieces."""
        if self.band is not None:
            yield from self.band.pieces
            return
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
        holes = 0 if self.band is None else len(self.band.holes)
        road, material = self, "aluminium"
        if self.holds(plan.layout.m):
            road = self.reaching(plan.base_under, np.array(plan.layout.m.gravity))
            material = "concrete"
        name = plan.make("ground", f"road_{self.name}", road._wall(seat, top), material, holes)
        plan.pressed_into("ground", name, self.rounds)
        if self.band is not None:
            (x0, y0), (x1, y1) = self.band.border.min(axis=0), self.band.border.max(axis=0)
            plan.feet += [Foot("", float(u), float(v), THICK, road=True) for u in (x0, x1) for v in (y0, y1)]
            return
        under = behind(self.path[-1] - self.path[0])
        widest = max(part.radius for part in self.rounds)
        ends = [*self.path[[0, -1]], *self.feet, *(self.path[[0, -1]] - widest * under)]
        plan.feet += [Foot("", float(u), float(v), THICK, road=True) for u, v in ends]

    def holds(self, m: Mechanism) -> bool:
        """Whether gravity holds a wheel on it."""
        pull = np.array(m.gravity or (0.0, 0.0))
        down = behind(self.path[-1] - self.path[0]) @ pull > HELD * np.hypot(*pull) > 0.0
        return bool(down) and any(part.look == "wheel" for part in self.rounds)

    def reaching(self, places: Sequence[tuple[float, float]], pull: np.ndarray) -> Road:
        """The road with as much of its straight continuations as lies over or under ``places`` (rmm), ``pull`` (2,)
        pointing down.
        """
        if not self.is_square or not len(places):
            return self
        level = np.array([-pull[1], pull[0]]) / np.hypot(*pull)  # to the right of what stands upright
        level *= np.sign((self.path[-1] - self.path[0]) @ level)
        ends = []
        for end, inner, out in ((self.path[0], self.path[1], -level), (self.path[-1], self.path[-2], level)):
            run, far = float((end - inner) @ out), float(((np.array(places) - end) @ out).max())
            goes_on = far > 0.0 and run > 0.0
            ends.append((end + far / run * (end - inner))[None] if goes_on else self.path[:0])
        return along(self.name, self.rounds, np.vstack([ends[0], self.path, ends[1]]))

    def _wall(self, low: float, high: float) -> cq.Workplane:
        """Wall of flat facets as long as its bends allow: a spline's many short ones make the clearance proof slow."""
        if self.band is not None:
            return self.band.wall(low, high)
        return extruded(polygon(np.vstack([simplified(self.path, CHORD), self.feet])), high - low, low)


def along(name: str, rounds: Sequence[Round], path: np.ndarray, thick: float = THICK) -> Road:
    """A road with its surface on ``path`` and a straight lower side."""
    return Road(name, rounds, path, straight_back(path, thick))


def backed(name: str, part: Round, path: np.ndarray, centres: np.ndarray, radius: float) -> Road | None:
    """A road that a disc about ``centres`` (T, 2) runs on without meeting its other sides: with a straight lower side
    if it can have one, else a band; None if neither can be.
    """
    road = along(name, [part], path)
    if is_free(path, road.feet, centres, radius):
        return road
    even = banded(name, [part], path)
    return even if even and even.band and is_clear(even.band, path, centres, radius) else None


def banded(name: str, rounds: Sequence[Round], path: np.ndarray) -> Road | None:
    """A road of even thickness; None where that is in several parts."""
    backing = band(path)
    return None if backing is None else Road(name, rounds, path, backing.back[[-1, 0]], backing)


def runs_on_ground(layout: Layout) -> bool:
    """Whether a wheel runs on a road of ground, and gravity holds it there."""
    return any(road.holds(layout.m) for road in layout.features if isinstance(road, Road))


def _thinned(path: np.ndarray) -> np.ndarray:
    """About so many places of a path, with both of its ends."""
    step = max(1, len(path) // PIECES)
    return path if step == 1 else np.vstack([path[:-1:step], path[-1:]])
