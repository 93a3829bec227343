"""Targets of paths, and distances from them: for many paths at once, and as residuals for one."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from mbsd.synthesis.matching import (
    at,
    chord_feet_in_order,
    feet,
    feet_in_order,
    in_order,
    nearest_on_chords,
    on_chords,
    resampled,
    wrapped,
)  # fmt: skip

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
            at_times = on_chords(paths, self._samples(paths.shape[1], shifts))
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

    def where(self, paths: np.ndarray, shifts: np.ndarray, fine: bool) -> np.ndarray:
        """(n, N) sample numbers of the places of paths (n, T, 2) that stand for the points: on chords, or exactly."""
        if self.times is not None:
            return self._samples(paths.shape[1], shifts)
        if fine:
            find = feet_in_order if self.ordered else feet
            return np.array([find(path, self.points, self.returns) for path in paths]).reshape(len(paths), -1)
        if self.ordered:
            return chord_feet_in_order(paths, self.points, self.returns)
        return nearest_on_chords(paths, self.points)[1]

    def missed(self, paths: np.ndarray, where: np.ndarray, fine: bool) -> np.ndarray:
        """(n, r, 2) differences (m) of the points from places ``where`` (n, N) of paths (n, T, 2).

        Where the points are a closed curve, differences of the paths from it follow, weighed so that both count alike.
        """
        if fine:
            places = np.array([at(path, along, self.returns) for path, along in zip(paths, where, strict=True)])
            away = places.reshape(len(paths), -1, 2) - self.points
        else:
            away = on_chords(paths, where) - self.points
        if not (self.closed and self.times is None):
            return away
        samples = paths[:, : -1 : max(1, (paths.shape[1] - 1) // BACKWARDS)]
        ring, flat = self._ring()[None], samples.reshape(-1, 2)
        beside = flat - on_chords(ring, nearest_on_chords(ring, flat)[1])[0]
        weight = np.sqrt(len(self.points) / samples.shape[1])
        return np.concatenate([away, weight * beside.reshape(samples.shape)], axis=1)

    def directions(self, paths: np.ndarray, where: np.ndarray, fine: bool) -> np.ndarray:
        """(n, N, 2) unit vectors along paths (n, T, 2) at places ``where`` (n, N)."""
        if fine:
            h = 1e-4
            ends = [
                np.array([at(path, along + step, self.returns) for path, along in zip(paths, where, strict=True)])
                for step in (-h, h)
            ]
            line = (ends[1] - ends[0]).reshape(len(paths), -1, 2)
        else:
            rows, below = np.arange(len(paths))[:, None], wrapped(where, paths.shape[1])[0]
            line = paths[rows, below + 1] - paths[rows, below]
        return line / np.maximum(np.hypot(*np.moveaxis(line, -1, 0)), 1e-300)[..., None]

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
