"""Stands of a story's cameras, and the eased paths between them.

A stand counts in the axes of the studio; what is followed moves it. Cameras stay above all that moves: along the
normal of the plane nothing is as high as they are, so none ever goes through a part.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from render.film.camera import Subject, point
from render.film.composing.filling import View, held
from render.film.framing import REFERENCE_WIDTH, SENSOR, CameraPose, axes, depth_of_field, in_studio, in_world
from shared.contract.mount import Vector

Array = NDArray[np.float64]
OVER = 0.06
"""A camera is higher above all parts than this, in its distances."""


@dataclass(frozen=True)
class Stand:
    """Where a camera looks at, from which side (rad) and how far away (m)."""

    target: tuple[float, float, float]
    azimuth: float
    elevation: float
    distance: float
    lens: float

    @property
    def position(self) -> Array:
        """(3,) in the axes of the studio."""
        return np.array(self.target) - axes(self.azimuth, self.elevation)[2] * self.distance


def stand(subject: Subject, up: Vector, view: View) -> Stand:
    """The nearest stand from which a camera holds its subject, as films of one shot do."""
    few, around, drawn = (in_studio(points, up) for points in (subject.few, subject.around, subject.drawn))
    position, distance = view.stand(held(view, few, around, drawn, few))
    target = position + axes(view.azimuth, view.elevation)[2] * distance
    return Stand(point(target), view.azimuth, view.elevation, distance, view.lens)


def between(a: Stand, b: Stand, part: float) -> Stand:
    """A stand on the path from ``a`` to ``b``, 0 .. 1; distances change by equal factors."""
    if a == b:
        return a
    target = (1 - part) * np.array(a.target) + part * np.array(b.target)
    azimuth, elevation, lens = (
        (1 - part) * x + part * y for x, y in ((a.azimuth, b.azimuth), (a.elevation, b.elevation), (a.lens, b.lens))
    )
    distance = a.distance ** (1 - part) * b.distance**part
    return Stand(point(target), azimuth, elevation, distance, lens)


def raised(stand: Stand, up: Vector, top: float) -> Stand:
    """The stand, so far back that the camera is above ``top`` (m) along the normal of the plane."""
    normal = in_studio(np.array([0.0, 0.0, 1.0]), up)
    back = -float(axes(stand.azimuth, stand.elevation)[2] @ normal)
    height = float(np.array(stand.target) @ normal)
    if back < 1e-3:
        return stand
    needed = (top - height) / (back - OVER) if back > OVER else 0.0
    return stand if stand.distance >= needed else at_distance(stand, needed)


def at_distance(stand: Stand, distance: float) -> Stand:
    """The stand at another distance (m) from what it looks at."""
    return Stand(stand.target, stand.azimuth, stand.elevation, distance, stand.lens)


def posed(stand: Stand, up: Vector, sharp: Array, blur: float, by: Array | None = None) -> CameraPose:
    """A camera at a stand, moved ``by`` (3,) m of the world, that blurs the nearest and farthest of points ``sharp``
    (n, 3) of the world by so many pixels of a picture 1280 wide.
    """
    position = stand.position
    depths = (in_studio(sharp, up) - position) @ axes(stand.azimuth, stand.elevation)[2]
    near = max(float(depths.min()), 0.05 * stand.distance)
    focus, fstop = depth_of_field(near, max(float(depths.max()), 1.001 * near), stand.lens, blur)
    return _camera(stand, up, by, focus, fstop)


def focused(stand: Stand, up: Vector, blur: float) -> CameraPose:
    """A camera with a shallow depth: what it looks at is sharp, a fifth of the distance behind it ``blur`` pixels."""
    focus, away = stand.distance, 1.2 * stand.distance
    disc, length = blur * SENSOR / REFERENCE_WIDTH / 1000, stand.lens / 1000
    fstop = length**2 * (away - focus) / (disc * away * (focus - length)) if blur > 0 and focus > length else 0.0
    return _camera(stand, up, None, focus, fstop)


def _camera(stand: Stand, up: Vector, by: Array | None, focus: float, fstop: float) -> CameraPose:
    position = in_world(stand.position, up) + (0.0 if by is None else by)
    return CameraPose(
        position=point(np.round(position, 9)), azimuth=stand.azimuth, elevation=stand.elevation, lens=stand.lens,
        focus=focus, fstop=fstop, up=up,
    )  # fmt: skip


def turned(stand: Stand, azimuth: float, elevation: float = 0.0, nearer: float = 1.0) -> Stand:
    """The stand turned about what it looks at by so many degrees, at ``nearer`` times its distance."""
    return Stand(
        stand.target,
        stand.azimuth + math.radians(azimuth),
        min(stand.elevation + math.radians(elevation), math.radians(85)),
        stand.distance * nearer,
        stand.lens,
    )
