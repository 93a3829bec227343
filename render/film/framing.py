"""Frames what moves: the distance of the camera, and where a point of the world is in the picture.

World axes: the motion is in x, y; the unit vector ``up`` of the mount points up. On a desk that is z, x is right and y
away, and azimuth 0 looks along +y; positive azimuth walks the camera to the right. Where ``up`` is in the plane of the
motion, that plane stands, and azimuth 0 looks along -z: all but :func:`axes` and :func:`project` then counts in the
axes of the :func:`studio`. A picture has an aspect, its width over its height; its longer side is that of the sensor,
as with a camera that is turned on its side. Pixel (0, 0) is the upper left corner of the upper left pixel.
"""

from __future__ import annotations

import math

import msgspec
import numpy as np
from numpy.typing import NDArray

from render.presets import ASPECT
from shared.contract.parts import Vector, Z

Array = NDArray[np.float64]
Empty = tuple[float, float]
"""Parts of the picture's height that stay empty at its top and at its bottom, beside the margin."""
SENSOR = 36.0
"""Longer side of the sensor, mm."""
NEAREST = 0.5
"""The camera stays this far, in sizes of what it films, from the nearest point, however slender that is."""
REFERENCE_WIDTH = 1280
"""The width, in pixels, in which the shot's blur is given."""


class CameraPose(msgspec.Struct, kw_only=True, frozen=True):
    """A placed camera. Lengths in m, angles in rad, lens in mm; fstop 0 is a pinhole."""

    position: tuple[float, float, float]
    azimuth: float
    elevation: float
    lens: float
    focus: float
    fstop: float
    up: Vector = Z
    """Unit vector of the world that points up."""


def studio(up: Vector) -> Array:
    """Return rows right, away and up (3, 3) of the studio in the world.

    ``up`` is z, or a unit vector in the plane.
    """
    if up == Z:
        return np.eye(3)
    x, y, _ = up
    return np.array([[y, -x, 0.0], [0.0, 0.0, -1.0], [x, y, 0.0]])


def axes(azimuth: float, elevation: float, up: Vector = Z) -> Array:
    """Return rows right, up, forward (3, 3) of a camera at these angles (rad)."""
    ca, sa, ce, se = math.cos(azimuth), math.sin(azimuth), math.cos(elevation), math.sin(elevation)
    rows = np.array([[ca, sa, 0.0], [-sa * se, ca * se, ce], [-sa * ce, ca * ce, -se]])
    return rows if up == Z else rows @ studio(up)


def in_studio(points: Array, up: Vector) -> Array:
    """Return points (..., 3) of the world in the axes of the studio."""
    return points if up == Z else points @ studio(up).T


def in_world(points: Array, up: Vector) -> Array:
    """Return points (..., 3) of the studio in the axes of the world."""
    return points if up == Z else points @ studio(up)


def half_field(lens: float, aspect: float = ASPECT) -> tuple[float, float]:
    """Return tangents of half the field of view, across and up."""
    half = SENSOR / (2 * lens)
    return half * min(1.0, aspect), half / max(1.0, aspect)


def fit(
    points: Array,
    azimuth: float,
    elevation: float,
    lens: float,
    margin: float,
    empty: Empty = (0.0, 0.0),
    aspect: float = ASPECT,
    aside: float = 0.0,
) -> tuple[Array, float]:
    """Return the closest camera position (3,) that has all ``points`` (n, 3) in the frame.

    Also returns its distance to their middle. ``empty`` are the parts of the frame's height that stay empty at its top
    and at its bottom beside the margin, ``aside`` is that of its width at its right. Each side of the frame is a plane
    through the camera: |u - cu| <= t (w - cw) for a point at (u, v, w) in camera axes. The tightest planes of two
    opposite sides fix cu, or cv, and bound cw; the smaller cw holds both.
    """
    u, v, w = (points @ axes(azimuth, elevation).T).T
    room = 1 - 2 * margin
    tu, tv = (half * room for half in half_field(lens, aspect))
    upper, lower = (tv - 2 * _cut(part, margin, lens, aspect) for part in empty)
    right = tu - 2 * min(aside, room / 2) * half_field(lens, aspect)[0]
    cu, wu = _between(u, w, tu, right)
    cv, wv = _between(v, w, lower, upper)
    size = float(np.linalg.norm(np.ptp(points, axis=0)))
    depth = min(wu, wv, float(w.min()) - NEAREST * size)
    across, up = cu + (right - tu) / 2 * depth, cv + (upper - lower) / 2 * depth
    position = np.array([across, up, depth]) @ axes(azimuth, elevation)
    return position, float((w.min() + w.max()) / 2 - depth)


