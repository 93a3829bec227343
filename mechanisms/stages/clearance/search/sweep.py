"""Two pieces over a motion: their gap at a time, whether they stay far apart, and where they overlap."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from mechanisms.stages.clearance.path import BodyPath, RelativePath, relative
from mechanisms.stages.clearance.pieces import MeshPiece
from mechanisms.stages.clearance.search.spans import Spans


@dataclass(frozen=True)
class Overlap:
    """Where two pieces overlap most: when, how deep (mm), and from when to when they were seen to touch."""

    time: float
    depth: float
    first: float
    last: float


class Sweep:
    """Two pieces on their paths. One stands still, the other moves relative to it, whichever bends its paths less."""

    def __init__(self, first: MeshPiece, second: MeshPiece, path_first: BodyPath, path_second: BodyPath) -> None:
        ends = [path_first.interpolation_error(first.reach), path_second.interpolation_error(second.reach)]
        self.error = ends[0] + ends[1]
        """(m,): how far the two may be from where they are taken to be, in each interval of data.json (mm)."""
        options = []
        for mover, still, moved, seen in (
            (first, second, path_first, path_second),
            (second, first, path_second, path_first),
        ):
            path = RelativePath(moved, seen, mover.centre, self.error)
            options.append((path.bend(mover.radius), path, mover, still))
        _, self.path, self.mover, self.still = min(options, key=lambda option: option[0])
        self.times = self.path.mover.time

    def gap_at(self, time: float, reach: float) -> float:
        """Exact gap (mm) at a time, 0 if the pieces overlap, ``reach`` if it is larger."""
        return self.still.manifold.min_gap(self._moved(time), reach)

    def is_apart(self, reach: float) -> bool:
        """Whether the circles round the two pieces stay ``reach`` (mm) apart over the whole motion."""
        spans = Spans(self.path)
        away = np.hypot(*(spans.ends[:, 1, :2] - self.still.centre).T) - spans.travel
        return bool((away - spans.off - self.mover.radius - self.still.radius >= reach).all())

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
        x, y, theta = relative(self.path.mover.at(moment), self.path.still.at(moment))[0]
        c, s = np.cos(theta), np.sin(theta)
        return self.mover.manifold.transform(np.array([[c, -s, 0, x], [s, c, 0, y], [0, 0, 1, 0]]))
