"""Least distances by outlines: of extruded pieces in the plane, and of faces that look at each other."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from mechanisms.stages.clearance.path import relative
from mechanisms.stages.clearance.pieces import LEVEL, MeshPiece, Tree, facing, height_between, longest_in
from mechanisms.stages.clearance.search import RESOLUTION, Least, Search, Sweep

# The outline of a piece between two heights: the edge of its shadow in the plane, as segments.
#
# Each upright line through a solid leaves it by a facet that looks up. So the shadow is that of these facets, and its
# edge is among those of their edges that no two of them share. Where two facets lie on the same line in the plane, one
# on either side of it, the line is inside the shadow and is left out.

ROUNDING = 1e-8
"""Corners that are nearer to each other than this (in radii of the piece) are one."""


class Outline(Tree):
    """Segments of the shadow's edge, relative to ``centre``; the shadow is on the left of each."""

    def __init__(self, edges: np.ndarray, times: np.ndarray, centre: np.ndarray, radius: float) -> None:
        """``edges`` (n, 2, 2): their ends (mm).

        ``times`` (n,): of how many facets more each is a side, on its left.
        """
        self.edges, self.times = edges, times
        segments = _divided(edges - centre, longest_in(radius))
        along = (segments[:, 1] - segments[:, 0]) @ np.array([1.0, 1j])
        super().__init__(np.concatenate([segments, np.zeros((len(segments), 2, 1))], axis=2), 1j * along)
        self.ends = self.facets[:, :, 0] + 1j * self.facets[:, :, 1]
        """(leaves, 2): by leaf, x + i y."""


def outline(piece: MeshPiece, low: float, high: float) -> Outline | None:
    """Return the outline of what ``piece`` has between two heights (mm); None if that is nothing.

    It is kept with the piece: many others have the same heights in common with it.
    """
    span = max(low, piece.z_range[0]), min(high, piece.z_range[1])
    if span not in piece.outlines:
        piece.outlines[span] = _outline(piece, *span)
    return piece.outlines[span]


def _outline(piece: MeshPiece, low: float, high: float) -> Outline | None:
    mesh = _between(piece, low, high)
    if mesh is None:
        return None
    corners, index = mesh
    p, q, r = (corners[index[:, k], :2] for k in range(3))
    way, side = q - p, r - p
    return _edge(piece, corners, index[way[:, 0] * side[:, 1] - way[:, 1] * side[:, 0] > 0.0])


def edge_of(facets: np.ndarray, piece: MeshPiece) -> Outline | None:
    """Return the edge of the shadow of ``facets`` (n, 3, 3) of a piece; None without any.

    All of them look up, or all look down.
    """
    index = np.arange(3 * len(facets)).reshape(-1, 3)
    (x, y), (u, v) = (facets[0, k, :2] - facets[0, 0, :2] for k in (1, 2))
    return _edge(piece, facets.reshape(-1, 3), index if x * v > y * u else index[:, ::-1])


def _edge(piece: MeshPiece, corners: np.ndarray, up: np.ndarray) -> Outline | None:
    """Return the edge of the shadow of facets ``up`` (m, 3), counter-clockwise seen from above."""
    edges = np.concatenate([up[:, (0, 1)], up[:, (1, 2)], up[:, (2, 0)]])
    grid = np.round(corners[:, :2] / (ROUNDING * piece.radius))
    _, first, place = np.unique(grid, axis=0, return_index=True, return_inverse=True)
    edges, times = _unmatched(place.ravel()[edges], len(first))
    if not len(edges):
        return None
    return Outline(corners[first, :2][edges], times, piece.centre, piece.radius)