def orbit(
    points: Array,
    target: Array,
    azimuths: Array,
    elevation: float,
    lens: float,
    margin: float,
    empty: Empty = (0.0, 0.0),
    aspect: float = ASPECT,
) -> float:
    """Return the smallest distance to ``target`` that keeps all points in the frame of a turning camera.

    ``empty`` are the parts of the frame's height that stay empty at its top and at its bottom beside the margin; the
    camera is to stand :func:`lifted` for them.
    """
    room = 1 - 2 * margin
    tu, tv = (half * room for half in half_field(lens, aspect))
    above, below = (_cut(part, margin, lens, aspect) for part in empty)
    left = tv - above - below
    distance = 0.0
    for azimuth in azimuths:
        u, v, w = ((points - target) @ axes(azimuth, elevation).T).T
        needed = np.maximum(np.abs(u) / tu - w, (-v - (tv - 2 * below) * w) / left)
        needed = np.maximum(needed, (v - (tv - 2 * above) * w) / left)
        distance = max(distance, float(needed.max()))
    return distance


def lifted(lens: float, margin: float, empty: Empty, aspect: float = ASPECT) -> float:
    """Return how far a camera stands higher, across its sight, for parts that stay empty.

    It counts in distances to its target.
    """
    above, below = (_cut(part, margin, lens, aspect) for part in empty)
    return above - below


def _cut(part: float, margin: float, lens: float, aspect: float) -> float:
    """Return the tangent of half of what a part of the frame's height takes.

    A third of what the margins leave is never taken.
    """
    return min(part, (1 - 2 * margin) / 3) * half_field(lens, aspect)[1]


def depth_of_field(near: float, far: float, lens: float, blur: float) -> tuple[float, float]:
    """Return focus distance (m) and f-stop that blur ``near`` and ``far`` (m) alike, by ``blur`` pixels.

    The frame is 1280 pixels wide. Thin lens: a point at d is a disc of diameter F^2 |d - s| / (N d (s - F)) when
    focused at s.
    """
    focus = 2 * near * far / (near + far)
    if blur <= 0 or far - near < 1e-9:
        return focus, 0.0
    length = lens / 1000
    disc = blur * SENSOR / REFERENCE_WIDTH / 1000
    return focus, length**2 * (focus - near) / (near * (focus - length) * disc)


def project(camera: CameraPose, points: Array, width: float, height: float) -> Array:
    """Return the pixel coordinates (n, 2), right and down, of world points (n, 3)."""
    u, v, w = (
        (np.atleast_2d(points) - np.array(camera.position)) @ axes(camera.azimuth, camera.elevation, camera.up).T
    ).T
    scale = max(width, height) * camera.lens / SENSOR
    return np.stack([width / 2 + scale * u / w, height / 2 - scale * v / w], axis=1)


def _between(across: Array, depth: Array, below: float, above: float) -> tuple[float, float]:
    """Return the camera's place across and its limit forward to hold both sides, at these tangents.

    The former is for a camera at no depth.
    """
    low, high = float((across + below * depth).min()), float((across - above * depth).max())
    return (low + high) / 2, (low - high) / (below + above)
