"""What a path should follow, and how far one is from it: for many paths at once, and as residuals for one."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from mbsd.synthesis.matching import at, feet, feet_in_order, in_order, nearest_on_chords, resampled

BACKWARDS = 60
"""Places of the path that are compared with a closed curve."""


@dataclass(frozen=True, eq=False)
class Target:
    """Points (N, 2) (m) to pass through."""

    points: np.ndarray
    times: np.ndarray | None
    """(N,) at which each is reached (s); None: whenever it is nearest."""
    closed: bool
    """Whether the points are a closed curve that is the whole path."""
    returns: bool
    """Whether the path comes back to its start at the end of the motion."""
    span: tuple[float, float]
    """The motion's first and last time (s)."""
    ordered: bool = False
    """Whether the points are reached one after the other."""

    @property
    def extent(self) -> float:
        """Diagonal of the points (m)."""
        return float(np.hypot(*np.ptp(self.points, axis=0)))

    def squares(self, paths: np.ndarray, shifts: np.ndarray) -> np.ndarray:
        """(n,) mean squared distance (m^2) of paths (n, T, 2), times shifted by ``shifts`` (n,) (s)."""
        if self.times is not None:
            where = self._samples(paths.shape[1], shifts)
            below = np.clip(np.floor(where).astype(int), 0, paths.shape[1] - 2)
            ahead = (where - below)[..., None]
            rows = np.arange(len(paths))[:, None]
            at_times = (1 - ahead) * paths[rows, below] + ahead * paths[rows, below + 1]
            return ((at_times - self.points) ** 2).sum(-1).mean(-1)
        if self.ordered:
            out = in_order(paths, self.points, self.returns)[0] / len(self.points)
        else:
            out = nearest_on_chords(paths, self.points)[0].mean(-1)
        if self.closed:
            every = max(1, (paths.shape[1] - 1) // BACKWARDS)
            samples = paths[:, :-1:every]
            back = nearest_on_chords(self._ring()[None], samples.reshape(-1, 2))[0][0]
            out = out + back.reshape(samples.shape[:2]).mean(-1)
        return out

    def residuals(self, path: np.ndarray, shift: float) -> np.ndarray:
        """Differences (m) of the points from one path (T, 2), and where the curve is closed, of the path from it."""
        away = (self.reached(path, shift) - self.points).ravel()
        if not (self.closed and self.times is None):
            return away
        every = max(1, (len(path) - 1) // BACKWARDS)
        samples = path[:-1:every]
        square = nearest_on_chords(self._ring()[None], samples)[0][0]
        return np.append(away, np.sqrt(square * len(self.points) / len(samples)))

    def count(self, samples: int) -> int:
        """Of the residuals of a path of so many samples."""
        back = len(range(0, samples - 1, max(1, (samples - 1) // BACKWARDS)))
        return 2 * len(self.points) + (back if self.closed and self.times is None else 0)

    def reached(self, path: np.ndarray, shift: float) -> np.ndarray:
        """(N, 2) the places of one path (T, 2) that stand for the points (m)."""
        if self.times is None:
            find = feet_in_order if self.ordered else feet
            return at(path, find(path, self.points, self.returns), self.returns)
        where = self._samples(len(path), np.array([shift]))[0]
        return at(path, where, self.returns)

    def _ring(self) -> np.ndarray:
        """The points as a closed polygon of few corners, the first once more at its end."""
        points = self.points if len(self.points) <= BACKWARDS else resampled(self.points, True, BACKWARDS)
        return np.vstack([points, points[:1]])

    def _samples(self, count: int, shifts: np.ndarray) -> np.ndarray:
        """(n, N) sample numbers, not whole, of the points' times."""
        assert self.times is not None
        first, last = self.span
        part = (self.times + shifts[:, None] - first) / (last - first)
        part = part % 1.0 if self.returns else np.clip(part, 0.0, 1.0)
        return part * (count - 1)