def covers(outline: Outline, points: np.ndarray) -> bool:
    """Return True if one of ``points`` (m, 2) is inside the shadow: its edges wind round it."""
    a, b = outline.edges[:, 0], outline.edges[:, 1]
    low, high = outline.edges.min(axis=(0, 1)), outline.edges.max(axis=(0, 1))
    points = points[((points >= low) & (points <= high)).all(axis=1)]
    for some in np.array_split(points, 1 + len(points) * len(a) // 2_000_000):
        x, y = some[:, :1], some[:, 1:]
        left = (b[:, 0] - a[:, 0]) * (y - a[:, 1]) - (x - a[:, 0]) * (b[:, 1] - a[:, 1])
        rises = (a[:, 1] <= y) & (b[:, 1] > y) & (left > 0)
        falls = (a[:, 1] > y) & (b[:, 1] <= y) & (left < 0)
        if (rises @ outline.times > falls @ outline.times).any():
            return True
    return False


def _between(piece: MeshPiece, low: float, high: float) -> tuple[np.ndarray, np.ndarray] | None:
    """Return corners (n, 3) and facets (m, 3) of what is between two heights."""
    solid = piece.manifold
    if low > piece.z_range[0]:
        solid = solid.trim_by_plane((0.0, 0.0, 1.0), low)
    if high < piece.z_range[1]:
        solid = solid.trim_by_plane((0.0, 0.0, -1.0), -high)
    if solid.is_empty():
        return None
    mesh = solid.to_mesh64()
    return np.asarray(mesh.vert_properties)[:, :3], np.asarray(mesh.tri_verts).astype(np.int64)


def _unmatched(edges: np.ndarray, count: int) -> tuple[np.ndarray, np.ndarray]:
    """Return pairs of numbers below ``count`` (n, 2) met more often than reversed, and how much more."""
    edges = edges[edges[:, 0] != edges[:, 1]]
    keys, number = np.unique(edges[:, 0] * count + edges[:, 1], return_counts=True)
    forth = np.stack([keys // count, keys % count], axis=1)
    back = forth[:, 1] * count + forth[:, 0]
    at = np.minimum(np.searchsorted(keys, back), max(len(keys) - 1, 0))
    more = number - np.where(keys[at] == back, number[at], 0)
    return forth[more > 0], more[more > 0]


def _divided(segments: np.ndarray, longest: float) -> np.ndarray:
    """Return segments (n, 2, 2) in equal pieces that are not longer."""
    way = segments[:, 1] - segments[:, 0]
    number = np.maximum(np.ceil(np.hypot(*way.T) / longest), 1).astype(int)
    which = np.repeat(np.arange(len(segments)), number)
    part = (np.arange(len(which)) - np.repeat(np.cumsum(number) - number, number)) / number[which]
    start = segments[which, 0] + part[:, None] * way[which]
    return np.stack([start, start + way[which] / number[which, None]], axis=1)


# The search for the least gap of two outlines in the plane, which is never more than that of the pieces.
#
# Points of two pieces that are nearer than g are less than g apart in height, too. So pieces are g apart if the
# outlines of what either has within g of the heights that both have are g apart in the plane over the whole motion, and
# neither is inside the other at one time, and so at all times. For plates, pins and teeth, whose walls are upright, it
# is the gap itself; and there are fewer segments than facets, and they are simpler.

ALIKE = 1e-4
"""Gap of outlines and gap of pieces (mm) that are taken for one."""


class OutlineSearch(Search):
    """As :class:`Search`, of outlines."""

    resolution = 0.9 * RESOLUTION

    a: Outline  # pyright: ignore[reportIncompatibleVariableOverride]
    b: Outline  # pyright: ignore[reportIncompatibleVariableOverride]

    def _bounded(self, a: np.ndarray, b: np.ndarray, span: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        p = self.a.ends[a] + complex(*self.offset[:2])
        q = self.b.ends[b]
        place, turned = self.spans.place[span], self.spans.turned[span]
        first, middle, last = (place[:, k, None] + turned[:, k, None] * q for k in range(3))
        gap, way = nearest(p, middle)
        low = np.full(len(p), -np.inf)
        for direction in (way, 1j * (p[:, 1] - p[:, 0]), 1j * (middle[:, 1] - middle[:, 0])):
            size = np.abs(direction)
            unit = (direction / np.where(size > 0, size, np.inf)).conj()
            unit = np.where((unit * way).real < 0, -unit, unit)
            along = (p * unit[:, None]).real.max(axis=1)
            ends = [(end * unit[:, None]).real.min(axis=1) - along for end in (first, last)]
            low = np.maximum(low, np.where(size > 0, np.minimum(*ends), -np.inf))
        return gap, low


def nearest(p: np.ndarray, q: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the distance (n,) of segments p and q (n, 2; x + i y), and the way (n,) from p to q.

    The distance is 0 where they cross.
    """
    ways = np.stack([-_way(q[:, 0], p), -_way(q[:, 1], p), _way(p[:, 0], q), _way(p[:, 1], q)])
    size = np.abs(ways)
    best = size.argmin(axis=0)
    rows = np.arange(len(p))
    gap = np.where(_cross(p, q), 0.0, size[best, rows])
    return gap, ways[best, rows]


def _way(point: np.ndarray, segment: np.ndarray) -> np.ndarray:
    """Return (n,): from each point to the nearest one of a segment."""
    start, along = segment[:, 0], segment[:, 1] - segment[:, 0]
    square = np.maximum((along * along.conj()).real, 1e-300)
    part = np.clip(((point - start) * along.conj()).real / square, 0.0, 1.0)
    return start + part * along - point


def _cross(p: np.ndarray, q: np.ndarray) -> np.ndarray:
    return (_side(p, q[:, 0]) * _side(p, q[:, 1]) <= 0) & (_side(q, p[:, 0]) * _side(q, p[:, 1]) <= 0)


def _side(segment: np.ndarray, point: np.ndarray) -> np.ndarray:
    return ((segment[:, 1] - segment[:, 0]).conj() * (point - segment[:, 0])).imag


def least_by_outlines(sweep: Sweep, gap: float, time: float, poses: int) -> Least | None:
    """Return the least gap over the motion with its proof; None where outlines do not suffice.

    ``gap`` (mm) of the pieces was measured at ``time``, after ``poses`` measurements. What is near in height depends on
    the least gap, so that is looked for in the common heights alone before.
    """
    least, before = None, _outlines(sweep, 0.0)
    if before is not None:
        least = OutlineSearch(*before, sweep.path, sweep.still.centre).run(gap, time, poses)
        gap, time, poses = _measured(sweep, least, gap, time)
        if least.gap < gap - ALIKE:
            return None
    beyond = max(gap - OutlineSearch.resolution, 0.0)
    both = _outlines(sweep, beyond)
    if both is None:
        return None
    if least is None or before is None or not _same(before, both):
        least = OutlineSearch(*both, sweep.path, sweep.still.centre).run(gap, time, poses)
        gap, time, poses = _measured(sweep, least, gap, time)
        if least.gap < gap - ALIKE:
            return None
    return Least(gap, time, min(max(least.proven - slack(sweep), 0.0), beyond, gap), poses, least.error, least.given_up)


def proven_by_outlines(sweep: Sweep, gap: float, time: float) -> float:
    """Return how far (mm) outlines prove the pieces apart, of the ``gap`` measured at ``time``.

    ``gap`` was measured at ``time``. Walls that lean or bulge bring the outlines nearer than the pieces, so that it may
    be much less than the least gap.
    """
    both = _outlines(sweep, gap)
    if both is None:
        return 0.0
    least = OutlineSearch(*both, sweep.path, sweep.still.centre).run(gap, time, 0)
    return min(max(least.proven - slack(sweep), 0.0), gap)


def slack(sweep: Sweep) -> float:
    """Return how far (mm) outlines may be off, since corners that are near are one."""
    return 4 * ROUNDING * (sweep.still.radius + sweep.mover.radius)


def _measured(sweep: Sweep, least: Least, gap: float, time: float) -> tuple[float, float, int]:
    """Return the least gap that is known of the pieces, its time, and how many poses were measured."""
    if least.gap < gap:
        measured = sweep.gap_at(least.time, gap)
        if measured < gap:
            return measured, least.time, least.poses + 1
    return gap, time, least.poses


def _outlines(sweep: Sweep, beyond: float) -> tuple[Outline, Outline] | None:
    """Return outlines of both pieces within ``beyond`` (mm) of their common heights.

    None if none, or one covers the other.
    """
    low = max(sweep.still.z_range[0], sweep.mover.z_range[0]) - beyond
    high = min(sweep.still.z_range[1], sweep.mover.z_range[1]) + beyond
    still, mover = (outline(piece, low, high) if low < high else None for piece in (sweep.still, sweep.mover))
    if still is None or mover is None or are_over(sweep, still, mover):
        return None
    return still, mover


def are_over(sweep: Sweep, still: Outline, mover: Outline) -> bool:
    """Return True if one of the two covers a corner of the other at the start."""
    moment = sweep.times[:1]
    pose = relative(sweep.path.mover.poses_at(moment), sweep.path.still.poses_at(moment))[0]
    c, s = np.cos(pose[2]), np.sin(pose[2])
    turn = np.array([[c, s], [-s, c]])
    places = mover.edges[:, 0] @ turn + pose[:2], (still.edges[:, 0] - pose[:2]) @ turn.T
    return covers(still, places[0]) or covers(mover, places[1])


def _same(pair: tuple[Outline, Outline], other: tuple[Outline, Outline]) -> bool:
    return all(np.array_equal(x.edges, y.edges) for x, y in zip(pair, other, strict=True))


# Pieces that lie over each other: faces that look at each other seen from above, over the whole motion.
#
# The way from a horizontal face to the nearest point of another solid is vertical, unless a facet beside it is on that
# way too. So where no horizontal face is ever over or under a facet that faces it, within the gap that is sought in
# height, the facets that are not horizontal suffice for the least gap.

BESIDE = 0.2
"""Part of the gap: shadows that stay half of this apart in the plane are known not to meet."""


def never_over(sweep: Sweep, gap: float) -> bool:
    """Return True if no horizontal face of a piece is ever within ``gap`` (mm) over or under the other.

    That is proven of facets of the other that face it. False proves nothing.
    """
    for sign in (1.0, -1.0):
        under, over = _near(sweep.still, sweep.mover, sign, gap)
        lying, facing_it = _near(sweep.mover, sweep.still, sign, gap)
        if not (_apart(sweep, under, over, gap) and _apart(sweep, facing_it, lying, gap)):
            return False
    return True


def _near(lying: MeshPiece, other: MeshPiece, sign: float, gap: float) -> tuple[np.ndarray, np.ndarray]:
    """Return horizontal faces of ``lying`` and the facets of ``other`` that face them.

    The faces look up (``sign`` 1) or down (-1). Of both there are only those that have the other within ``gap`` in
    height.
    """
    faces, facets = facing(lying, other, sign)
    low, high = (sign * facets[:, :, 2]).min(axis=1), (sign * facets[:, :, 2]).max(axis=1)
    levels, of = np.unique(faces[:, 0, 2] * sign, return_inverse=True)
    near = (high[None] >= levels[:, None] - LEVEL) & (low[None] < levels[:, None] + gap)
    return faces[near.any(axis=1)[of]], facets[near.any(axis=0)]


def _apart(sweep: Sweep, still: np.ndarray, mover: np.ndarray, gap: float) -> bool:
    if not len(still) or not len(mover):
        return True
    a, b = (edge_of(facets, piece) for facets, piece in ((still, sweep.still), (mover, sweep.mover)))
    if a is None or b is None or are_over(sweep, a, b):
        return False
    search = OutlineSearch(a, b, sweep.path, sweep.still.centre)
    search.resolution = BESIDE / 2 * gap
    return search.run(BESIDE * gap, float(sweep.times[0]), 0).proven > slack(sweep)


# The least gap of two pieces over a motion, with its proof: of their outlines if these suffice, else in space.

FIRST = 5
"""Poses at which the whole pieces are compared before the search."""


def least_gap(sweep: Sweep, reach: float) -> Least:
    """Return the least gap over the motion, ``reach`` (mm) if it is larger; an overlap ends the search.

    Where the search in space is given up, what the outlines prove holds still.
    """
    starts = np.linspace(sweep.times[0], sweep.times[-1], FIRST)
    gaps = {float(time): sweep.gap_at(float(time), reach) for time in starts}
    best = min(gaps, key=gaps.__getitem__)
    if gaps[best] <= 0:
        return Least(0.0, best, 0.0, len(gaps))
    outlined = least_by_outlines(sweep, gaps[best], best, len(gaps))
    if outlined is not None:
        return outlined
    least = _search(sweep, sweep.still.sides, sweep.mover.sides, gaps[best], best, len(gaps))
    height = height_between(sweep.still, sweep.mover)
    if height >= least.gap - RESOLUTION:
        least = replace(least, proven=min(least.proven, height))
    elif least.gap > 0 and never_over(sweep, least.gap):
        pass  # the sides suffice
    elif not least.given_up:
        least = _search(sweep, sweep.still.tree, sweep.mover.tree, least.gap, least.time, least.poses)
    else:  # more facets would be given up, too
        least = replace(least, proven=0.0)
    if least.given_up and least.gap > 0:
        return replace(least, proven=max(least.proven, proven_by_outlines(sweep, least.gap, least.time)))
    return least


def _search(sweep: Sweep, still: Tree, mover: Tree, gap: float, time: float, poses: int) -> Least:
    return Search(still, mover, sweep.path, sweep.still.centre).run(gap, time, poses)
