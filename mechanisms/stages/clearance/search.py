"""The search for the least distance of two meshes over a motion, by branch and bound."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from mechanisms.stages.clearance.path import BodyPath, RelativePath, relative
from mechanisms.stages.clearance.pieces import MeshPiece, Tree

# Spans of time: intervals of data.json, neighbours together where there are many, halved where a search needs it.


class Spans:
    """A table that grows.

    Each span knows where the mover is at its ends and middle, and how far it strays between.

    A span knows the poses at its ends and middle. ``first`` and ``last`` are the intervals it lies in; ``off`` (mm) is
    what the true motion may be off there. ``ends`` (n, 3, 3): at start, middle and end the centre's x, y (mm) and the
    angle (rad); ``place`` and ``turned`` (n, 3) are the same as x + i y and e^(i angle). ``push`` (mm) and ``spin`` (mm
    a mm from the centre) are how far points stray from the straight lines between their ends. ``travel`` (mm) and
    ``turn`` (rad) are how far centre and angle are from the middle's at most.
    """

    begin = 400
    """Spans to begin with; of more intervals, neighbours are taken together."""
    first: np.ndarray
    last: np.ndarray
    start: np.ndarray
    end: np.ndarray
    ends: np.ndarray
    place: np.ndarray
    turned: np.ndarray
    push: np.ndarray
    spin: np.ndarray
    travel: np.ndarray
    turn: np.ndarray
    off: np.ndarray
    _half: np.ndarray

    def __init__(self, path: Any) -> None:
        """``path``: a :class:`RelativePath`, or its like in space."""
        self.path = path
        start, width = path.mover.start, path.mover.width
        self.error = path.error
        self._most = 1 + (len(start) - 1) // self.begin
        """Intervals in a span."""
        jumps = np.flatnonzero(np.diff(path.mover.first) != 1) + 1  # two samples at one time: velocities may differ
        firsts = np.unique(np.concatenate([np.arange(0, len(start), self._most), jumps]))
        lasts = np.append(firsts[1:], len(start)) - 1
        self._add(firsts, lasts, start[firsts], start[lasts] + width[lasts])

    def __len__(self) -> int:
        return len(getattr(self, "start", ()))

    def middle(self, spans: np.ndarray) -> np.ndarray:
        """Return (n,) the time (s) in the middle of each span."""
        return (self.start[spans] + self.end[spans]) / 2

    def stray(self, spans: np.ndarray, reach: np.ndarray) -> np.ndarray:
        """Return (n,) how far (mm) points within ``reach`` of the centre are from their middle's places."""
        return self.travel[spans] + reach * self.turn[spans]

    def halves(self, spans: np.ndarray) -> np.ndarray:
        """Return (n,) the first half of each span; the second is the next one."""
        new = np.unique(spans[self._half[spans] < 0])
        if len(new):
            middle = self.middle(new)
            self._half[new] = len(self) + 2 * np.arange(len(new))
            cut = np.clip(self.path.mover.interval(middle), self.first[new], self.last[new])
            before = np.where(self.path.mover.start[cut] < middle, cut, cut - 1)
            first, last = np.stack([self.first[new], cut], axis=1), np.stack([before, self.last[new]], axis=1)
            bounds = np.stack([self.start[new], middle, self.end[new]], axis=1)
            self._add(first.ravel(), last.ravel(), bounds[:, :2].ravel(), bounds[:, 1:].ravel())
        return self._half[spans]

    def _add(self, first: np.ndarray, last: np.ndarray, start: np.ndarray, end: np.ndarray) -> None:
        middle = (start + end) / 2
        inner = np.clip(self.path.mover.interval(middle), first, last)
        places = ((first, start), (inner, middle), (last, end))
        bend = (end - start) ** 2 / 8
        within = np.minimum(first[:, None] + np.arange(self._most), last[:, None])
        push, spin = bend * self.path.push[within].max(axis=1), bend * self.path.spin[within].max(axis=1)
        columns = {
            "first": first,
            "last": last,
            "off": self.error[within].max(axis=1),
            "start": start,
            "end": end,
            "push": push,
            "spin": spin,
            "_half": np.full(len(start), -1),
        }
        columns |= self._poses(places, push, spin)
        for name, column in columns.items():
            setattr(self, name, np.concatenate([getattr(self, name, column[:0]), column]))

    def _poses(
        self, places: Sequence[tuple[np.ndarray, np.ndarray]], push: np.ndarray, spin: np.ndarray
    ) -> dict[str, np.ndarray]:
        """Return ends, place, turned, travel and turn of new spans.

        ``places``: interval and time of the start, middle and end of each.
        """
        ends = np.stack([self.path.place(k, t) for k, t in places], axis=1)
        off = np.abs(ends[:, (0, 2)] - ends[:, 1:2])
        return {
            "ends": ends,
            "place": ends[:, :, 0] + 1j * ends[:, :, 1],
            "turned": np.exp(1j * ends[:, :, 2]),
            "travel": np.hypot(off[:, :, 0], off[:, :, 1]).max(axis=1) + push,
            "turn": off[:, :, 2].max(axis=1) + spin,
        }


