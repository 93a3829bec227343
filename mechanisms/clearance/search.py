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

from mechanisms.clearance.facets import nearest, normals, separation
from mechanisms.clearance.path import RelativePath
from mechanisms.clearance.spans import Spans
from mechanisms.clearance.tree import FacetTree

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


class Search:
    """Branch and bound for one pair; a candidate is a row (node of the still piece, node of the mover, span)."""

    def __init__(self, still: FacetTree, mover: FacetTree, path: RelativePath, offset: np.ndarray) -> None:
        """``offset`` (2,): the origin of ``still`` in its body's frame (mm); that of ``mover`` is ``path.centre``."""
        self.a, self.b = still, mover
        self.offset = np.append(offset, 0.0)
        self.spans = Spans(path)
        self.best = self.time = self.proven = self.off = 0.0
        self.looked = 0
        """Candidates looked at."""

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
            if self.looked > MOST:
                for rest in (*todo, (rows, low)):
                    self._settle(*rest)
                break
            fresh = self._look(rows, low)
            if len(fresh[0]):
                todo.append(fresh)
        gap = self.best
        proven = min(max(self.proven, 0.0), gap) if gap > 0 else 0.0
        return Least(gap, self.time, proven, poses + len(self.spans), self.off)

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
        return self.best - RESOLUTION + np.minimum(self.spans.off[span], FARTHEST_OFF)

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
        x, y, theta = self.spans.ends[span, 1].T
        c, s = np.cos(theta), np.sin(theta)
        bx, by = self.b.centre[b].T
        ax, ay = self.a.centre[a].T + self.offset[:2, None]
        plane = np.hypot(x + c * bx - s * by - ax, y + s * bx + c * by - ay) - self.a.radius[a] - self.b.radius[b]
        height = np.maximum(self.a.low[a] - self.b.high[b], self.b.low[b] - self.a.high[a])
        return np.hypot(np.maximum(plane, 0.0), np.maximum(height, 0.0))

    def _boxes_apart(self, rows: np.ndarray) -> np.ndarray:
        """(n,): how far (mm) the two groups' boxes stay apart over the whole span, along a side of either."""
        a, b, span = rows.T
        poses = self.spans.ends[span]
        centre, half = self.a.box_centre[a] + self.offset[:2], self.a.box_half[a]
        c, s = np.cos(poses[:, :, 2]), np.sin(poses[:, :, 2])
        turn = np.moveaxis(np.array([[c, -s], [s, c]]), (0, 1), (2, 3))
        """(n, 3, 2, 2) at start, middle and end."""
        gap = poses[:, :, :2] + np.einsum("nkij,nj->nki", turn, self.b.box_centre[b]) - centre[:, None]
        axes = np.einsum("nkij,xj->nkxi", turn, self.b.axes)
        plane = np.full(len(rows), -np.inf)
        for direction in (*np.broadcast_to(self.a.axes[:, None], (2, len(rows), 2)), axes[:, 1, 0], axes[:, 1, 1]):
            wide = (np.abs(direction @ self.a.axes.T) * half).sum(axis=1)[:, None]
            wide = wide + (np.abs(np.einsum("nkxi,ni->nkx", axes, direction)) * self.b.box_half[b][:, None]).sum(axis=2)
            along = np.einsum("nki,ni->nk", gap, direction)
            for side in (along - wide, -along - wide):
                plane = np.maximum(plane, np.minimum(side[:, 0], side[:, 2]))
        plane -= self.spans.push[span] + self.b.reach[b] * self.spans.spin[span]
        height = np.maximum(self.a.low[a] - self.b.high[b], self.b.low[b] - self.a.high[a])
        return np.hypot(np.maximum(plane, 0.0), np.maximum(height, 0.0))

    def _measured(self, rows: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Pairs of facets: the gap at the middle, the bound over the span, and the halves of spans that need them."""
        if not len(rows):
            return rows, np.empty(0)
        a, b, span = rows.T
        p = self.a.facets[a - self.a.leaves] + self.offset
        q = self.b.facets[b - self.b.leaves]
        first, middle, last = (_placed(q, self.spans.ends[span, k]) for k in range(3))
        gap, way = nearest(p, middle)
        straight = way / np.maximum(gap, 1e-12)[:, None]
        gap = np.where(separation(straight, p, middle) > 0.0, gap, 0.0)  # else they pierce each other
        nearest_one = int(gap.argmin())
        if gap[nearest_one] < self.best:
            self.best, self.time = (
                float(gap[nearest_one]),
                float(self.spans.middle(span[nearest_one : nearest_one + 1])[0]),
            )
        low = np.full(len(rows), -np.inf)
        for direction in (straight, _facing(normals(p), way), _facing(normals(middle), way)):
            ends = np.minimum(separation(direction, p, first), separation(direction, p, last))
            low = np.maximum(low, np.where((direction != 0).any(axis=1), ends, -np.inf))
        low -= self.spans.push[span] + self.b.reach[b] * self.spans.spin[span]
        enough = gap - RESOLUTION - 0.1 * self.spans.off[span]
        open_ = low < np.minimum(self._sought(span), enough)
        self._settle(rows[~open_], low[~open_])
        return self._halved_spans(rows[open_], np.maximum(low[open_], 0.0))

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
