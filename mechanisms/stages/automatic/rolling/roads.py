"""Roads: strips along lines and curves, what backs them, and roads that several bodies share."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from itertools import pairwise

import cadquery as cq
import numpy as np
from manifold3d import CrossSection, FillRule, OpType

from mbsd import Mechanism
from mechanisms.stages.automatic.layout.curves import area
from mechanisms.stages.automatic.layout.items import Heights, Item, Reach
from mechanisms.stages.automatic.layout.layout import Feature, Layout
from mechanisms.stages.automatic.layout.plan import Foot, Plan
from mechanisms.stages.automatic.layout.planar import around, convex_hull
from mechanisms.stages.automatic.rolling.rounds import Round
from shared.shapes.build import extruded
from shared.shapes.outline import distances, simplified

# Backings behind the surface of a road: matter down to a straight lower side, or a band along it where that would
# cross the surface, itself or the way of what runs on it.

THICK = 10.0
"""Thickness of a road under its surface, of a band, and of a wall (rmm)."""
CHORD = 0.006
"""How far the facets of a surface may stray from it (rmm)."""
PIECES = 48
"""Pieces of a road in the plane."""
LONGEST = 2.0
"""Mitre at a sharp corner, in the thickness."""
SAME_AREA = 1e-6
"""Two areas of a polygon that differ by less, as a part of them, are one."""


@dataclass(frozen=True, eq=False)
class Band:
    """Matter of even thickness on the right of a surface (rmm): borders, and convex pieces of it."""

    border: np.ndarray
    """(n, 2) counter-clockwise."""
    holes: Sequence[np.ndarray]
    pieces: Sequence[np.ndarray]
    back: np.ndarray
    """(k, 2) the other side, from behind the first place of the surface to behind the last."""

    def wall(self, low: float, high: float) -> cq.Workplane:
        """Return the solid from one height to another."""
        return extruded(polygon(self.border), high - low, low, [polygon(hole) for hole in self.holes])


def straight_back(path: np.ndarray, thick: float = THICK) -> np.ndarray:
    """Return (2, 2) corners of a straight lower side, behind a surface's last place and its first."""
    under = behind(path[-1] - path[0])
    lowest = float((path @ under).max()) + thick
    return np.array([path[k] + (lowest - path[k] @ under) * under for k in (-1, 0)])


def is_simple(path: np.ndarray, feet: np.ndarray) -> bool:
    """Return True if the polygon of a surface and its lower corners crosses itself nowhere.

    Then its signed area is that of what it goes round.
    """
    corners = np.vstack([simplified(path, CHORD), feet])
    signed = abs(area(corners)) / 2
    return abs(CrossSection([corners], FillRule.EvenOdd).area() - signed) < SAME_AREA * signed


def is_free(path: np.ndarray, feet: np.ndarray, centres: np.ndarray, radius: float) -> bool:
    """Return True if a surface with its lower corners crosses neither itself nor what runs on it.

    What runs there is a disc about ``centres`` (T, 2), which must be clear of the other sides.
    """
    others = np.vstack([path[-1:], feet, path[:1]])
    return is_simple(path, feet) and bool(distances(centres, others).min() >= radius)


def is_clear(backing: Band, path: np.ndarray, centres: np.ndarray, radius: float) -> bool:
    """Return True if a disc about ``centres`` (T, 2) on a surface is clear of the band's other sides."""
    return bool(distances(centres, np.vstack([path[-1:], backing.back[::-1], path[:1]])).min() >= radius)


