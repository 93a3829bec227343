"""The motion of two bodies against each other in space, with bounds of its accelerations between samples.

Between two samples places and quaternions are quintics, as the film shows them, here in Bezier form. A body seen from
another follows from products of their quaternions, and products of Bezier curves are Bezier curves: their control
points bound the relative motion, however fast both bodies move together.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property, lru_cache

import numpy as np

from mechanisms.stages.clearance.path import BodyPath, largest
from shared.contract import Motion3
from shared.contract.quaternions import matrices, product
from shared.shapes.units import mm

type Rule = Callable[[np.ndarray, np.ndarray], np.ndarray]
CONJUGATE = np.array([1.0, -1.0, -1.0, -1.0])


@dataclass(frozen=True, eq=False)
class SpacePath(BodyPath):
    """One body over time: (n, 7) x, y, z (mm) and the quaternion, their rates and bends."""

    @cached_property
    def turned(self) -> np.ndarray:
        """(m, 6, 4): control points of the quaternion in each interval."""
        return self.control[:, :, 3:]

    def _sizes(self, change: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        return np.linalg.norm(change[..., :3], axis=-1), 2 * np.linalg.norm(change[..., 3:], axis=-1)


def paths_in_space(motion: Motion3) -> dict[str, SpacePath]:
    """Return the path of every body, ``ground`` included."""
    time = np.array(motion.time)
    still = np.tile([0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0], (len(time), 1))
    out = {"ground": SpacePath(time, still, 0 * still, 0 * still)}
    for name, body in motion.bodies.items():
        place, turned = body.changes
        columns = [np.column_stack([mm(1) * x, q]) for x, q in zip(place, turned, strict=True)]
        out[name] = SpacePath(time, *columns)
    return out


def seen(mover: np.ndarray, still: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return places (n, 3) and rotations (n, 3, 3) of poses (n, 7) in the frame of others."""
    turned, frame = (
        matrices(pose[:, 3:] / np.linalg.norm(pose[:, 3:], axis=1, keepdims=True)) for pose in (mover, still)
    )
    return np.einsum("nji,nj->ni", frame, mover[:, :3] - still[:, :3]), np.einsum("nji,njk->nik", frame, turned)


class SpaceRelative:
    """A body seen from another: its pose at any time, and bounds of the acceleration of its points."""

    def __init__(self, mover: SpacePath, still: SpacePath, centre: np.ndarray, error: np.ndarray) -> None:
        """``centre`` (3,): the point of the mover that it is followed by (mm, the mover's frame).

        ``error`` (m,): how far the motion may be off in each interval (mm).
        """
        self.mover, self.still, self.centre, self.error = mover, still, centre, error
        pair, h = _pair(mover, still), mover.width
        about = _times(_times(pair.turn, np.array([[[0.0, *centre]]]), product), pair.turn * CONJUGATE, product)
        self.push = largest(pair.way + about, h, 2) + _drift(pair.way, pair.way_square, h)
        self.push += _drift(about, pair.turn_square, h)
        """(m,): the centre's acceleration in the other's frame is at most this in each interval (mm/s^2)."""
        self.spin = pair.spin
        """(m,): every mm between a point and the centre adds this to its acceleration (1/s^2)."""

    def place(self, k: np.ndarray, time: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return the centre's place (n, 3; mm) and the rotation (n, 3, 3) in the other's frame.

        The times lie in intervals ``k``.
        """
        place, turned = seen(self.mover.within(k, time), self.still.within(k, time))
        return place + turned @ self.centre, turned

    def bend(self, radius: float) -> float:
        """Return how far (mm) points within ``radius`` of the centre stray from straight lines, in all."""
        return float((self.mover.width**2 / 8 * (self.push + radius * self.spin)).sum())


@dataclass(frozen=True)
class _Pair:
    """Control points of one body seen from another; squares are those of the lengths of quaternions, nearly 1."""

    turn: np.ndarray
    turn_square: np.ndarray
    way: np.ndarray
    """Place of the origin times ``way_square``, raised to the degree of a point's."""
    way_square: np.ndarray
    spin: np.ndarray


@lru_cache(maxsize=256)
def _pair(mover: SpacePath, still: SpacePath) -> _Pair:
    h, back = mover.width, still.turned * CONJUGATE
    turn = _times(back, mover.turned, product)
    square = _times(turn, turn, _dot)
    gap = mover.control[:, :, :3] - still.control[:, :, :3]
    gap = np.concatenate([0 * gap[:, :, :1], gap], axis=2)
    way = _times(_times(back, gap, product), still.turned, product)
    way = _times(way, np.ones((1, 6, 1)), np.multiply)
    size = np.sqrt(square.min(axis=(1, 2)))
    rate, bend = largest(turn, h, 1) / size, largest(turn, h, 2) / size
    growth = largest(square, h, 1) / (2 * size**2)
    spin = 2 * (bend + 2 * growth * rate) + (2 * rate) ** 2
    return _Pair(turn, square, way, _times(still.turned, still.turned, _dot), spin)


def _dot(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    return (a * b).sum(axis=-1, keepdims=True)


def _times(a: np.ndarray, b: np.ndarray, rule: Rule) -> np.ndarray:
    """Return control points (m, p + q + 1, d) of a product of Bezier curves (m, p + 1, i) and (m, q + 1, j)."""
    p, q = a.shape[1] - 1, b.shape[1] - 1
    out: list[np.ndarray | float] = [0.0] * (p + q + 1)
    for i in range(p + 1):
        for j in range(q + 1):
            weight = math.comb(p, i) * math.comb(q, j) / math.comb(p + q, i + j)
            out[i + j] = out[i + j] + weight * rule(a[:, i], b[:, j])
    return np.stack([np.asarray(point) for point in out], axis=1)


def _drift(way: np.ndarray, square: np.ndarray, width: np.ndarray) -> np.ndarray:
    """Return (m,) how much the second derivative of way / square may differ from that of ``way``."""
    least = square.min(axis=(1, 2))
    first, second = largest(square, width, 1), largest(square, width, 2)
    off = np.abs(square - 1).max(axis=(1, 2)) / least
    rate, bend = first / least**2, second / least**2 + 2 * first**2 / least**3
    size = np.linalg.norm(way, axis=2).max(axis=1)
    return largest(way, width, 2) * off + 2 * largest(way, width, 1) * rate + size * bend
