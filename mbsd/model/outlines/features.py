"""Features of outlines, and the tables of them that equations of contact read.

A line is a feature, a convex corner an arc of radius 0; arcs turn by a third of a round at most. Convex arcs that
follow each other are a run. See mbsd/equations/relative/outline_features.py.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import lru_cache
from itertools import pairwise
from typing import NamedTuple

from mbsd.model.outlines.geometry import STRAIGHT, Corner, arc_of, flattened, signed_area

LINE, CONVEX, CONCAVE = 0.0, 1.0, -1.0
"""Kinds of features, as the equations read them."""
SMOOTH = 1e-6
"""Turn of the tangent (rad) below which two pieces go on without a corner."""
WIDEST = math.radians(100.0)
"""Turn of one arc at most."""
MORE, BEYOND, DEEPEST = 1e-6, 0.5, 0.2
"""Parts of the size: what is added where nothing touches; how far features reach beyond concave corners, in theirs; how
deep a pair may be."""
NOWHERE = 10.0
"""Gap where there is no pair, in sizes."""
Vector = tuple[float, float]


class Feature(NamedTuple):
    """A line or arc of an outline."""

    kind: float
    """LINE, CONVEX or CONCAVE."""
    place: Vector
    """Begin of a line, centre of an arc (m)."""
    first: Vector
    """Tangent of a line; unit vector from the centre to the begin."""
    last: Vector
    size: float
    """Length of a line, radius of an arc (m)."""
    span: float
    """Length (m), or angle (rad)."""
    linked: bool
    """True if the next one goes on without a concave corner."""

    @property
    def length(self) -> float:
        """Its length (m)."""
        return self.size if self.kind == LINE else self.size * self.span

    @property
    def ends(self) -> tuple[Vector, Vector]:
        """Where it begins and ends (m)."""
        (x, y), reach = self.place, self.size
        end = (x + reach * self.last[0], y + reach * self.last[1])
        return (self.place if self.kind == LINE else (x + reach * self.first[0], y + reach * self.first[1])), end

    @property
    def tangents(self) -> tuple[Vector, Vector]:
        """Unit vectors along it at both ends."""
        if self.kind == LINE:
            return self.first, self.first
        (ax, ay), (bx, by), way = self.first, self.last, self.kind
        return (-way * ay, way * ax), (-way * by, way * bx)

    @property
    def circle(self) -> tuple[float, float, float]:
        """Centre and radius of a circle around it (m)."""
        (ax, ay), (bx, by) = self.ends
        if self.kind == LINE or self.size == 0.0:
            return 0.5 * (ax + bx), 0.5 * (ay + by), 0.5 * math.hypot(bx - ax, by - ay)
        half = 0.5 * self.span
        (ux, uy), reach = self.first, self.size * math.sin(half)
        c, s, along = math.cos(self.kind * half), math.sin(self.kind * half), self.size * math.cos(half)
        x, y = self.place[0] + along * (c * ux - s * uy), self.place[1] + along * (s * ux + c * uy)
        return x, y, max(reach, self.size - along)


class Run(NamedTuple):
    """Convex arcs of an outline that follow each other."""

    arcs: tuple[Feature, ...]
    closed: bool
    """True if they are all of the outline."""

    @property
    def circle(self) -> tuple[float, float, float]:
        """Centre and radius of a circle around it (m)."""
        circles = [arc.circle for arc in self.arcs]
        x = sum(circle[0] for circle in circles) / len(circles)
        y = sum(circle[1] for circle in circles) / len(circles)
        return x, y, max(math.hypot(cx - x, cy - y) + reach for cx, cy, reach in circles)


def _piece(first: Corner, second: Corner) -> list[Feature]:
    if abs(first[2]) <= STRAIGHT:
        length = math.dist(first[:2], second[:2])
        way = ((second[0] - first[0]) / length, (second[1] - first[1]) / length)
        return [Feature(LINE, first[:2], way, way, length, length, True)]
    x, y, radius, sweep = arc_of(first, second)
    count = math.ceil(abs(sweep) / WIDEST)
    begin = math.atan2(first[1] - y, first[0] - x)
    angles = [begin + sweep * k / count for k in range(count + 1)]
    ways = [(math.cos(angle), math.sin(angle)) for angle in angles]
    kind = CONVEX if sweep > 0.0 else CONCAVE
    return [Feature(kind, (x, y), a, b, radius, abs(sweep) / count, True) for a, b in pairwise(ways)]


@lru_cache(maxsize=256)
def features_of(corners: tuple[Corner, ...]) -> tuple[Feature, ...]:
    """Return the features of an outline in order, convex corners among them."""
    pieces = [part for first, second in pairwise([*corners, corners[0]]) for part in _piece(first, second)]
    out: list[Feature] = []
    for piece, following in pairwise([*pieces, pieces[0]]):
        (ax, ay), (bx, by) = piece.tangents[1], following.tangents[0]
        turn = math.atan2(ax * by - ay * bx, ax * bx + ay * by)
        out.append(piece._replace(linked=turn > -SMOOTH))
        if turn > SMOOTH:
            parts = math.ceil(turn / WIDEST)
            angles = [math.atan2(-ax, ay) + turn * k / parts for k in range(parts + 1)]
            normals = [(math.cos(angle), math.sin(angle)) for angle in angles]
            out += [Feature(CONVEX, following.ends[0], a, b, 0.0, turn / parts, True) for a, b in pairwise(normals)]
    return tuple(out)


@lru_cache(maxsize=256)
def runs_of(corners: tuple[Corner, ...]) -> tuple[Run, ...]:
    """Return the runs of an outline."""
    features = features_of(corners)
    if all(feature.kind == CONVEX and feature.linked for feature in features):
        return (Run(features, True),)
    breaks = [k for k, f in enumerate(features) if f.kind != CONVEX or not features[k - 1].linked]
    turned = [*features[breaks[0] :], *features[: breaks[0]]]
    runs: list[list[Feature]] = []
    goes_on = False
    for feature in turned:
        if feature.kind != CONVEX:
            goes_on = False
            continue
        if not goes_on:
            runs.append([])
        runs[-1].append(feature)
        goes_on = feature.linked
    return tuple(Run(tuple(run), False) for run in runs)


def is_convex(corners: tuple[Corner, ...]) -> bool:
    """Return True if an outline is that of a convex body."""
    return all(feature.kind != CONCAVE and feature.linked for feature in features_of(corners))


def reach_of(corners: Sequence[Corner]) -> float:
    """Return the diagonal of the box around an outline (m); infinite of a hole."""
    if signed_area(corners) < 0.0:
        return math.inf
    x, y = zip(*flattened(corners, 0.1)[0], strict=True)
    return math.hypot(max(x) - min(x), max(y) - min(y))


def circle_around(corners: Sequence[Corner]) -> tuple[float, float, float]:
    """Return centre and radius of a circle around an outline (m); the radius of a hole's is infinite."""
    points = flattened(corners, 0.1)[0]
    x, y = (0.5 * (min(row) + max(row)) for row in zip(*points, strict=True))
    far = max(math.dist((x, y), point) for point in points) / math.cos(0.05)
    return x, y, math.inf if signed_area(corners) < 0.0 else far