def band(path: np.ndarray, thick: float = THICK) -> Band | None:
    """Return the band behind a surface; None where that is in several parts."""
    surface = simplified(path, CHORD)
    back = surface - thick * _mitres(surface)
    quads = [
        convex_hull(np.array([*front, *rear])) for front, rear in zip(pairwise(surface), pairwise(back), strict=True)
    ]
    loops = CrossSection.batch_boolean([CrossSection([quad]) for quad in quads], OpType.Add).to_polygons()
    outer = [corners for corners in loops if area(corners) > 0]
    if len(outer) != 1:
        return None
    few = max(1, len(quads) // PIECES)
    pieces = [convex_hull(np.vstack(quads[k : k + few])) for k in range(0, len(quads), few)]
    return Band(outer[0], [corners for corners in loops if area(corners) < 0], pieces, back)


def polygon(corners: np.ndarray) -> cq.Wire:
    """Return a closed one, at z = 0."""
    return cq.Wire.makePolygon([cq.Vector(float(x), float(y), 0.0) for x, y in corners], close=True)


def _mitres(path: np.ndarray) -> np.ndarray:
    """Return (n, 2) from a polyline's places to those a unit to its left, at corners up to LONGEST."""
    way = np.diff(path, axis=0)
    way /= np.hypot(*way.T)[:, None]
    left = np.column_stack([-way[:, 1], way[:, 0]])
    before, after = np.vstack([left[:1], left]), np.vstack([left, left[-1:]])
    cosine = (before * after).sum(axis=1)[:, None]
    return (before + after) / np.maximum(1.0 + cosine, 2.0 / LONGEST)


def behind(way: np.ndarray) -> np.ndarray:
    """Return (2,) the unit vector to the right of a way."""
    return np.array([way[1], -way[0]]) / np.hypot(*way)


# Surfaces on ground that round parts touch: roads with the profile of a terrain, straight walls that meet in mitred
# corners.

HELD = 0.7
"""Cosine of the angle between gravity and what is under a road on which it holds a wheel."""


@dataclass(frozen=True, eq=False)
class Road(Feature):
    """A wall on the base (rmm, ground's axes)."""

    name: str
    rounds: Sequence[Round]
    """Round parts that run on it; it reaches from the base to the highest of them."""
    path: np.ndarray
    """(n, 2) the surface; the free side is on its left."""
    feet: np.ndarray
    """(2, 2) the other corners: behind the last place of the path, and behind the first."""
    band: Band | None = None
    """Backing of the surface where that is no straight lower side."""

    @property
    def is_square(self) -> bool:
        """True if it ends square, and in no mitred corner with another wall."""
        way = self.path[-1] - self.path[0]
        if self.band is not None:
            return False
        return bool(np.abs((self.feet - self.path[[-1, 0]]) @ way).max() < 1e-9 * float(way @ way))

    @property
    def holes(self) -> int:
        """Number of its holes."""
        return 0 if self.band is None else len(self.band.holes)

    def items(self, layout: Layout) -> Iterable[Item]:
        """Yield the wall up to the height of what it carries."""
        bodies = tuple(dict.fromkeys(part.body for part in self.rounds))
        high = max(int(part.look == "ball") for part in self.rounds)
        reach, spares = Reach(bodies, high=high, base=True), frozenset(bodies)
        for corners in self.pieces():
            piece = around([(float(x), float(y)) for x, y in corners], 0.2)
            yield Item(f"the road of {self.name}", "ground", piece, reach, spares, self, stands="road")

    def pieces(self) -> Iterable[np.ndarray]:
        """Yield (n, 2) corners of convex pieces."""
        if self.band is not None:
            yield from self.band.pieces
            return
        back = self.feet[0] - self.feet[1]
        for a, b in pairwise(_thinned(self.path)):
            behind = [self.feet[1] + ((p - self.feet[1]) @ back / (back @ back)) * back for p in (a, b)]
            if len(self.path) == 2:
                behind = [self.feet[1], self.feet[0]]
            yield np.array([a, b, *behind])

    def build(self, plan: Plan, heights: Heights) -> None:
        """Build the wall; the base plate goes on beside it, under what it carries."""
        seat = plan.layout.sizes.pivot.fit.seat
        top = max(part.top(heights) for part in self.rounds)
        road, material = self, "aluminium"
        if self.holds(plan.layout.m):
            road = self.reaching(plan.base_under, np.array(plan.layout.m.gravity))
            material = "concrete"
        name = plan.make("ground", f"road_{self.name}", road.wall(seat, top), material, self.holes)
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
        """Return True if gravity holds a wheel on it."""
        pull = np.array(m.gravity or (0.0, 0.0))
        down = behind(self.path[-1] - self.path[0]) @ pull > HELD * np.hypot(*pull) > 0.0
        return bool(down) and any(part.look == "wheel" for part in self.rounds)

    def reaching(self, places: Sequence[tuple[float, float]], pull: np.ndarray) -> Road:
        """Return the road with its straight continuations as far as ``places`` (rmm) ask.

        ``pull`` (2,) points down: what lies over or under a place reaches it.
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

    def wall(self, low: float, high: float) -> cq.Workplane:
        """Return the wall, of flat facets as long as its bends allow.

        A spline's many short ones make the clearance proof slow.
        """
        if self.band is not None:
            return self.band.wall(low, high)
        return extruded(polygon(np.vstack([simplified(self.path, CHORD), self.feet])), high - low, low)


def along(name: str, rounds: Sequence[Round], path: np.ndarray, thick: float = THICK) -> Road:
    """Return a road with its surface on ``path`` and a straight lower side."""
    return Road(name, rounds, path, straight_back(path, thick))


def backed(name: str, part: Round, path: np.ndarray, centres: np.ndarray, radius: float) -> Road | None:
    """Return a road that a disc about ``centres`` (T, 2) runs on without meeting its other sides.

    It has a straight lower side if it can have one, else it is a band; None if neither can be.
    """
    road = along(name, [part], path)
    if is_free(path, road.feet, centres, radius):
        return road
    even = banded(name, [part], path)
    return even if even and even.band and is_clear(even.band, path, centres, radius) else None


def banded(name: str, rounds: Sequence[Round], path: np.ndarray) -> Road | None:
    """Return a road of even thickness; None where that is in several parts."""
    backing = band(path)
    return None if backing is None else Road(name, rounds, path, backing.back[[-1, 0]], backing)


def runs_on_ground(layout: Layout) -> bool:
    """Return True if a wheel runs on a road of ground, and gravity holds it there."""
    return any(road.holds(layout.m) for road in layout.select(Road))


def _thinned(path: np.ndarray) -> np.ndarray:
    """Return about so many places of a path, with both of its ends."""
    step = max(1, len(path) // PIECES)
    return path if step == 1 else np.vstack([path[:-1:step], path[-1:]])


# Roads on ground with one surface are one road: the wheels of a vehicle run on it one behind the other.

SAME = 0.03
"""Surfaces nearer than this to each other, where both are, are one (rmm)."""


def with_shared_roads(features: Sequence[Feature]) -> list[Feature]:
    """Return the features, the roads of one surface merged into the first of them."""
    shared: list[Feature] = []
    for feature in features:
        for k, other in enumerate(shared):
            both = _both(other, feature) if isinstance(other, Road) and isinstance(feature, Road) else None
            if both is not None:
                shared[k] = both
                break
        else:
            shared.append(feature)
    return shared


def _both(first: Road, second: Road) -> Road | None:
    """Return two roads on one surface as one; None where they are not on one."""
    if not all(road.is_square or road.band for road in (first, second)):
        return None
    rounds = tuple(dict.fromkeys([*first.rounds, *second.rounds]))
    if first.band is None and second.band is None:
        path = _common(first.path, second.path)
        return None if path is None else along(first.name, rounds, path)
    for long, short in ((first, second), (second, first)):
        if distances(short.path, long.path).max() < SAME:
            return banded(first.name, rounds, long.path)
    return None


def _common(first: np.ndarray, second: np.ndarray) -> np.ndarray | None:
    """Return (n, 2) one path along both.

    None where they part, or where there is a gap between two that are not straight.
    """
    way = (first[-1] - first[0]) / np.hypot(*(first[-1] - first[0]))
    at, other = (first @ way, second @ way)
    if (np.diff(at) <= 0).any() or (np.diff(other) <= 0).any():
        return None
    across = np.array([-way[1], way[0]])
    height, others = first @ across, second @ across
    if len(first) == len(second) == 2:
        off = others - height
    else:
        low, high = max(at[0], other[0]), min(at[-1], other[-1])
        both = np.unique(np.concatenate([at, other]))
        both = both[(both >= low) & (both <= high)]
        off = np.interp(both, at, height) - np.interp(both, other, others)
    if not len(off) or np.abs(off).max() > SAME:
        return None
    return np.vstack([second[other < at[0]], first, second[other > at[-1]]])
