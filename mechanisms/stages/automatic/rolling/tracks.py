"""Tracks on moving bodies and the surfaces of curves."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from itertools import pairwise

import cadquery as cq
import numpy as np

from mbsd.model.force import Force
from mbsd.model.joint import Joint
from mechanisms.stages.automatic.layout import curves
from mechanisms.stages.automatic.layout.items import Anchor, Heights, Item, Reach
from mechanisms.stages.automatic.layout.layout import Feature, Layout
from mechanisms.stages.automatic.layout.plan import Foot, Plan
from mechanisms.stages.automatic.layout.planar import Rounded, around, convex_hull, disc
from mechanisms.stages.automatic.pins.pins import pins_on
from mechanisms.stages.automatic.rolling import roads
from mechanisms.stages.automatic.rolling.rounds import Round
from shared.shapes import outline
from shared.shapes.build import eased, extruded
from shared.shapes.outline import distances, normals, simplified
from shared.stage.errors import UserError
from shared.stage.paths import shown_file

# Tracks of round parts where there is no road on ground: rings and discs about closed curves, and roads of moving
# bodies.
#
# A track on ground stands on the base. One of a moving body stands on its plate and reaches through to the layer of
# what it carries, so a ring with its plate is a cup.

EVERYWHERE = 1e5
"""Radius of a disc that meets all (rmm)."""
EDGE = 2.0
"""Edge of the plate under a track beyond that (rmm)."""


@dataclass(frozen=True, eq=False)
class Track(Feature):
    """A wall of a body (rmm, its frame)."""

    name: str
    body: str
    carried: Round
    path: np.ndarray
    """(n, 2) the surface; what is carried is on its left. Closed: its last place is its first."""
    road: roads.Road | None = None
    """Surface of an open one with what lies behind it, as if on ground."""

    @property
    def inside(self) -> bool:
        """True if it lies round what it carries."""
        return self.road is None and curves.turns_left(self.path)

    @property
    def what(self) -> str:
        """In messages."""
        return f"the track of {self.name}"

    def anchors(self, layout: Layout) -> Iterable[Anchor]:
        """Return the plate below it."""
        if self.body == "ground":
            return []
        if self.road is not None and self.road.band is not None:
            return [Anchor(self.body, float(x), float(y), EDGE) for x, y in _few(convex_hull(self.road.band.border))]
        if self.road is not None:
            ends = (self.path[[0, -1]] + self.road.feet[::-1]) / 2
            return [Anchor(self.body, float(x), float(y), roads.THICK / 2 + EDGE) for x, y in ends]
        return [Anchor(self.body, float(x), float(y), roads.THICK) for x, y in _few(convex_hull(self.path))]

    def items(self, layout: Layout) -> Iterable[Item]:
        """Yield the convex pieces up to the height of what it carries, and a rule.

        The rule: what it carries is in another layer than the plate, even where they never meet.
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
        """Yield the convex ones that cover it."""
        if self.road is not None:
            for corners in self.road.pieces():
                yield around([(float(x), float(y)) for x, y in corners], 0.2)
        elif not self.inside:
            yield Rounded(convex_hull(self.path), 0.2)
        else:
            few = self.path[:: max(1, len(self.path) // roads.PIECES)]
            middle = few - roads.THICK / 2 * closed_normals(few)
            for a, b in pairwise([*middle, middle[0]]):
                yield Rounded(np.array([a, b]), roads.THICK / 2 + 0.2)

    def build(self, plan: Plan, heights: Heights) -> None:
        """Build the wall."""
        seat, other = plan.layout.sizes.pivot.fit.seat, self.carried.body
        if self.body == "ground":
            low, high = seat, self.carried.top(heights)
            plan.feet += [Foot("", float(x), float(y), roads.THICK) for x, y in _corners(self.path)]
        elif heights.bottom(self.body) < heights.bottom(other):
            low, high = heights.top(self.body) + seat, self.carried.top(heights)
        else:
            middle = heights.bottom(other) + heights.thickness / 2
            low, high = 2 * middle - self.carried.top(heights), heights.bottom(self.body) - seat
        wall, holes = self._wall(low, high), self.road.holes if self.road is not None else int(self.inside)
        for x, y in [] if self.inside or self.road is not None else self._pins(plan.layout):
            wall = wall.cut(extruded(outline.circle(x, y, _hole(plan.layout)), high - low + 2, low - 1))
            holes += 1
        name = plan.make(self.body, f"track_{self.name}", wall, "aluminium", holes)
        plan.pressed_into(self.body, name, [self.carried])

    def _pins(self, layout: Layout) -> list[tuple[float, float]]:
        """Return places of pins that go through what lies within the curve.

        Raises UserError where one breaks its edge.
        """
        pins = [pin for pin in pins_on(layout, self.body) if _holds(self.path, pin.places[self.body])]
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
        if self.road is not None:
            return self.road.wall(low, high)
        corners = simplified(self.path, roads.CHORD)
        surface = extruded(roads.polygon(corners[:-1]), high - low, low)
        if not self.inside:
            return surface
        hull = convex_hull(simplified(self.path, roads.CHORD)[:-1], 1e-5)
        block = extruded(outline.hull([(float(x), float(y), roads.THICK) for x, y in hull]), high - low, low)
        return eased(block, 0.8, ">Z", chamfer=True).cut(extruded(roads.polygon(corners[:-1]), high - low + 2, low - 1))


def track(
    name: str, body: str, carried: Round, path: np.ndarray, closed: bool, road: roads.Road | None = None
) -> Track:
    """Return a track on a path (n, 2) (rmm, the body's frame) with what it carries on its left.

    A closed one is closed here.

    An open one has behind it what a ``road`` on the same path has, by default a straight lower side.
    """
    if closed:
        return Track(name, body, carried, np.vstack([path, path[:1]]))
    return Track(name, body, carried, path, roads.along(name, [carried], path) if road is None else road)


def circle(at: tuple[float, float], radius: float, inside: bool) -> np.ndarray:
    """Return (n, 2) places of a circle with what it carries on its left."""
    count = max(64, int(np.ceil(2 * np.pi * np.sqrt(radius / (8 * roads.CHORD)))) * 4)
    angle = np.linspace(0.0, 2 * np.pi if inside else -2 * np.pi, count, endpoint=False)
    return np.array(at) + radius * np.column_stack([np.cos(angle), np.sin(angle)])


def closed_normals(path: np.ndarray) -> np.ndarray:
    """Return (n, 2) unit vectors to the left of a closed path."""
    way = np.roll(path, -1, axis=0) - np.roll(path, 1, axis=0)
    if np.allclose(path[0], path[-1]):
        way[[0, -1]] = path[1] - path[-2]
    return np.column_stack([-way[:, 1], way[:, 0]]) / np.hypot(*way.T)[:, None]


def _hole(layout: Layout) -> float:
    """Return the radius of a hole that all that turns about a pin goes through."""
    return layout.sizes.hardware + layout.sizes.room / 2


def _holds(path: np.ndarray, place: tuple[float, float]) -> bool:
    """Return True if a closed path goes round a place."""
    way = path - place
    turns = np.diff(np.unwrap(np.arctan2(way[:, 1], way[:, 0])))
    return abs(float(turns.sum())) > np.pi


def _few(border: np.ndarray) -> np.ndarray:
    """Return some of many places round a border."""
    return border[:: max(1, len(border) // 16)]


def _corners(border: np.ndarray) -> list[tuple[float, float]]:
    (x0, y0), (x1, y1) = border.min(axis=0), border.max(axis=0)
    return [(float(x), float(y)) for x in (x0, x1) for y in (y0, y1)]


# Surfaces along open curves: as long as the curve, and on along its straight continuations as far as something rolls
# or slides there.
#
# A wheel that rolls on a curve follows its branch through whatever the curve crosses (mbsd/arrays/curve_branches.py); a
# wall cannot be crossed. So where the whole surface would be in the wheel's way it is cut to what the wheel runs on,
# and where that is, the joint has no parts.

BEYOND = (0.8, 0.1)
"""How far a surface goes on beyond the way of a wheel, in the wheel's radii; less where that is in its way."""
FINE = 4
"""A curve is followed at so many places to each of its path."""
MOST = 2000
"""So many places of a wheel are looked at."""
OFF = 0.05
"""How much nearer than its radius a wheel may come to a surface that it does not touch, for rounding (rmm)."""
TOUCHES = 0.5
"""A part nearer than this to a surface touches it (rmm)."""

LEAST = 1e-6
"""A continuation shorter than this (rmm) is left out."""


def rolled_road(joint: Joint, part: Round, layout: Layout) -> roads.Road:
    """Return the road of a disc that rolls on an open curve.

    Raises UserError where each would be in the disc's way.
    """
    path = curves.on_body(curves.curve_path(joint.params["points"], False), joint.i, layout)
    centres = layout.seen(joint.j.body.name, layout.place(joint.j), joint.i.body.name)
    radius, few = layout.sizes.of_metres(joint.params["radius"]), centres[:: max(1, len(centres) // MOST)]
    ways = curves.end_ways(joint.params["points"], joint.i)
    run = _run(path, ways, few, radius)
    tried = list(_surfaces(path, ways, run, radius))
    for surface in tried:
        if distances(few, surface).min() >= radius - OFF:
            road = roads.backed(joint.name, part, surface, few, radius - OFF)
            if road is not None:
                return road
    raise UserError(_refusal(joint, tried[-1], centres, radius, layout))


def touched_path(touch: Joint | Force, places: np.ndarray, radius: float, layout: Layout) -> np.ndarray:
    """Return (n, 2) the open curve of a contact in the frame of its body (rmm).

    It has as much of its straight continuations as a disc about ``places`` (T, 2) touches.
    """
    points, ends = touch.params["points"], []
    path, ways = curves.on_body(curves.curve_path(points, False), touch.i, layout), curves.end_ways(points, touch.i)
    for end, way in zip(path[[0, -1]], ways, strict=True):
        ahead = (places - end) @ way
        beside = np.abs((places - end) @ roads.behind(way)) - radius
        out = ahead[(ahead > 0.0) & (beside < TOUCHES)]
        ends.append(end + (float(out.max()) + BEYOND[0] * radius) * way if len(out) else end)
    return _with_ends(path, np.array(ends))


def touched_road(touch: Joint | Force, part: Round, path: np.ndarray, places: np.ndarray, layout: Layout) -> roads.Road:
    """Return the road of a contact along a path (n, 2) (rmm) that a part about ``places`` (T, 2) touches.

    Raises UserError where nothing has room behind the surface.
    """
    few = places[:: max(1, len(places) // MOST)]
    road = roads.backed(touch.name, part, path, few, part.built_radius - part.pressed - OFF)
    road = road or roads.along(touch.name, [part], path)
    if road.band is None and not roads.is_simple(path, road.feet):
        m = layout.m
        raise UserError(
            f"{m.name}: contact '{touch.name}': its curve turns back too far: neither a straight lower side nor a "
            f"band of {roads.THICK * layout.sizes.scale:.3g} mm behind it is clear of what touches it; cut it into "
            f"several curves, or write {shown_file(m.name, 'parts')}"
        )
    return road


def _run(path: np.ndarray, ways: np.ndarray, centres: np.ndarray, radius: float) -> tuple[float, float]:
    """Return the range along a curve in which a disc rolls (rmm from its first place)."""
    even = curves.evenly(path, FINE * len(path))
    offset = even + radius * normals(even)
    length, step = float(np.hypot(*np.diff(path, axis=0).T).sum()), float(np.hypot(*np.diff(offset, axis=0).T).max())
    ahead = float(np.linalg.norm(centres[:, None] - offset[[0, -1]], axis=2).max())
    whole, before = curves.continued(offset, ways, ahead, step)
    numbers = curves.followed(whole, centres, False) - before
    last = len(even) - 1
    inside = np.clip(numbers, 0, last) * (length / last)
    places = inside + step * (np.minimum(numbers, 0) + np.maximum(numbers - last, 0))
    return float(places.min()), float(places.max())


def _surfaces(path: np.ndarray, ways: np.ndarray, run: tuple[float, float], radius: float) -> Iterable[np.ndarray]:
    """Yield the whole curve with what is rolled on beyond its ends, then what is rolled on alone."""
    length = float(np.hypot(*np.diff(path, axis=0).T).sum())
    low, high = run
    for part in BEYOND:
        out = np.array([low - part * radius if low < 0.0 else 0.0, high + part * radius if high > length else length])
        yield _with_ends(path, path[[0, -1]] + np.maximum([-out[0], out[1] - length], 0.0)[:, None] * ways)
    for part in BEYOND:
        first, last = low - part * radius, high + part * radius
        ends = path[[0, -1]] + np.maximum([-first, last - length], 0.0)[:, None] * ways
        whole = _with_ends(path, ends)
        at = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(whole, axis=0).T))]) + min(first, 0.0)
        cut = [np.array([np.interp(end, at, side) for side in whole.T]) for end in (first, last)]
        yield np.vstack([cut[0], whole[(at > first + OFF) & (at < last - OFF)], cut[1]])


def _with_ends(path: np.ndarray, ends: np.ndarray) -> np.ndarray:
    """Return a path that goes on to two other ends."""
    first, last = (ends[[k]] if np.hypot(*(ends[k] - path[k])) > LEAST else ends[:0] for k in (0, -1))
    return np.vstack([first, path, last])


def _refusal(joint: Joint, surface: np.ndarray, centres: np.ndarray, radius: float, layout: Layout) -> str:
    m, scale, body = layout.m, layout.sizes.scale, joint.i.body.name
    away = distances(centres, surface)
    sides = distances(centres, np.vstack([surface[-1:], roads.straight_back(surface), surface[:1]]))
    at = int(np.argmin(away if away.min() < radius - OFF else sides))
    x, y = centres[at] * scale
    return (
        f"{m.name}: joint '{joint.name}': at t={layout.times[at]:.4g} s the disc of '{joint.j.body.name}', "
        f"{radius * scale:.4g} mm in radius, is at ({x:.4g}, {y:.4g}) mm in the frame of '{body}', where another "
        f"stretch of its own road is {min(away[at], sides[at]) * scale:.3g} mm from its middle: it would run through a "
        "wall. Let the motion end before, part the stretches of the curve (its straight continuations are some of "
        f"them), make the disc smaller, or write {shown_file(m.name, 'parts')}"
    )
