"""The least gap between two pieces over a motion, with a proof for the time between the measured poses.

The gap cannot shrink faster than the parts travel. Between two poses with gaps g1 and g2, where no point moves more
than s relative to the other part, it stays above (g1 + g2 - s) / 2; an interval is halved until that is enough.
The gap at a pose is the exact distance of the two meshes (manifold3d), 0 if they overlap.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np

from mechanisms.clearance.path import BodyPath, dense_times, points, relative, travelled
from mechanisms.clearance.pieces import MeshPiece

START = 24
"""Intervals to begin with."""
TRAVEL_SLACK = 0.002
"""Covers that speed varies between two points where travel is known (mm)."""
MOST_POSES = 20_000
"""A pair that needs more is refused: it slides along within a hair of the limit."""


@dataclass(frozen=True)
class Least:
    """The least gap (mm) that was found, when, what is proven, and how many poses were measured."""

    gap: float
    time: float
    proven: float
    poses: int


@dataclass(frozen=True)
class Overlap:
    """Where two pieces overlap most: when, how deep (mm), and from when to when they were seen to touch."""

    time: float
    depth: float
    first: float
    last: float


class Sweep:
    """Two pieces on their paths. One stands still, the other moves relative to it, whichever travels less."""

    def __init__(self, first: MeshPiece, second: MeshPiece, path_first: BodyPath, path_second: BodyPath) -> None:
        self.times = dense_times(path_first.time)
        options = []
        for mover, still, mover_path, still_path in (
            (first, second, path_first, path_second),
            (second, first, path_second, path_first),
        ):
            pose = relative(mover_path.at(self.times), still_path.at(self.times))
            options.append((travelled(pose, mover.centre, mover.radius), pose, mover, still, mover_path, still_path))
        self.travel, self.pose, self.mover, self.still, self._mover_path, self._still_path = min(
            options, key=lambda option: option[0][-1]
        )

    def circle_gap(self) -> float:
        """A lower bound (mm) of the gap: that of the circles round the two pieces, over the whole motion."""
        away = np.linalg.norm(points(self.pose, self.mover.centre) - self.still.centre, axis=1)
        slack = float(np.diff(self.travel).max(initial=0.0))
        return float(away.min()) - slack - self.mover.radius - self.still.radius

    def gap_at(self, time: float, reach: float) -> float:
        """Exact gap (mm) at a time, 0 if the pieces overlap, ``reach`` if it is larger."""
        return self.still.manifold.min_gap(self._moved(time), reach)

    def least(self, limit: float, reach: float) -> Least:
        """The least gap; stops early below ``limit``. Proven over all time, not only at the measured poses."""
        times = [float(t) for t in np.interp(np.linspace(0, 1, START + 1), _share(self.times), self.times)]
        gaps: dict[float, float] = {}
        for time in times:
            gaps[time] = self.gap_at(time, reach)
            if gaps[time] < limit or self.travel[-1] == 0:
                return Least(gaps[time], time, gaps[time] if gaps[time] >= limit else 0.0, len(gaps))
        best = min(gaps, key=gaps.__getitem__)
        proven = gaps[best]
        todo = list(pairwise(times))
        while todo:
            if gaps[best] < limit or len(gaps) > MOST_POSES:
                return Least(gaps[best], best, 0.0, len(gaps))
            start, end = todo.pop()
            bound = (gaps[start] + gaps[end] - self._travel(start, end)) / 2
            if bound >= gaps[best] / 2:
                proven = min(proven, bound)
                continue
            middle = (start + end) / 2
            gaps[middle] = self.gap_at(middle, reach)
            best = min(best, middle, key=gaps.__getitem__)
            todo += [(start, middle), (middle, end)]
        time, gap = self._polished(best, sorted(gaps), reach)
        return Least(gap, time, min(proven, gap), len(gaps))

    def overlap(self, around: float, count: int = 120) -> Overlap:
        """Look at ``count`` poses and at ``around`` for the deepest overlap."""
        times = np.unique(np.append(np.linspace(self.times[0], self.times[-1], count), around))
        depth = np.array([self.depth_at(float(time)) for time in times])
        touching = times[depth > 0] if depth.any() else np.array([around])
        deepest = int(depth.argmax()) if depth.any() else int(np.argmin(np.abs(times - around)))
        return Overlap(float(times[deepest]), float(depth[deepest]), float(touching[0]), float(touching[-1]))

    def depth_at(self, time: float) -> float:
        """How deep (mm) the pieces overlap: the least width of what they share, in height or in the plane."""
        common = self.still.manifold ^ self._moved(time)
        if common.is_empty():
            return 0.0
        corners = common.to_mesh().vert_properties[:, :3]
        angles = np.radians(np.arange(0, 180, 5))
        across = corners[:, :2] @ np.stack([np.cos(angles), np.sin(angles)])
        return float(min(np.ptp(corners[:, 2]), np.ptp(across, axis=0).min()))

    def _moved(self, time: float) -> Any:
        moment = np.array([time])
        x, y, theta = relative(self._mover_path.at(moment), self._still_path.at(moment))[0]
        c, s = np.cos(theta), np.sin(theta)
        return self.mover.manifold.transform(np.array([[c, -s, 0, x], [s, c, 0, y], [0, 0, 1, 0]]))

    def _travel(self, start: float, end: float) -> float:
        """How far the mover can travel between two times (mm)."""
        first, last = np.interp([start, end], self.times, self.travel)
        return float(last - first) + TRAVEL_SLACK

    def _polished(self, best: float, times: list[float], reach: float) -> tuple[float, float]:
        """Look for the bottom of the valley round the best pose."""
        from scipy.optimize import minimize_scalar

        at = times.index(best)
        low, high = times[max(at - 1, 0)], times[min(at + 1, len(times) - 1)]
        gap = self.gap_at(best, reach)
        found = minimize_scalar(
            lambda t: self.gap_at(float(t), reach), bounds=(low, high), method="bounded", options={"maxiter": 16}
        )
        return (float(found.x), float(found.fun)) if found.fun < gap else (best, gap)


def _share(times: np.ndarray) -> np.ndarray:
    return (times - times[0]) / (times[-1] - times[0])
