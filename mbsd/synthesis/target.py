"""Targets of paths: the places on paths that are nearest to given points, and the distances from them.

A path is sampled at equal times. Between the samples it is a chord for the search, and the polynomial of degree six
through seven samples for the final fit.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

BACKWARDS = 60
"""Places of the path that are compared with a closed curve."""


@dataclass(frozen=True, eq=False)
class Target:
    """Points (N, 2) (m) to pass through."""

    points: np.ndarray
    times: np.ndarray | None
    """(N,) at which each is reached (s); None: whenever it is nearest."""
    closed: bool
    """True if the points are a closed curve that is the whole path."""
    returns: bool
    """True if the path comes back to its start at the end of the motion."""
    span: tuple[float, float]
    """The motion's first and last time (s)."""
    ordered: bool = False
    """True if the points are reached one after the other."""

    @property
    def extent(self) -> float:
        """Diagonal of the points (m)."""
        return float(np.hypot(*np.ptp(self.points, axis=0)))

    def squares(self, paths: np.ndarray, shifts: np.ndarray) -> np.ndarray:
        """Return (n,) mean squared distance (m^2) of paths (n, T, 2), times shifted by ``shifts`` (n,) (s)."""
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
        """Return (n, N) sample numbers of places on paths (n, T, 2) that stand for the points.

        They are on chords or exact.
        """
        if self.times is not None:
            return self._samples(paths.shape[1], shifts)
        if fine:
            find = feet_in_order if self.ordered else feet
            return np.array([find(path, self.points, self.returns) for path in paths]).reshape(len(paths), -1)
        if self.ordered:
            return chord_feet_in_order(paths, self.points, self.returns)
        return nearest_on_chords(paths, self.points)[1]

    def missed(self, paths: np.ndarray, where: np.ndarray, fine: bool) -> np.ndarray:
        """Return (n, r, 2) differences (m) of the points from places ``where`` (n, N) of paths (n, T, 2).

        Where the points are a closed curve, differences of the paths from it follow, weighed so that both count alike.
        """
        if fine:
            places = np.array([places_at(path, along, self.returns) for path, along in zip(paths, where, strict=True)])
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
        """Return (n, N, 2) unit vectors along paths (n, T, 2) at places ``where`` (n, N)."""
        if fine:
            h = 1e-4
            ends = [
                np.array(
                    [places_at(path, along + step, self.returns) for path, along in zip(paths, where, strict=True)]
                )
                for step in (-h, h)
            ]
            line = (ends[1] - ends[0]).reshape(len(paths), -1, 2)
        else:
            rows, below = np.arange(len(paths))[:, None], wrapped(where, paths.shape[1])[0]
            line = paths[rows, below + 1] - paths[rows, below]
        return line / np.maximum(np.hypot(*np.moveaxis(line, -1, 0)), 1e-300)[..., None]

    def reached(self, path: np.ndarray, shift: float) -> np.ndarray:
        """Return (N, 2) the places of one path (T, 2) that stand for the points (m)."""
        if self.times is None:
            find = feet_in_order if self.ordered else feet
            return places_at(path, find(path, self.points, self.returns), self.returns)
        where = self._samples(len(path), np.array([shift]))[0]
        return places_at(path, where, self.returns)

    def _ring(self) -> np.ndarray:
        """Return the points as a closed polygon of few corners, the first once more at its end."""
        points = self.points if len(self.points) <= BACKWARDS else resampled(self.points, True, BACKWARDS)
        return np.vstack([points, points[:1]])

    def _samples(self, count: int, shifts: np.ndarray) -> np.ndarray:
        """Return (n, N) sample numbers, not whole, of the points' times."""
        assert self.times is not None
        first, last = self.span
        part = (self.times + shifts[:, None] - first) / (last - first)
        part = part % 1.0 if self.returns else np.clip(part, 0.0, 1.0)
        return part * (count - 1)


