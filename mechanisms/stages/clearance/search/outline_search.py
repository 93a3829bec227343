"""The search for the least gap of two outlines in the plane, which is never more than that of the pieces.

Points of two pieces that are nearer than g are less than g apart in height, too. So pieces are g apart if the outlines
of what either has within g of the heights that both have are g apart in the plane over the whole motion, and neither is
inside the other at one time, and so at all times. For plates, pins and teeth, whose walls are upright, it is the gap
itself; and there are fewer segments than facets, and they are simpler.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from mechanisms.stages.clearance.path import relative
from mechanisms.stages.clearance.search.outline import ROUNDING, Outline, covers, outline
from mechanisms.stages.clearance.search.search import RESOLUTION, Least, Search

if TYPE_CHECKING:
    from mechanisms.stages.clearance.search.sweep import Sweep

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
    """Distance (n,) of segments p and q (n, 2; x + i y), 0 where they cross, and the way (n,) from p to q."""
    ways = np.stack([-_way(q[:, 0], p), -_way(q[:, 1], p), _way(p[:, 0], q), _way(p[:, 1], q)])
    size = np.abs(ways)
    best = size.argmin(axis=0)
    rows = np.arange(len(p))
    gap = np.where(_cross(p, q), 0.0, size[best, rows])
    return gap, ways[best, rows]


def _way(point: np.ndarray, segment: np.ndarray) -> np.ndarray:
    """(n,): from each point to the nearest one of a segment."""
    start, along = segment[:, 0], segment[:, 1] - segment[:, 0]
    square = np.maximum((along * along.conj()).real, 1e-300)
    part = np.clip(((point - start) * along.conj()).real / square, 0.0, 1.0)
    return start + part * along - point


def _cross(p: np.ndarray, q: np.ndarray) -> np.ndarray:
    return (_side(p, q[:, 0]) * _side(p, q[:, 1]) <= 0) & (_side(q, p[:, 0]) * _side(q, p[:, 1]) <= 0)


def _side(segment: np.ndarray, point: np.ndarray) -> np.ndarray:
    return ((segment[:, 1] - segment[:, 0]).conj() * (point - segment[:, 0])).imag


def least_by_outlines(sweep: Sweep, gap: float, time: float, poses: int) -> Least | None:
    """The least gap over the motion with its proof; None where outlines do not suffice.

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
    """How far (mm) outlines prove the pieces to stay apart, of the ``gap`` that was measured at ``time``.

    Walls that lean or bulge bring the outlines nearer than the pieces, so that it may be much less than the least gap.
    """
    both = _outlines(sweep, gap)
    if both is None:
        return 0.0
    least = OutlineSearch(*both, sweep.path, sweep.still.centre).run(gap, time, 0)
    return min(max(least.proven - slack(sweep), 0.0), gap)


def slack(sweep: Sweep) -> float:
    """How far (mm) outlines may be off, since corners that are near are one."""
    return 4 * ROUNDING * (sweep.still.radius + sweep.mover.radius)


def _measured(sweep: Sweep, least: Least, gap: float, time: float) -> tuple[float, float, int]:
    """The least gap that is known of the pieces, its time, and how many poses were measured."""
    if least.gap < gap:
        measured = sweep.gap_at(least.time, gap)
        if measured < gap:
            return measured, least.time, least.poses + 1
    return gap, time, least.poses


def _outlines(sweep: Sweep, beyond: float) -> tuple[Outline, Outline] | None:
    """Outlines of both pieces within ``beyond`` (mm) of their common heights; None if none, or one covers the other."""
    low = max(sweep.still.z_range[0], sweep.mover.z_range[0]) - beyond
    high = min(sweep.still.z_range[1], sweep.mover.z_range[1]) + beyond
    still, mover = (outline(piece, low, high) if low < high else None for piece in (sweep.still, sweep.mover))
    if still is None or mover is None or are_over(sweep, still, mover):
        return None
    return still, mover


def are_over(sweep: Sweep, still: Outline, mover: Outline) -> bool:
    """Whether one of the two covers a corner of the other at the start."""
    moment = sweep.times[:1]
    pose = relative(sweep.path.mover.at(moment), sweep.path.still.at(moment))[0]
    c, s = np.cos(pose[2]), np.sin(pose[2])
    turn = np.array([[c, s], [-s, c]])
    places = mover.edges[:, 0] @ turn + pose[:2], (still.edges[:, 0] - pose[:2]) @ turn.T
    return covers(still, places[0]) or covers(mover, places[1])


def _same(pair: tuple[Outline, Outline], other: tuple[Outline, Outline]) -> bool:
    return all(np.array_equal(x.edges, y.edges) for x, y in zip(pair, other, strict=True))
