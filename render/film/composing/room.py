"""Room for words: places of the picture in which nothing moves."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from render.film.composing.layout import Box
from render.film.framing import CameraPose, project
from render.presets import ASPECT

Array = NDArray[np.float64]
PARTS = 0.0, 0.04, 0.08, 0.12, 0.16, 0.2, 0.24
"""Fractions of the picture's height, kept empty at its top for words, at its bottom for a legend: the first enough."""


def held(camera: CameraPose, points: Array, place: Box, aspect: float = ASPECT) -> int:
    """How many of ``points`` (n, 3) are in a place of the picture: left, upper, right and lower edge, in its parts."""
    left, upper, right, lower = place
    size = np.array([aspect, 1.0])
    x, y = (project(camera, points, *size) / size).T
    return int(((x >= left) & (x <= right) & (y >= upper) & (y <= lower)).sum())


def is_free(poses: Sequence[CameraPose], moving: Array, place: Box, aspect: float = ASPECT) -> bool:
    """Whether nothing that moves (n, 3) comes into a place of the picture."""
    return place[2] <= place[0] or not any(held(pose, moving, place, aspect) for pose in poses)


def emptiest(
    poses: Sequence[CameraPose], moving: Array, standing: Array, places: Mapping[str, Box], aspect: float = ASPECT
) -> str:
    """The corner of the picture that holds the fewest points of what moves (n, 3), then of what stands (m, 3)."""

    def crowd(corner: str) -> tuple[int, ...]:
        here = places[corner]
        return tuple(sum(held(pose, points, here, aspect) for pose in poses) for points in (moving, standing))

    return min(places, key=crowd)