STENCIL = np.arange(-3, 4)
"""Samples about the nearest one, through which the polynomial runs."""
_POWERS = np.linalg.inv(STENCIL[:, None].astype(float) ** np.arange(7))
"""(7, 7) from samples to coefficients by rising powers."""
NEWTON_STEPS = 12
THERE = 1e-13
"""Step of a sample number after which Newton's method ends."""
CUTS = 24
"""Places of a closed path that are tried as the one before the first of ordered points."""


def nearest_on_chords(paths: np.ndarray, points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return squared distances (n, N) of points (N, 2) from chords of paths, and sample numbers (n, N).

    Paths are (n, T, 2).
    """
    distance, ahead = _from_chords(paths, points)
    best = distance.argmin(axis=2)
    take = best[..., None]
    return np.take_along_axis(distance, take, 2)[..., 0], best + np.take_along_axis(ahead, take, 2)[..., 0]


def in_order(paths: np.ndarray, points: np.ndarray, closed: bool) -> tuple[np.ndarray, np.ndarray]:
    """Return (n,) least sums of squared distances of points (N, 2) in order, and the cuts (n,).

    The points are reached one after the other. Of paths (n, T, 2) of chords; of closed ones the first point may be
    anywhere, and all follow within one turn after the sample ``cut``. The best place of each point given those before
    it is found by dynamic programming: S_k(s) = d_k(s)^2 + min over r <= s of S_(k-1)(r).
    """
    return _in_order(_from_chords(paths, points)[0], closed)


def _in_order(distance: np.ndarray, closed: bool) -> tuple[np.ndarray, np.ndarray]:
    count = distance.shape[2]
    cuts = np.arange(0, count, max(1, count // CUTS)) if closed else np.zeros(1, int)
    turned = (cuts[:, None] + np.arange(count)) % count
    sums = distance[:, 0][:, turned]  # (n, cuts, T - 1)
    for k in range(1, distance.shape[1]):
        np.minimum.accumulate(sums, axis=-1, out=sums)
        sums += distance[:, k][:, turned]
    least = sums.min(axis=-1)
    best = least.argmin(axis=1)
    return np.take_along_axis(least, best[:, None], 1)[:, 0], cuts[best]


def _from_chords(paths: np.ndarray, points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return (n, N, T - 1) squared distances from each chord, and the part of it before the nearest place."""
    ends = np.diff(paths, axis=1)[:, None]  # (n, 1, T - 1, 2)
    away = points[None, :, None] - paths[:, None, :-1]  # (n, N, T - 1, 2)
    square = np.maximum((ends**2).sum(-1), 1e-300)
    ahead = np.clip((away * ends).sum(-1) / square, 0.0, 1.0)
    return ((away - ahead[..., None] * ends) ** 2).sum(-1), ahead


def wrapped(where: np.ndarray, samples: int) -> tuple[np.ndarray, np.ndarray]:
    """Return samples below sample numbers ``where`` and the part of a chord after them; a path goes round."""
    chords = samples - 1
    turned = np.where(where > chords, where - chords, where)
    below = np.clip(np.floor(turned).astype(int), 0, chords - 1)
    return below, turned - below


def on_chords(paths: np.ndarray, where: np.ndarray) -> np.ndarray:
    """Return (n, N, 2) places of paths (n, T, 2) of chords at sample numbers ``where`` (n, N)."""
    below, ahead = wrapped(where, paths.shape[1])
    rows, part = np.arange(len(paths))[:, None], ahead[..., None]
    return (1 - part) * paths[rows, below] + part * paths[rows, below + 1]


def places_at(path: np.ndarray, where: np.ndarray, closed: bool) -> np.ndarray:
    """Return (N, 2) places of a path (T, 2) at sample numbers ``where`` (N,), not whole."""
    middle, coefficients = _pieces(path, where, closed)
    return np.einsum("np,npc->nc", (where - middle)[:, None] ** np.arange(7), coefficients)


def feet(path: np.ndarray, points: np.ndarray, closed: bool) -> np.ndarray:
    """Return (N,) sample numbers at which a path (T, 2), closed or not, is nearest to points (N, 2)."""
    return _refined(path, points, nearest_on_chords(path[None], points)[1][0], closed)


def feet_in_order(path: np.ndarray, points: np.ndarray, closed: bool) -> np.ndarray:
    """Return (N,) rising sample numbers at which a path (T, 2) is nearest to points (N, 2) in order.

    Those of a closed path rise from a start anywhere to less than a turn later.
    """
    where = chord_feet_in_order(path[None], points, closed)[0]
    return np.maximum.accumulate(_refined(path, points, where, closed))


def chord_feet_in_order(paths: np.ndarray, points: np.ndarray, closed: bool) -> np.ndarray:
    """Return (n, N) the same of paths (n, T, 2) of chords."""
    distance, ahead = _from_chords(paths, points)
    cut, count = _in_order(distance, closed)[1], distance.shape[2]
    turned = ((cut[:, None] + np.arange(count)) % count)[:, None]
    distance, ahead = (np.take_along_axis(part, turned, 2) for part in (distance, ahead))
    sums = [distance[:, 0]]
    for k in range(1, len(points)):
        sums.append(np.minimum.accumulate(sums[-1], axis=-1) + distance[:, k])
    chords, last = np.zeros((len(paths), len(points)), int), np.full(len(paths), count)
    for k in reversed(range(len(points))):
        chords[:, k] = np.where(np.arange(count) < last[:, None], sums[k], np.inf).argmin(axis=-1)
        last = chords[:, k] + 1
    return cut[:, None] + chords + np.take_along_axis(ahead, chords[..., None], 2)[..., 0]


def _refined(path: np.ndarray, points: np.ndarray, where: np.ndarray, closed: bool) -> np.ndarray:
    """Return the nearest places (N,) beside those of the chords, on the polynomials."""
    middle, coefficients = _pieces(path, where, closed)
    last, powers = len(path) - 1.0, np.arange(7)
    rates = powers[1:, None] * coefficients[:, 1:]
    bends = powers[1:-1, None] * rates[:, 1:]
    whole = np.zeros((len(points), 7, 6))  # places, derivatives and second derivatives by rising powers
    whole[..., :2], whole[:, :6, 2:4], whole[:, :5, 4:] = coefficients, rates, bends
    for _ in range(NEWTON_STEPS):
        values = np.matmul(((where - middle)[:, None] ** powers)[:, None], whole)[:, 0]
        gap, rate, bend = values[:, :2] - points, values[:, 2:4], values[:, 4:]
        speed = (rate**2).sum(-1)
        slope = speed + (gap * bend).sum(-1)
        slope = np.where(slope > 0.1 * speed, slope, speed)
        step = np.clip((gap * rate).sum(-1) / np.maximum(slope, 1e-300), -1.0, 1.0)
        where = np.clip(where - step, middle - 2.0, middle + 2.0)
        if not closed:
            where = np.clip(where, 0.0, last)
        if np.abs(step).max() < THERE:
            break
    return where


def resampled(points: np.ndarray, closed: bool, count: int) -> np.ndarray:
    """Return (count, 2) points at equal distances along a polygon (N, 2)."""
    ring = np.vstack([points, points[:1]]) if closed else points
    length = np.append(0.0, np.cumsum(np.hypot(*np.diff(ring, axis=0).T)))
    at_lengths = np.linspace(0.0, length[-1], count, endpoint=not closed)
    return np.column_stack([np.interp(at_lengths, length, ring[:, axis]) for axis in (0, 1)])


def _pieces(path: np.ndarray, where: np.ndarray, closed: bool) -> tuple[np.ndarray, np.ndarray]:
    """Return the middle sample (N,) of each polynomial, and its coefficients (N, 7, 2)."""
    count = len(path) - 1
    middle = np.rint(where).astype(int)
    if closed:  # the last sample is the first again
        rows = (middle[:, None] + STENCIL) % count
    else:
        middle = np.clip(middle, 3, count - 3)
        rows = middle[:, None] + STENCIL
    return middle, np.einsum("ps,nsc->npc", _POWERS, path[rows])
