"""The space a mechanism sweeps over its whole motion: the camera shows it, and it decides the size of the studio."""

from __future__ import annotations

import cmath
import math
from functools import cached_property
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from render.film.clock import turns_of
from render.film.poses import Moment, Poses
from render.film.solids import outermost, prism, read_corners, swept
from shared.contract import Parts

Array = NDArray[np.float64]
SAMPLES, MOST = 120, 1200
"""Poses over the motion from which the swept space is taken: of a turn or a second, and of the whole at most."""


class SweptSpace:
    """Points (n, 3) in m around everything that is seen, over the whole motion."""

    def __init__(self, poses: Poses, parts: Parts, folder: Path, paths: dict[str, float]) -> None:
        """``folder`` holds the STL files; ``paths`` has the height of each traced point that leaves a trail."""
        self._poses, self._paths = poses, paths
        self._files = {
            body: [folder / piece.stl for piece in solids.pieces.values()] for body, solids in parts.bodies.items()
        }

    @cached_property
    def all(self) -> Array:
        """Everything, the ground with it."""
        return np.concatenate([*self._bodies.values(), *self._trails])

    @cached_property
    def moving(self) -> Array:
        """What moves, trails with it; everything if nothing does."""
        bodies = [cloud for name, cloud in self._bodies.items() if name in self._poses.motion.bodies]
        return np.concatenate([*bodies, *self._trails]) if bodies else self.all

    @cached_property
    def machine(self) -> Array:
        """What moves, without trails; everything if nothing does."""
        bodies = [cloud for name, cloud in self._bodies.items() if name in self._poses.motion.bodies]
        return np.concatenate(bodies) if bodies else self.all

    @cached_property
    def around(self) -> Array:
        """What stands still: the base and all that is fixed to it; nothing if nothing moves."""
        moving = self._poses.motion.bodies
        bodies = [cloud for name, cloud in self._bodies.items() if name not in moving]
        return np.concatenate(bodies) if bodies and len(bodies) < len(self._bodies) else np.zeros((0, 3))

    def places(self, times: Array) -> Array:
        """The outermost points (T, n, 3) of all that moves at ``times`` (T,); none if nothing moves."""
        corners: list[Array] = [np.zeros((len(times), 0, 3))]
        for body, points in self._farthest.items():
            if body in self._poses.motion.bodies:
                corners.append(swept(points, self._poses.over(body, times)).reshape(len(times), -1, 3))
        return np.concatenate(corners, axis=1)

    def outlines(self, body: str) -> list[Array]:
        """The upright prism (n, 3) around each piece of a body, in its frame (m)."""
        return self._outlines.get(body, [])

    @cached_property
    def standing(self) -> Array:
        """What stands still: corners of its pieces, and places between any two corners of one piece."""
        between = np.linspace(0, 1, 9)[:, None, None, None]
        inside = [
            (between * box[None, :, None] + (1 - between) * box[None, None, :]).reshape(-1, 3)
            for box in (box[:: max(1, len(box) // 24)] for box in self._outlines.get("ground", []))
        ]
        return np.concatenate(inside) if inside else np.zeros((0, 3))

    @cached_property
    def middle(self) -> Array:
        """Middle (3,) of the box around everything."""
        return (self.all.min(axis=0) + self.all.max(axis=0)) / 2

    @cached_property
    def size(self) -> float:
        """Diagonal (m) of the box around everything."""
        return float(np.linalg.norm(np.ptp(self.all, axis=0)))

    def tops_at(self, body: str, x: float, y: float, at: Moment) -> list[float]:
        """Heights of the body's pieces whose box, in the body's frame, holds the point (x, y) at that moment."""
        return self.tops_under(body, np.array([[x, y]]), at)[0]

    def tops_under(self, body: str, points: Array, at: Moment) -> list[list[float]]:
        """The same of each of points (n, 2)."""
        if body not in self._boxes:
            return [[] for _ in points]
        low, high, top = self._boxes[body]
        x0, y0, theta = self._poses.body(body, at)
        turned = cmath.exp(-1j * theta) * (points[:, 0] - x0 + 1j * (points[:, 1] - y0))
        local = np.stack([turned.real, turned.imag], axis=1)[:, None]
        holds = ((low <= local) & (local <= high)).all(axis=2)
        return [top[held].tolist() for held in holds]

    @cached_property
    def _boxes(self) -> dict[str, tuple[Array, Array, Array]]:
        """Lowest and highest x, y (n, 2) and the top (n,) of the pieces of each body, in its frame."""
        boxes = {}
        for body, outlines in self._outlines.items():
            low, high = (
                np.array([side(piece, axis=0) for piece in outlines]).reshape(-1, 3) for side in (np.min, np.max)
            )
            boxes[body] = low[:, :2], high[:, :2], high[:, 2]
        return boxes

    @cached_property
    def _outlines(self) -> dict[str, list[Array]]:
        """The upright prism around each piece, in its body's frame."""
        return {body: [prism(read_corners(file)) for file in files] for body, files in self._files.items()}

    @cached_property
    def _farthest(self) -> dict[str, Array]:
        """The outermost points of each body that has solids, in its frame."""
        return {body: outermost(np.concatenate(outlines)) for body, outlines in self._outlines.items() if outlines}

    @cached_property
    def _moments(self) -> list[Moment]:
        motion = self._poses.motion
        start, end = motion.time[0], motion.time[-1]
        if motion.period is not None:
            count = min(SAMPLES * turns_of(motion), MOST)
            return [Moment(start + motion.period * (i / count), 0) for i in range(count)]
        count = min(max(SAMPLES, math.ceil(SAMPLES * (end - start))), MOST)
        return [Moment(float(time), 0) for time in np.linspace(start, end, count + 1)]

    @cached_property
    def _bodies(self) -> dict[str, Array]:
        """The swept points of each body."""
        clouds: dict[str, Array] = {}
        times = np.array([at.time for at in self._moments])
        for body, farthest in self._farthest.items():
            poses = self._poses.over(body, times)
            if np.ptp(poses, axis=0).max() < 1e-12:
                clouds[body] = swept(np.concatenate(self._outlines[body]), poses[:1])
            else:  # a chain of a hundred links would have forty million points
                clouds[body] = swept(farthest, poses)
        return clouds

    @cached_property
    def _trails(self) -> list[Array]:
        times = np.array([at.time for at in self._moments])
        paths = [(self._poses.point(point, times), height) for point, height in self._paths.items()]
        return [np.column_stack([path, np.full(len(path), height)]) for path, height in paths]
