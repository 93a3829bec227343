"""The facets of a piece as a tree of upright cylinders: a circle in the plane and a range of heights hold each group.

A turn in the plane leaves such a cylinder as it is, so it bounds its facets at every pose. Node 1 is the root, node k
has the children 2 k and 2 k + 1, and the leaves are single facets. Upright boxes along the piece's own axes, those of
most of its walls, bound the same groups more closely: a slider's cheeks lie flat in them.
"""

from __future__ import annotations

import numpy as np

SIDES = 4
"""Facets longer than the piece's diameter over this are halved: long ones would be near to everything."""
SHORTEST = 1.0
"""No facet is halved below this length in the plane (mm)."""


class Tree:
    """See the file. Facets may be triangles, or segments of an outline; places are in mm."""

    def __init__(self, facets: np.ndarray, walls: np.ndarray) -> None:
        """``facets`` (n, corners, 3); ``walls`` (n,): their normals in the plane, x + i y, as long as they matter."""
        self.leaves = 1 << max(len(facets) - 1, 0).bit_length()
        """Number of leaves; the first of them is the node of this number."""
        padded = np.full((self.leaves, *facets.shape[1:]), np.nan)
        padded[: len(facets)] = facets
        self.facets = padded[_order(padded.mean(axis=1))]
        """(leaves, corners, 3): by leaf; those beyond the last are not a number, and so near to nothing."""
        self.centre = np.full((2 * self.leaves, 2), np.nan)
        self.radius = np.full(2 * self.leaves, np.nan)
        self.low = np.full(2 * self.leaves, np.nan)
        self.high = np.full(2 * self.leaves, np.nan)
        for level in range(self.leaves.bit_length()):
            nodes = slice(1 << level, 2 << level)
            corners = self.facets.reshape(1 << level, -1, 3)
            low, high = np.fmin.reduce(corners, axis=1), np.fmax.reduce(corners, axis=1)
            self.centre[nodes] = middle = (low[:, :2] + high[:, :2]) / 2
            away = np.hypot(*np.moveaxis(corners[:, :, :2] - middle[:, None], -1, 0))
            self.radius[nodes] = np.fmax.reduce(away, axis=1)
            self.low[nodes], self.high[nodes] = low[:, 2], high[:, 2]
        self.reach = np.hypot(*self.centre.T) + self.radius
        """By node: how far its facets reach from the origin (mm)."""
        self.axis = _axis_of_walls(walls)
        """The unit direction of the boxes' first side, x + i y; the second one is across it."""
        c, s = self.axis.real, self.axis.imag
        axes = np.array([[c, s], [-s, c]])
        along = self.facets[:, :, :2] @ axes.T
        least, most = np.full((2 * self.leaves, 2), np.nan), np.full((2 * self.leaves, 2), np.nan)
        for level in range(self.leaves.bit_length()):
            nodes, corners = slice(1 << level, 2 << level), along.reshape(1 << level, -1, 2)
            least[nodes], most[nodes] = np.fmin.reduce(corners, axis=1), np.fmax.reduce(corners, axis=1)
        self.box_centre, self.box_half = (least + most) / 2 @ axes, (most - least) / 2
        """(nodes, 2): the centre of each box (mm), and half its widths along the axes."""


class FacetTree(Tree):
    """The triangles of a mesh, in its frame less ``centre``."""

    def __init__(self, triangles: np.ndarray, centre: np.ndarray, radius: float) -> None:
        """``triangles`` (n, 3, 3); ``centre`` (2,) and ``radius``: the circle that holds them in the plane."""
        facets = _halved(triangles - np.append(centre, 0.0), longest_in(radius))
        walls = np.cross(facets[:, 1] - facets[:, 0], facets[:, 2] - facets[:, 0])[:, :2] @ np.array([1.0, 1j])
        super().__init__(facets, walls)


def longest_in(radius: float) -> float:
    """How long (mm) facets of a piece may be that a circle of this radius holds."""
    return max(2 * radius / SIDES, SHORTEST)


def _axis_of_walls(walls: np.ndarray) -> complex:
    """The direction, up to quarter turns, of the longest normals together."""
    turned = np.sum(np.abs(walls) * np.exp(4j * np.angle(walls)))
    return complex(np.exp(1j * float(np.angle(turned)) / 4))


def _order(centres: np.ndarray) -> np.ndarray:
    """Leaves halved at the middle of each group's longest side, level by level; what is not a number comes last."""
    order = np.arange(len(centres))[None]
    while order.shape[1] > 1:
        group = centres[order]
        spread = np.nan_to_num(np.fmax.reduce(group, axis=1) - np.fmin.reduce(group, axis=1), nan=0.0)
        longest = spread.argmax(axis=1)
        along = np.take_along_axis(group, longest[:, None, None], axis=2)[:, :, 0]
        order = np.take_along_axis(order, along.argsort(axis=1, kind="stable"), axis=1)
        order = order.reshape(2 * len(order), -1)
    return order[:, 0]


def _halved(t: np.ndarray, longest: float) -> np.ndarray:
    """Triangles halved across their longest edge until none is longer than ``longest`` in the plane."""
    done = []
    while len(t):
        length = np.hypot(*np.moveaxis((np.roll(t, -1, axis=1) - t)[:, :, :2], -1, 0))
        long = length.max(axis=1) > longest
        done.append(t[~long])
        t, length = t[long], length[long]
        turn = (length.argmax(axis=1)[:, None] + np.arange(3)) % 3
        p = np.take_along_axis(t, turn[:, :, None], axis=1)
        middle = (p[:, 0] + p[:, 1]) / 2
        t = np.concatenate([np.stack([p[:, 0], middle, p[:, 2]], axis=1), np.stack([middle, p[:, 1], p[:, 2]], axis=1)])
    return np.concatenate(done)
