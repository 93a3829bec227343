"""The search for the least distance of two meshes in space: pieces, trees of boxes and spans for its rules."""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import cached_property

import numpy as np

from mechanisms.stages.clearance.pieces import MeshPiece, halved, leaf_order, longest_in
from mechanisms.stages.clearance.search import RESOLUTION, Search, Spans, Sweep
from mechanisms.stages.clearance.space.path import SpaceRelative

FINE = 0.02
"""Part of a gap to which it is searched, where that is more than the resolution in the plane."""
SPHERE = 400
"""Directions in which the depth of an overlap is measured."""


def resolution_of(gap: float) -> float:
    """Return how much less than a ``gap`` may be proven (mm)."""
    return max(RESOLUTION, FINE * gap)


class SpaceTree:
    """Facets of a piece, in its frame less ``centre``, in groups: a sphere and a box along the piece's axes hold each.

    Nodes are numbered as those of ``Tree``.
    """

    def __init__(self, triangles: np.ndarray) -> None:
        """``triangles`` (n, 3, 3), less the centre."""
        self.leaves = 1 << max(len(triangles) - 1, 0).bit_length()
        padded = np.full((self.leaves, 3, 3), np.nan)
        padded[: len(triangles)] = triangles
        self.facets = padded[leaf_order(padded.mean(axis=1))]
        """(leaves, 3, 3): by leaf; those beyond the last are not a number, and so near to nothing."""
        normal = np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0])
        size = np.maximum(np.linalg.norm(normal, axis=1), 1e-12)
        self.axes = np.linalg.eigh(np.einsum("ni,nj,n->ij", normal, normal, 1 / size))[1]
        """(3, 3): directions of the sides of all boxes, by column; most faces of a prism are along or across them."""
        along = self.facets @ self.axes
        least, most, far = (np.full((2 * self.leaves, width), np.nan) for width in (3, 3, 1))
        for level in range(self.leaves.bit_length()):
            nodes, corners = slice(1 << level, 2 << level), along.reshape(1 << level, -1, 3)
            least[nodes], most[nodes] = np.fmin.reduce(corners, axis=1), np.fmax.reduce(corners, axis=1)
            away = np.linalg.norm(corners - (least[nodes] + most[nodes])[:, None] / 2, axis=2)
            far[nodes, 0] = np.fmax.reduce(away, axis=1)
        self.centre, self.half = (least + most) / 2 @ self.axes.T, (most - least) / 2
        """(nodes, 3): the centre of each box and sphere (mm), and half the sides of the box."""
        self.radius = far[:, 0]
        self.reach = np.linalg.norm(self.centre, axis=1) + self.radius
        """Reach of the facets of each node from the origin (mm)."""


class SpacePiece(MeshPiece):
    """One piece of a body, with the sphere that holds it."""

    @cached_property
    def centre(self) -> np.ndarray:
        """(3,): the middle of the piece's extent."""
        points = self.triangles.reshape(-1, 3)
        return (points.min(axis=0) + points.max(axis=0)) / 2

    @cached_property
    def radius(self) -> float:
        """Radius of the sphere round ``centre`` that holds the piece."""
        return float(np.linalg.norm(self.triangles.reshape(-1, 3) - self.centre, axis=1).max())

    @cached_property
    def facets(self) -> np.ndarray:
        """(n, 3, 3): its facets, long ones in pieces."""
        return halved(self.triangles, longest_in(self.radius), axes=3)

    @cached_property
    def spheres(self) -> SpaceTree:
        """All facets by place, relative to ``centre``."""
        return self.tree_of(self.facets)

    def tree_of(self, facets: np.ndarray) -> SpaceTree:
        """Return a tree of some of its facets, relative to ``centre``."""
        return SpaceTree(facets - self.centre)


class SpaceSpans(Spans):
    """As :class:`Spans`: ``ends`` (n, 3, 3) are the centre's places, ``turned`` (n, 3, 3, 3) the rotations there."""

    begin = 32

    def _poses(
        self, places: Sequence[tuple[np.ndarray, np.ndarray]], push: np.ndarray, spin: np.ndarray
    ) -> dict[str, np.ndarray]:
        poses = [self.path.place(k, time) for k, time in places]
        ends, turned = (np.stack(column, axis=1) for column in zip(*poses, strict=True))
        away = np.linalg.norm(ends - ends[:, 1:2], axis=2).max(axis=1)
        alike = np.einsum("nkij,nij->nk", turned, turned[:, 1]).min(axis=1)
        """Trace of the rotation to the middle: 1 + 2 cos of its angle."""
        return {
            "ends": ends,
            "turned": turned,
            "travel": away + push,
            "turn": np.sqrt(np.maximum(3.0 - alike, 0.0)) + spin,
        }