def groups_of(corners: tuple[Corner, ...], reach: float) -> list[list[int]]:
    """Return groups of runs of which a body that reaches this far (m) touches only one at a time."""
    circles = [run.circle for run in runs_of(corners)]
    groups: list[list[int]] = []
    for k, (x, y, size) in enumerate(circles):
        for group in groups:
            if all(math.hypot(x - circles[g][0], y - circles[g][1]) - size - circles[g][2] > reach for g in group):
                group.append(k)
                break
        else:
            groups.append([k])
    return groups


@lru_cache(maxsize=1024)
def table_of(
    outline_i: tuple[Corner, ...],
    outline_j: tuple[Corner, ...],
    runs: tuple[int, ...],
    second: bool,
    arcs: bool,
    deepest: float = DEEPEST,
) -> tuple[float, ...]:
    """Return the numbers of a row: ``runs`` of the outline of body j on the features of that of body i.

    ``second``: of the next pair beside the nearest. ``arcs``: convex arcs of body i count, too.
    ``deepest``: part of the lesser size beyond which a pair is none.
    """
    chosen = [runs_of(outline_j)[k] for k in runs]
    features = features_of(outline_i)
    size = min(_extent(outline_i), _extent(outline_j))
    around = sum(feature.length for feature in features)
    around += sum(arc.length for arc in chosen[0].arcs) if chosen[0].closed else 0.0
    shortest = min(feature.length for feature in features if feature.length > 0.0)
    count = sum(len(run.arcs) for run in chosen)
    head = [len(chosen), count, len(features), second, NOWHERE * (_extent(outline_i) + _extent(outline_j))]
    head += [BEYOND * shortest, MORE * size, deepest * size, around]
    rows: list[float] = []
    elements: list[float] = []
    begun = 0
    for run in chosen:
        length = sum(arc.length for arc in run.arcs)
        rows += [begun, begun + len(run.arcs), *run.circle, run.closed, length if run.closed else 0.0]
        elements += _elements(run)
        begun += len(run.arcs)
    return tuple(float(number) for number in [*head, *rows, *elements, *_features(features, arcs)])


def _extent(corners: Sequence[Corner]) -> float:
    x, y = zip(*flattened(corners, 0.1)[0], strict=True)
    return math.hypot(max(x) - min(x), max(y) - min(y))


def _elements(run: Run) -> list[float]:
    out: list[float] = []
    length, angle = 0.0, math.atan2(run.arcs[0].first[1], run.arcs[0].first[0])
    for arc in run.arcs:
        out += [*arc.place, arc.size, *arc.first, *arc.last, length, angle]
        length += arc.length
        angle += arc.span
    return out


def _features(features: Sequence[Feature], arcs: bool) -> list[float]:
    out: list[float] = []
    length = 0.0
    (tx, ty) = features[0].tangents[0]
    phi = math.atan2(tx, -ty)
    for feature, following in pairwise([*features, features[0]]):
        left_out = feature.kind == CONVEX and not arcs
        out += [feature.kind, *feature.place, *feature.first, *feature.last, feature.size, length, feature.linked]
        out += [feature.span, *feature.circle, left_out, phi]
        length += feature.length
        phi += 0.0 if feature.kind == LINE else feature.kind * feature.span
        (ax, ay), (bx, by) = feature.tangents[1], following.tangents[0]
        if not feature.linked:
            phi += math.atan2(ax * by - ay * bx, ax * bx + ay * by)
    return out
