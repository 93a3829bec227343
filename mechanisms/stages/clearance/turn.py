"""The gap between two pieces that turn about a common axis, computed for every angle at once.

A turn about the axis leaves distance from the axis, r, and height, z, of every point as they are. So the distance
between the two meshes drawn in the (r, z) half-plane is a lower bound of their gap at every angle, and it is reached
if the parts turn fully. Each facet is enclosed in a box in (r, z); facets that could be nearest are split until the
bound is as sharp as asked for.
"""

from __future__ import annotations

import numpy as np

from mechanisms.stages.clearance.pieces import distinct

RESOLUTION = 0.004
"""The bound is at most this far (mm) below what is reached, or ROUNDS are over."""
ROUNDS = 14
ROUNDING = 1e-4
"""Boxes are widened to multiples of this (mm), so that those of a turned part coincide."""
GROUP = 32
"""Boxes that are looked at together."""
MANY = 4_000_000
"""Pairs of boxes in one go."""


def turn_gap(first: np.ndarray, second: np.ndarray, reach: float, limit: float = 0.0) -> tuple[float, float]:
    """Return the gap (mm) of two meshes (n, 3, 3) that turn about the z axis: reached, and proven.

    The first number is the distance of two points that some angle brings there; the second is below the gap at
    every angle, and less than the first by :data:`RESOLUTION` as a rule. Gaps beyond ``reach`` are given as
    ``reach``; a gap that is seen to be below ``limit`` is not looked at further. Holds for surfaces; whether one
    mesh is inside the other is to be seen at a single pose.
    """
    a, b, best, proven = first, second, reach, 0.0
    for near in (reach, None):
        a, b = _within(a, b, near or best), _within(b, a, near or best)
        if not len(a) or not len(b):
            return reach, reach
        best = min(best, _reached(a, b))
    for _ in range(ROUNDS):
        if best < limit:
            return best, 0.0
        box_a, box_b = ring_boxes(a), ring_boxes(b)
        a, box_a = _near(a, box_a, _hull(box_b), best)
        b, box_b = _near(b, box_b, _hull(box_a), best)
        if not len(a) or not len(b):
            break
        enough = best - RESOLUTION if best < reach else reach
        low_a, low_b = nearest_boxes(box_a, box_b, enough)
        proven = float(low_a.min())
        if proven >= enough:
            break
        a, b = _split(a[low_a < enough]), _split(b[low_b < enough])
        best = min(best, _reached(a, b))
    else:
        return best, proven
    return (best, max(best - RESOLUTION, 0.0)) if best < reach else (reach, reach)


def ring_boxes(t: np.ndarray) -> np.ndarray:
    """Return (n, 4): least r, largest r, least z, largest z of each triangle, rounded outwards."""
    r = np.hypot(t[:, :, 0], t[:, :, 1])
    z = t[:, :, 2]
    low = np.column_stack([_least_radius(t)[0], z.min(axis=1)])
    high = np.column_stack([r.max(axis=1), z.max(axis=1)])
    low, high = np.floor(low / ROUNDING) * ROUNDING, np.ceil(high / ROUNDING) * ROUNDING
    return np.column_stack([low[:, 0], high[:, 0], low[:, 1], high[:, 1]])