# Pairs of triangles in space, many at once: their distance, and how far a direction separates them.

NEXT = (1, 2, 0)
TINY = 1e-12
FLAT = 1e-6
"""Height (mm) below which a triangle is taken for its longest edge."""


def nearest(p: np.ndarray, q: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the distance (n,) of triangles p and q (n, 3, 3), and the way (n, 3) from p to q.

    The triangles do not pierce each other.

    The triangles do not pierce each other. The nearest points of two triangles lie on two edges, or on a corner and a
    face. For triangles that pierce each other the distance of their edges and corners comes out, and no direction
    separates them by it (:func:`separation`).
    """
    edges = _edge_ways(p, q)
    onto_q = _corner_ways(p, q)
    onto_p = -_corner_ways(q, p)
    ways = np.concatenate([edges, onto_q, onto_p], axis=1)
    squares = np.einsum("nki,nki->nk", ways, ways)
    best = squares.argmin(axis=1)
    rows = np.arange(len(p))
    return np.sqrt(squares[rows, best]), ways[rows, best]


def separation(direction: np.ndarray, p: np.ndarray, q: np.ndarray) -> np.ndarray:
    """Return (n,) how far q (n, 3, 3) is beyond p along unit directions (n, 3).

    Below zero where they overlap along it.
    """
    along_p = np.einsum("nki,ni->nk", p, direction)
    along_q = np.einsum("nki,ni->nk", q, direction)
    return along_q.min(axis=1) - along_p.max(axis=1)


def normals(t: np.ndarray) -> np.ndarray:
    """Return (n, 3) unit normals, zero for triangles lower than :data:`FLAT`.

    The edges of these say where they are.
    """
    normal = np.cross(t[:, 1] - t[:, 0], t[:, 2] - t[:, 0])
    size = np.linalg.norm(normal, axis=1)
    longest = np.linalg.norm(t[:, NEXT] - t, axis=2).max(axis=1)
    return normal / np.where(size > FLAT * longest, size, np.inf)[:, None]


def _edge_ways(p: np.ndarray, q: np.ndarray) -> np.ndarray:
    """Return (n, 9, 3): from the nearest point of each edge of p to the nearest point of each edge of q."""
    n = len(p)
    a, d = np.repeat(p, 3, axis=1), np.repeat(p[:, NEXT] - p, 3, axis=1)
    b, e = np.tile(q, (1, 3, 1)), np.tile(q[:, NEXT] - q, (1, 3, 1))
    r = a - b
    dd, ee, de = _dot(d, d), _dot(e, e), _dot(d, e)
    dr, er = _dot(d, r), _dot(e, r)
    dd, ee = np.maximum(dd, TINY), np.maximum(ee, TINY)
    across = dd * ee - de * de
    s = np.where(across > TINY * dd * ee, (de * er - dr * ee) / np.where(across > 0, across, 1.0), 0.0)
    s = np.clip(s, 0.0, 1.0)
    t = (de * s + er) / ee
    outside = (t < 0.0) | (t > 1.0)
    t = np.clip(t, 0.0, 1.0)
    s = np.where(outside, np.clip((de * t - dr) / dd, 0.0, 1.0), s)
    return ((b + t[..., None] * e) - (a + s[..., None] * d)).reshape(n, 9, 3)


def _corner_ways(p: np.ndarray, q: np.ndarray) -> np.ndarray:
    """Return (n, 3, 3): from each corner of p straight to the plane of q where it meets q's inside.

    Infinite elsewhere.
    """
    normal = normals(q)
    height = _dot(p - q[:, :1], normal[:, None])
    foot = p - height[..., None] * normal[:, None]
    inside = np.broadcast_to((normal != 0).any(axis=1)[:, None], height.shape).copy()
    for i, j in enumerate(NEXT):
        outward = np.cross(q[:, j] - q[:, i], normal)
        inside &= _dot(foot - q[:, i : i + 1], outward[:, None]) <= 0.0
    return np.where(inside[..., None], foot - p, 1e9)


def _dot(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    return np.einsum("...i,...i->...", a, b)


# Two pieces over a motion: their gap at a time, whether they stay far apart, and where they overlap.

IN_PLANE = np.radians(np.arange(0, 180, 5))
"""Angles of the directions in which the depth of an overlap is measured."""


@dataclass(frozen=True)
class Overlap:
    """Where two pieces overlap most: when, how deep (mm), and from when to when they were seen to touch."""

    time: float
    depth: float
    first: float
    last: float


class Sweep:
    """Two pieces on their paths.

    One stands still, the other moves relative to it, whichever bends its paths less.
    """

    relative: Any = RelativePath
    """Class of the path of one body seen from another."""
    spans: Any = Spans
    directions = np.column_stack([(0.0, 0.0, 1.0), *((math.cos(a), math.sin(a), 0.0) for a in IN_PLANE)])
    """(3, n): directions in which the depth of an overlap is measured, those of height and in the plane."""

    def __init__(self, first: MeshPiece, second: MeshPiece, path_first: BodyPath, path_second: BodyPath) -> None:
        ends = [path_first.interpolation_error(first.reach), path_second.interpolation_error(second.reach)]
        self.error = ends[0] + ends[1]
        """(m,): how far the two may be from where they are taken to be, in each interval of data.json (mm)."""
        options = []
        for mover, still, moved, seen in (
            (first, second, path_first, path_second),
            (second, first, path_second, path_first),
        ):
            path = self.relative(moved, seen, mover.centre, self.error)
            options.append((path.bend(mover.radius), path, mover, still))
        _, self.path, self.mover, self.still = min(options, key=lambda option: option[0])
        self.times = self.path.mover.time

    def gap_at(self, time: float, reach: float) -> float:
        """Return exact gap (mm) at a time, 0 if the pieces overlap, ``reach`` if it is larger."""
        return self.still.manifold.min_gap(self._moved(time), reach)

    def is_apart(self, reach: float) -> bool:
        """Return True if the circles, or spheres, round the two pieces stay ``reach`` (mm) apart all the time."""
        spans = self.spans(self.path)
        centre = self.still.centre
        away = np.linalg.norm(spans.ends[:, 1, : len(centre)] - centre, axis=1) - spans.travel
        return bool((away - spans.off - self.mover.radius - self.still.radius >= reach).all())

    def overlap(self, around: float, count: int = 120) -> Overlap:
        """Look at ``count`` poses and at ``around`` for the deepest overlap."""
        times = np.unique(np.append(np.linspace(self.times[0], self.times[-1], count), around))
        depth = np.array([self.depth_at(float(time)) for time in times])
        touching = times[depth > 0] if depth.any() else np.array([around])
        deepest = int(depth.argmax()) if depth.any() else int(np.argmin(np.abs(times - around)))
        return Overlap(float(times[deepest]), float(depth[deepest]), float(touching[0]), float(touching[-1]))

    def depth_at(self, time: float) -> float:
        """Return how deep (mm) the pieces overlap: the least width of what they share, in any of the directions."""
        common = self.still.manifold ^ self._moved(time)
        if common.is_empty():
            return 0.0
        corners = common.to_mesh().vert_properties[:, :3]
        return float(np.ptp(corners @ self.directions, axis=0).min())

    def _moved(self, time: float) -> Any:
        moment = np.array([time])
        x, y, theta = relative(self.path.mover.poses_at(moment), self.path.still.poses_at(moment))[0]
        c, s = np.cos(theta), np.sin(theta)
        return self.mover.manifold.transform(np.array([[c, -s, 0, x], [s, c, 0, y], [0, 0, 1, 0]]))


# The search for the least gap between two pieces over a motion, proven for all time, not only at measured poses.
#
# Branch and bound over space and time. A candidate is a group of facets of either piece (tree.py) and a span of time.
# Within the span every point of the mover stays within e = h^2 / 8 max |a| of the straight line between its ends (h is
# the span's length, a the acceleration that path.py bounds), which gives three tests:
#
# - groups whose upright cylinders or boxes stay apart by more than what is sought are dropped; of others the larger
#   group is halved, or the span where the mover travels farther in it than the groups are wide;
# - of two single facets the gap is measured at the middle of the span: an upper bound of the least gap;
# - a direction that separates two facets by s0 and s1 at the ends of the span separates them by min(s0, s1) - e in
#   between: a lower bound. Along the normal of either facet parts may slide past each other as fast as they like and it
#   stays sharp. If it is not enough, the span is halved. The sides of the boxes do the same for whole groups of facets.
#
# The rest is known to :data:`RESOLUTION`. The cost follows from how much surface runs close to other surface, not
# from how close it runs or how fast.

RESOLUTION = 0.005
"""The proven gap is at most this (mm) below one that was measured, apart from the error between samples."""
FARTHEST_OFF = 1.0
"""Doubt of the motion between two samples (mm) beyond which parts must be this much farther apart."""
BATCH = 20_000
"""Candidates looked at in one go, those of the least bounds first."""
MOST = 30_000_000
"""Candidates of a pair. One that needs more is settled with what is proven by then."""


@dataclass(frozen=True)
class Least:
    """The least gap (mm) that was measured, when, what is proven, and how many poses were measured."""

    gap: float
    time: float
    proven: float
    poses: int
    error: float = 0.0
    """Deduction from the proven gap for the time between samples (mm)."""
    given_up: bool = False
    """True if the search ended at :data:`MOST` candidates."""


class Search:
    """Branch and bound for one pair.

    A candidate is a row (node of the still piece, node of the mover, span).
    """

    resolution = RESOLUTION
    most = MOST

    a: Any
    b: Any

    def __init__(self, still: Tree, mover: Tree, path: RelativePath, offset: np.ndarray) -> None:
        """``offset`` (2,): the origin of ``still`` in its body's frame (mm).

        That of ``mover`` is ``path.centre``.
        """
        self.a, self.b = still, mover
        self.offset = np.append(offset, 0.0)
        to_plane = np.array([1.0, 1j])
        self._centre_a, self._centre_b = (still.centre + offset) @ to_plane, mover.centre @ to_plane
        self._box_a, self._box_b = (still.box_centre + offset) @ to_plane, mover.box_centre @ to_plane
        self._begin(Spans(path))

    def _begin(self, spans: Any) -> None:
        self.spans = spans
        self.best = self.time = self.proven = self.off = 0.0
        self.looked = 0
        """Candidates looked at."""
        self.given_up = False

    def run(self, best: float, time: float, poses: int) -> Least:
        """Until nothing is left that could be nearer than what is known, less the resolution.

        ``best`` is a gap (mm) measured at ``time``, after ``poses`` measurements.
        """
        self.best, self.time, self.proven = best, time, np.inf
        spans = np.arange(len(self.spans))
        rows = np.column_stack([np.ones_like(spans), np.ones_like(spans), spans])
        todo = [(rows, np.zeros(len(rows)))]
        while todo and self.best > 0:
            rows, low = self._taken(todo)
            self.looked += len(rows)
            if self.looked > self.most:
                self.given_up = True
                for rest in (*todo, (rows, low)):
                    self._settle(*rest)
                break
            fresh = self._look(rows, low)
            if len(fresh[0]):
                todo.append(fresh)
        gap = self.best
        proven = min(max(self.proven, 0.0), gap) if gap > 0 else 0.0
        return Least(gap, self.time, proven, poses + len(self.spans), self.off, self.given_up)

    @staticmethod
    def _taken(todo: list[tuple[np.ndarray, np.ndarray]]) -> tuple[np.ndarray, np.ndarray]:
        """Return some candidates off the end of the list, the nearest of them if there are many: depth before
        breadth.
        """
        parts = [todo.pop()]
        while todo and sum(len(low) for _, low in parts) < BATCH // 4:
            parts.append(todo.pop())
        rows, low = (np.concatenate(column) for column in zip(*parts, strict=True))
        if len(rows) > BATCH:
            order = np.argpartition(low, BATCH)
            todo.append((rows[order[BATCH:]], low[order[BATCH:]]))
            rows, low = rows[order[:BATCH]], low[order[:BATCH]]
        return rows, low

    def _look(self, rows: np.ndarray, low: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return the candidates that follow from these, and their lower bounds."""
        _, b, span = rows.T
        stray = self.spans.stray(span, self.b.reach[b])
        low = np.maximum(low, self._apart(rows) - stray)
        near = low < self._sought(span)  # False for groups without facets, whose bounds are not numbers
        low[near] = np.maximum(low[near], self._boxes_apart(rows[near]))
        near &= low < self._sought(span)
        self._settle(rows[~near], low[~near])
        rows, low, stray = rows[near], low[near], stray[near]
        single = (rows[:, 0] >= self.a.leaves) & (rows[:, 1] >= self.b.leaves)
        wide = ~single & (stray > self.a.radius[rows[:, 0]] + self.b.radius[rows[:, 1]])
        group = ~single & ~wide
        parts = [self._measured(rows[single]), self._halved_groups(rows[group], low[group])]
        parts.append(self._halved_spans(rows[wide], low[wide]))
        return np.concatenate([part for part, _ in parts]), np.concatenate([bound for _, bound in parts])

    def _sought(self, span: np.ndarray) -> np.ndarray:
        """Return (n,) the distance beyond which nothing is of interest.

        What is proven to be this far apart (mm) in these spans is of no more interest.
        """
        return self.best - self.resolution + np.minimum(self.spans.off[span], FARTHEST_OFF)

    def _settle(self, rows: np.ndarray, low: np.ndarray) -> None:
        """Candidates that are done: the gap is never below their bounds less the error of the motion."""
        known = ~np.isnan(low)
        if not known.any():
            return
        error = self.spans.off[rows[known, 2]]
        proven = low[known] - error
        least = int(proven.argmin())
        if proven[least] < self.proven:
            self.proven, self.off = float(proven[least]), float(error[least])

    def _apart(self, rows: np.ndarray) -> np.ndarray:
        """Return (n,) the gap (mm) of the two groups' cylinders at the middle of the span."""
        a, b, span = rows.T
        way = self.spans.place[span, 1] + self.spans.turned[span, 1] * self._centre_b[b] - self._centre_a[a]
        return np.hypot(np.maximum(np.abs(way) - self.a.radius[a] - self.b.radius[b], 0.0), self._height(a, b))

    def _boxes_apart(self, rows: np.ndarray) -> np.ndarray:
        """Return (n,) how far (mm) two groups' boxes stay apart over a span, along a side of either.

        They are apart along a side of either. A side's direction is that of the still box, or that of the mover's at
        the middle of the span; along it the boxes are apart by the least of what they are at start and end.
        """
        a, b, span = rows.T
        along_a, across_a = self.a.box_half[a].T
        along_b, across_b = self.b.box_half[b].T
        turned, centre = self.spans.turned[span] * self.b.axis, self._box_b[b] / self.b.axis
        box_a = self._box_a[a]
        lean = turned[:, 1] / self.a.axis
        c, s = np.abs(lean.real), np.abs(lean.imag)
        wide = c * along_a + s * across_a, s * along_a + c * across_a
        """Half the widths of the still box along and across the mover's."""
        plane = None
        for k in (0, 2):
            way = self.spans.place[span, k] + turned[:, k] * centre - box_a
            lean, seen = turned[:, k] / self.a.axis, way / self.a.axis
            c, s = np.abs(lean.real), np.abs(lean.imag)
            sides = [
                (seen.real, along_a + c * along_b + s * across_b),
                (seen.imag, across_a + s * along_b + c * across_b),
            ]
            lean, seen = turned[:, k] * turned[:, 1].conj(), way * turned[:, 1].conj()
            c, s = np.abs(lean.real), np.abs(lean.imag)
            sides += [
                (seen.real, wide[0] + c * along_b + s * across_b),
                (seen.imag, wide[1] + s * along_b + c * across_b),
            ]
            gaps = [gap for away, half in sides for gap in (away - half, -away - half)]
            plane = gaps if plane is None else [np.minimum(x, y) for x, y in zip(plane, gaps, strict=True)]
        most = np.maximum.reduce(plane or [])
        most -= self.spans.push[span] + self.b.reach[b] * self.spans.spin[span]
        return np.hypot(np.maximum(most, 0.0), self._height(a, b))

    def _height(self, a: np.ndarray, b: np.ndarray) -> np.ndarray:
        """Return (n,) the height (mm) between two groups, 0 where they share some."""
        return np.maximum(np.maximum(self.a.low[a] - self.b.high[b], self.b.low[b] - self.a.high[a]), 0.0)

    def _measured(self, rows: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return halves of spans that pairs of facets still need, with their bounds.

        The gap at the middle and the bound over the span are entered.
        """
        if not len(rows):
            return rows, np.empty(0)
        a, b, span = rows.T
        gap, low = self._bounded(a - self.a.leaves, b - self.b.leaves, span)
        nearest_one = int(gap.argmin())
        if gap[nearest_one] < self.best:
            self.best, self.time = (
                float(gap[nearest_one]),
                float(self.spans.middle(span[nearest_one : nearest_one + 1])[0]),
            )
        low -= self.spans.push[span] + self.b.reach[b] * self.spans.spin[span]
        enough = gap - self.resolution - 0.1 * self.spans.off[span]
        open_ = low < np.minimum(self._sought(span), enough)
        self._settle(rows[~open_], low[~open_])
        return self._halved_spans(rows[open_], np.maximum(low[open_], 0.0))

    def _bounded(self, a: np.ndarray, b: np.ndarray, span: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return two numbers (n,) for each pair of single facets.

        The gap (mm) at the middle of the span, and what the best direction separates them by at both its ends.
        """
        p, q = self.a.facets[a] + self.offset, self.b.facets[b]
        first, middle, last = (self._facets(q, span, k) for k in range(3))
        gap, way = nearest(p, middle)
        straight = way / np.maximum(gap, 1e-12)[:, None]
        gap = np.where(separation(straight, p, middle) > 0.0, gap, 0.0)  # else they pierce each other
        low = np.full(len(p), -np.inf)
        for direction in (straight, _facing(normals(p), way), _facing(normals(middle), way)):
            ends = np.minimum(separation(direction, p, first), separation(direction, p, last))
            low = np.maximum(low, np.where((direction != 0).any(axis=1), ends, -np.inf))
        return gap, low

    def _facets(self, q: np.ndarray, span: np.ndarray, k: int) -> np.ndarray:
        """Return facets (n, 3, 3) of the mover at start, middle or end (``k`` 0, 1, 2) of each span."""
        return _placed(q, self.spans.ends[span, k])

    def _halved_spans(self, rows: np.ndarray, low: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        if not len(rows):
            return rows, low
        first = rows.copy()
        first[:, 2] = self.spans.halves(rows[:, 2])
        return np.concatenate([first, first + np.array([0, 0, 1])]), np.tile(low, 2)

    def _halved_groups(self, rows: np.ndarray, low: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return the larger group of each candidate in two."""
        if not len(rows):
            return rows, low
        a, b, _ = rows.T
        of_a = (a < self.a.leaves) & ((b >= self.b.leaves) | (self.a.radius[a] >= self.b.radius[b]))
        column = np.where(of_a, 0, 1)
        each = np.arange(len(rows))
        first, second = rows.copy(), rows.copy()
        first[each, column] = 2 * rows[each, column]
        second[each, column] = 2 * rows[each, column] + 1
        return np.concatenate([first, second]), np.tile(low, 2)


def _placed(q: np.ndarray, pose: np.ndarray) -> np.ndarray:
    """Return facets (n, 3, 3) at poses (n, 3) of x, y, theta."""
    c, s = np.cos(pose[:, 2:]), np.sin(pose[:, 2:])
    x = pose[:, :1] + c * q[:, :, 0] - s * q[:, :, 1]
    y = pose[:, 1:2] + s * q[:, :, 0] + c * q[:, :, 1]
    return np.stack([x, y, q[:, :, 2]], axis=2)


def _facing(normal: np.ndarray, way: np.ndarray) -> np.ndarray:
    """Return normals (n, 3) turned to the side that the way goes to."""
    side = np.einsum("ni,ni->n", normal, way)
    return normal * np.where(side < 0, -1.0, 1.0)[:, None]