class SpaceSweep(Sweep):
    """Two pieces on their paths in space."""

    relative = SpaceRelative
    spans = SpaceSpans

    still: SpacePiece
    mover: SpacePiece
    height = np.linspace(-1.0, 1.0, SPHERE + 2)[1:-1]
    turn = math.pi * (3.0 - math.sqrt(5.0)) * np.arange(SPHERE)
    directions = np.stack([np.sqrt(1 - height**2) * np.cos(turn), np.sqrt(1 - height**2) * np.sin(turn), height])

    def _moved(self, time: float) -> object:
        moment = np.array([time])
        place, turned = self.path.place(self.path.mover.interval(moment), moment)
        origin = place[0] - turned[0] @ self.path.centre
        return self.mover.manifold.transform(np.column_stack([turned[0], origin]))


class SpaceSearch(Search):
    """As :class:`Search`, of triangles that move in space."""

    def __init__(self, still: SpaceTree, mover: SpaceTree, path: SpaceRelative, offset: np.ndarray) -> None:
        """``offset`` (3,): the origin of ``still`` in its body's frame (mm)."""
        self.a, self.b, self.offset = still, mover, offset
        self._begin(SpaceSpans(path))

    @property
    def resolution(self) -> float:
        """Largest difference (mm) of the proven gap and the least one that is known by then."""
        return resolution_of(self.best)

    def _apart(self, rows: np.ndarray) -> np.ndarray:
        """Return (n,) the gap (mm) of the two groups' spheres at the middle of the span."""
        a, b, _ = rows.T
        return np.maximum(np.linalg.norm(self._way(rows, 1), axis=1) - self.a.radius[a] - self.b.radius[b], 0.0)

    def _way(self, rows: np.ndarray, k: int) -> np.ndarray:
        """Return (n, 3) the way between the centres of two groups at start, middle or end of a span."""
        a, b, span = rows.T
        turned = np.einsum("nij,nj->ni", self.spans.turned[span, k], self.b.centre[b])
        return self.spans.ends[span, k] + turned - self.a.centre[a] - self.offset

    def _boxes_apart(self, rows: np.ndarray) -> np.ndarray:
        """Return how far (mm) two groups' boxes stay apart over a span, along a side of either.

        A side's direction is that of the still box, or that of the mover's at the middle of the span; along it the
        boxes are apart by the least of what they are at start and end.
        """
        a, b, span = rows.T
        half_a, half_b = self.a.half[a], self.b.half[b]
        sides = self.spans.turned[span, 1] @ self.b.axes
        width = np.einsum("nij,ni->nj", np.abs(self.a.axes.T @ sides), half_a)
        """Half the widths of the still box along the mover's sides."""
        least = None
        for k in (0, 2):
            way, turned = self._way(rows, k), self.spans.turned[span, k] @ self.b.axes
            lean, own = np.abs(self.a.axes.T @ turned), np.abs(np.swapaxes(sides, 1, 2) @ turned)
            along = np.concatenate([way @ self.a.axes, np.einsum("ni,nij->nj", way, sides)], axis=1)
            ends = half_a + np.einsum("nij,nj->ni", lean, half_b), width + np.einsum("nij,nj->ni", own, half_b)
            widths = np.concatenate(ends, axis=1)
            gaps = np.concatenate([along - widths, -along - widths], axis=1)
            least = gaps if least is None else np.minimum(least, gaps)
        assert least is not None
        most = least.max(axis=1) - self.spans.push[span] - self.b.reach[b] * self.spans.spin[span]
        return np.maximum(most, 0.0)

    def _facets(self, q: np.ndarray, span: np.ndarray, k: int) -> np.ndarray:
        return np.einsum("nij,nkj->nki", self.spans.turned[span, k], q) + self.spans.ends[span, k][:, None]