def _least_radius(t: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the least r of each triangle, and (n, 2) the nearest point of its edges, in (r, z).

    The least r is 0 if the axis pierces it.
    """
    p, q = t, np.roll(t, -1, axis=1)
    d = q - p
    length = np.einsum("nij,nij->ni", d[:, :, :2], d[:, :, :2])
    u = np.clip(-np.einsum("nij,nij->ni", p[:, :, :2], d[:, :, :2]) / np.where(length > 0, length, 1.0), 0.0, 1.0)
    nearest = p + u[:, :, None] * d
    r = np.hypot(nearest[:, :, 0], nearest[:, :, 1])
    edge = r.argmin(axis=1)
    rows = np.arange(len(t))
    side = p[:, :, 0] * q[:, :, 1] - p[:, :, 1] * q[:, :, 0]
    pierced = (side > 0).all(axis=1) | (side < 0).all(axis=1)
    on_edge = np.column_stack([r[rows, edge], nearest[rows, edge, 2]])
    return np.where(pierced, 0.0, on_edge[:, 0]), on_edge


def _within(t: np.ndarray, other: np.ndarray, reach: float) -> np.ndarray:
    """Return a piece without the triangles that are clearly farther from a mesh than ``reach``.

    That is seen by their heights, and by the radii of their corners, which are not farther from any point of a triangle
    than its longest edge.
    """
    r, z = np.hypot(t[:, :, 0], t[:, :, 1]), t[:, :, 2]
    radius, height = np.hypot(other[:, :, 0], other[:, :, 1]), other[:, :, 2]
    room = reach + ROUNDING
    near = (z.min(axis=1) < height.max() + room) & (z.max(axis=1) > height.min() - room)
    edge = np.roll(t, -1, axis=1) - t
    longest = np.sqrt(np.einsum("nij,nij->ni", edge, edge).max(axis=1))
    return t[near & (r.min(axis=1) - longest < radius.max() + room)]


def _hull(box: np.ndarray) -> np.ndarray:
    return np.array([[box[:, 0].min(), box[:, 1].max(), box[:, 2].min(), box[:, 3].max()]]) if len(box) else box


def _near(t: np.ndarray, box: np.ndarray, other: np.ndarray, reach: float) -> tuple[np.ndarray, np.ndarray]:
    if not len(t) or not len(other):
        return t[:0], box[:0]
    keep = _box_gap(box, other)[:, 0] < reach
    return t[keep], box[keep]


def _box_gap(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Return (n, m): distances between boxes."""
    return _pair_gap(a[:, None], b[None])


def nearest_boxes(a: np.ndarray, b: np.ndarray, enough: float) -> tuple[np.ndarray, np.ndarray]:
    """Return each box's distance to the nearest box of the other set, ``enough`` at most."""
    (first_a, which_a), (first_b, which_b) = distinct(a), distinct(b)
    (a, place_a, hull_a), (b, place_b, hull_b) = _grouped(a[first_a]), _grouped(b[first_b])
    low_a, low_b = np.full(len(a), max(enough, 0.0)), np.full(len(b), max(enough, 0.0))
    pairs = np.argwhere(_box_gap(hull_a, hull_b) < enough)
    for some in np.array_split(pairs, 1 + len(pairs) * GROUP * GROUP // MANY):
        rows, columns = (group[:, None] * GROUP + np.arange(GROUP) for group in some.T)
        gap = _pair_gap(a[rows][:, :, None], b[columns][:, None])
        np.minimum.at(low_a, rows, gap.min(axis=2))
        np.minimum.at(low_b, columns, gap.min(axis=1))
    return low_a[place_a][which_a], low_b[place_b][which_b]


def _grouped(boxes: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return boxes in groups of :data:`GROUP` that are near each other, and where each box is.

    The last box is there as often as is missing; the third result is (groups, 4) the box round each group.
    """
    count = -(-len(boxes) // GROUP)
    strips = max(1, round(count**0.5))
    z, r = boxes[:, 2] + boxes[:, 3], boxes[:, 0] + boxes[:, 1]
    order = np.argsort(z, kind="stable")
    order = np.concatenate([strip[np.argsort(r[strip], kind="stable")] for strip in np.array_split(order, strips)])
    place = np.empty(len(boxes), dtype=np.int64)
    place[order] = np.arange(len(boxes))
    grouped = boxes[np.append(order, np.full(count * GROUP - len(boxes), order[-1]))]
    members = grouped.reshape(count, GROUP, 4)
    low, high = members.min(axis=1), members.max(axis=1)
    return grouped, place, np.column_stack([low[:, 0], high[:, 1], low[:, 2], high[:, 3]])


def _pair_gap(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Return distances of boxes (..., 4)."""
    r = np.maximum(np.maximum(a[..., 0] - b[..., 1], b[..., 0] - a[..., 1]), 0.0)
    z = np.maximum(np.maximum(a[..., 2] - b[..., 3], b[..., 2] - a[..., 3]), 0.0)
    return np.hypot(r, z)


def _reached(a: np.ndarray, b: np.ndarray) -> float:
    """Return the least distance between points of the two surfaces in (r, z): an upper bound."""
    from scipy.spatial import KDTree

    first, second = sorted((_samples(a), _samples(b)), key=len)
    return float(KDTree(second).query(first)[0].min())


def _samples(t: np.ndarray) -> np.ndarray:
    """Return (n, 2) in (r, z) the corners of triangles, and points of their edges nearest to the axis.

    One point stands for all within :data:`ROUNDING` of each other, as corners of a turned part are.
    """
    corners = np.column_stack([np.hypot(t[:, :, 0], t[:, :, 1]).ravel(), t[:, :, 2].ravel()])
    points = np.concatenate([corners, _least_radius(t)[1]])
    r, z = np.round(points / ROUNDING).astype(np.int64).T
    _, first = np.unique((r << 32) + z, return_index=True)
    return points[first]


def _split(t: np.ndarray) -> np.ndarray:
    """Halve every triangle across its longest edge."""
    d = np.linalg.norm(np.roll(t, -1, axis=1) - t, axis=2)
    turn = (d.argmax(axis=1)[:, None] + np.arange(3)) % 3
    p = np.take_along_axis(t, turn[:, :, None], axis=1)
    middle = (p[:, 0] + p[:, 1]) / 2
    return np.concatenate([np.stack([p[:, 0], middle, p[:, 2]], axis=1), np.stack([middle, p[:, 1], p[:, 2]], axis=1)])
