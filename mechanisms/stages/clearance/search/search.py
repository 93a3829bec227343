"""The search for the least gap between two pieces over a motion, proven for all time, not only at measured poses.

Branch and bound over space and time. A candidate is a group of facets of either piece (tree.py) and a span of time.
Within the span every point of the mover stays within e = h^2 / 8 max |a| of the straight line between its ends (h is
the span's length, a the acceleration that path.py bounds), which gives three tests:

- groups whose upright cylinders or boxes stay apart by more than what is sought are dropped; of others the larger group
  is halved, or the span where the mover travels farther in it than the groups are wide;
- of two single facets the gap is measured at the middle of the span: an upper bound of the least gap;
- a direction that separates two facets by s0 and s1 at the ends of the span separates them by min(s0, s1) - e in
  between: a lower bound. Along the normal of either facet parts may slide past each other as fast as they like and it
  stays sharp. If it is not enough, the span is halved. The sides of the boxes do the same for whole groups of facets.

What is left is known to :data:`RESOLUTION`. The cost follows from how much surface runs close to other surface, not
from how close it runs or how fast.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from mechanisms.stages.clearance.path import RelativePath
from mechanisms.stages.clearance.search.facets import nearest, normals, separation
from mechanisms.stages.clearance.search.spans import Spans
from mechanisms.stages.clearance.tree import Tree

RESOLUTION = 0.005
"""The proven gap is at most this (mm) below one that was measured, apart from the error between samples."""
FARTHEST_OFF = 1.0
"""Where the motion may be farther off than this between two samples (mm), parts must be this much farther apart."""
BATCH = 20_000
"""Candidates looked at in one go, those of the least bounds first."""
MOST = 30_000_000
"""Candidates of a pair. One that needs more is settled with what is proven by then."""


@dataclass(frozen=True)
class Least:
    """The least gap (mm) that was measured, when, what is proven over all time, and how many poses were measured."""

    gap: float
    time: float
    proven: float
    poses: int
    error: float = 0.0
    """What the time between samples takes off the proven gap (mm)."""
    given_up: bool = False
    """Whether the search ended at :data:`MOST` candidates."""


class Search:
    """Branch and bound for one pair; a candidate is a row (node of the still piece, node of the mover, span)."""

    resolution = RESOLUTION
    most = MOST

    def __init__(self, still: Tree, mover: Tree, path: RelativePath, offset: np.ndarray) -> None:
        """``offset`` (2,): the origin of ``still`` in its body's frame (mm); that of ``mover`` is ``path.centre``."""
        self.a, self.b = still, mover
        self.offset = np.append(offset, 0.0)
        to_plane = np.array([1.0, 1j])
        self._centre_a, self._centre_b = (still.centre + offset) @ to_plane, mover.centre @ to_plane
        self._box_a, self._box_b = (still.box_centre + offset) @ to_plane, mover.box_centre @ to_plane
        self.spans = Spans(path)
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
        """Some candidates off the end of the list, the nearest of them if there are many: depth before breadth."""
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
        """The candidates that follow from these, and their lower bounds."""
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
        """(n,): what is proven to be this far apart (mm) in these spans is of no more interest."""
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
        """(n,): the gap (mm) of the two groups' cylinders at the middle of the span."""
        a, b, span = rows.T
        way = self.spans.place[span, 1] + self.spans.turned[span, 1] * self._centre_b[b] - self._centre_a[a]
        return np.hypot(np.maximum(np.abs(way) - self.a.radius[a] - self.b.radius[b], 0.0), self._height(a, b))

    def _boxes_apart(self, rows: np.ndarray) -> np.ndarray:
        """(n,): how far (mm) the two groups' boxes stay apart over the whole span, along a side of either.

        A side's direction is that of the still box, or that of the mover's at the middle of the span; along it the
        boxes are apart by the least of what they are at start and end.
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
        """(n,): the height (mm) between two groups, 0 where they share some."""
        return np.maximum(np.maximum(self.a.low[a] - self.b.high[b], self.b.low[b] - self.a.high[a]), 0.0)

    def _measured(self, rows: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Pairs of facets: the gap at the middle, the bound over the span, and the halves of spans that need them."""
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
        """(n,) each, of pairs of single facets: the gap (mm) at the middle of the span; what the best direction
        separates them by at both its ends.
        """
        p, q = self.a.facets[a] + self.offset, self.b.facets[b]
        first, middle, last = (_placed(q, self.spans.ends[span, k]) for k in range(3))
        gap, way = nearest(p, middle)
        straight = way / np.maximum(gap, 1e-12)[:, None]
        gap = np.where(separation(straight, p, middle) > 0.0, gap, 0.0)  # else they pierce each other
        low = np.full(len(p), -np.inf)
        for direction in (straight, _facing(normals(p), way), _facing(normals(middle), way)):
            ends = np.minimum(separation(direction, p, first), separation(direction, p, last))
            low = np.maximum(low, np.where((direction != 0).any(axis=1), ends, -np.inf))
        return gap, low

    def _halved_spans(self, rows: np.ndarray, low: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        if not len(rows):
            return rows, low
        first = rows.copy()
        first[:, 2] = self.spans.halves(rows[:, 2])
        return np.concatenate([first, first + np.array([0, 0, 1])]), np.tile(low, 2)

    def _halved_groups(self, rows: np.ndarray, low: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """The larger group of each candidate in two."""
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
    """Facets (n, 3, 3) at poses (n, 3) of x, y, theta."""
    c, s = np.cos(pose[:, 2:]), np.sin(pose[:, 2:])
    x = pose[:, :1] + c * q[:, :, 0] - s * q[:, :, 1]
    y = pose[:, 1:2] + s * q[:, :, 0] + c * q[:, :, 1]
    return np.stack([x, y, q[:, :, 2]], axis=2)


def _facing(normal: np.ndarray, way: np.ndarray) -> np.ndarray:
    """Normals (n, 3) turned to the side that the way goes to."""
    side = np.einsum("ni,ni->n", normal, way)
    return normal * np.where(side < 0, -1.0, 1.0)[:, None]
