"""Frames what moves: the distance of the camera, and where a point of the world is in the picture.

World axes: x right, y away, z up (the motion lies in x, y). Azimuth 0 looks along +y; positive azimuth walks the
camera to the right. The picture is 16:9; pixel (0, 0) is the upper left corner of the upper left pixel.
"""

from __future__ import annotations

import math

import msgspec
import numpy as np
from numpy.typing import NDArray

from render.presets import ASPECT

Array = NDArray[np.float64]
SENSOR = 36.0
"""Width of the sensor, mm."""
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


def axes(azimuth: float, elevation: float) -> Array:
    """Rows right, up, forward (3, 3) of a camera at these angles (rad)."""
    ca, sa, ce, se = math.cos(azimuth), math.sin(azimuth), math.cos(elevation), math.sin(elevation)
    return np.array([[ca, sa, 0.0], [-sa * se, ca * se, ce], [-sa * ce, ca * ce, -se]])


def half_width(lens: float) -> float:
    """Tangent of half the horizontal field of view."""
    return SENSOR / (2 * lens)


def fit(
    points: Array, azimuth: float, elevation: float, lens: float, margin: float, above: float = 0.0
) -> tuple[Array, float]:
    """The closest camera position (3,) that has all ``points`` (n, 3) in the frame, and its distance to their middle.

    ``above`` is the part of the frame's height that stays empty at its top beside the margin.
    Each side of the frame is a plane through the camera: |u - cu| <= t (w - cw) for a point at (u, v, w) in camera
    axes. The tightest planes of two opposite sides fix cu, or cv, and bound cw; the smaller cw holds both.
    """
    u, v, w = (points @ axes(azimuth, elevation).T).T
    room = 1 - 2 * margin
    tu = half_width(lens) * room
    tv = half_width(lens) / ASPECT * room
    upper = tv - 2 * lifted(lens, margin, above)
    cu, wu = _between(u, w, tu, tu)
    cv, wv = _between(v, w, tv, upper)
    size = float(np.linalg.norm(np.ptp(points, axis=0)))
    depth = min(wu, wv, float(w.min()) - NEAREST * size)
    position = np.array([cu, cv + (upper - tv) / 2 * depth, depth]) @ axes(azimuth, elevation)
    return position, float((w.min() + w.max()) / 2 - depth)


def orbit(
    points: Array, target: Array, azimuths: Array, elevation: float, lens: float, margin: float, above: float = 0.0
) -> float:
    """The smallest distance to ``target`` from which a camera that turns about it keeps all points in the frame.

    ``above`` is the part of the frame's height that stays empty at its top beside the margin; the camera is to stand
    :func:`lifted` for it.
    """
    room = 1 - 2 * margin
    tu, tv = half_width(lens) * room, half_width(lens) / ASPECT * room
    up = lifted(lens, margin, above)
    distance = 0.0
    for azimuth in azimuths:
        u, v, w = ((points - target) @ axes(azimuth, elevation).T).T
        needed = np.maximum(np.abs(u) / tu - w, (-v - tv * w) / (tv - up))
        needed = np.maximum(needed, (v - (tv - 2 * up) * w) / (tv - up))
        distance = max(distance, float(needed.max()))
    return distance


def lifted(lens: float, margin: float, above: float) -> float:
    """How far a camera stands higher, across its sight and in distances to its target, for an empty part ``above``; a
    quarter of what the margins leave is never taken.
    """
    return min(above, 0.375 * (1 - 2 * margin)) * half_width(lens) / ASPECT


def depth_of_field(near: float, far: float, lens: float, blur: float) -> tuple[float, float]:
    """Focus distance (m) and f-stop that blur ``near`` and ``far`` (m) alike, by ``blur`` pixels of a 1280 wide frame.

    Thin lens: a point at d is a disc of diameter F^2 |d - s| / (N d (s - F)) when focused at s.
    """
    focus = 2 * near * far / (near + far)
    if blur <= 0 or far - near < 1e-9:
        return focus, 0.0
    length = lens / 1000
    disc = blur * SENSOR / REFERENCE_WIDTH / 1000
    return focus, length**2 * (focus - near) / (near * (focus - length) * disc)


def project(camera: CameraPose, points: Array, width: int, height: int) -> Array:
    """Pixel coordinates (n, 2), right and down, of world points (n, 3)."""
    u, v, w = ((np.atleast_2d(points) - np.array(camera.position)) @ axes(camera.azimuth, camera.elevation).T).T
    scale = width / (2 * half_width(camera.lens))
    return np.stack([width / 2 + scale * u / w, height / 2 - scale * v / w], axis=1)


def _between(across: Array, depth: Array, below: float, above: float) -> tuple[float, float]:
    """Where the camera must be across, and how far forward it may go, to hold both sides, at these tangents; the former
    for a camera at no depth.
    """
    low, high = float((across + below * depth).min()), float((across - above * depth).max())
    return (low + high) / 2, (low - high) / (below + above)
