"""Motion of frames from that of centres of mass; turns and slides of joints.

p = r + s,  p' = r' + w x s,  p'' = r'' + w' x s + w x (w x s)
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np

from mbsd.spatial.model.body import Body, Marker
from mbsd.spatial.model.rotation import euler_parameters, product, rotation_matrix
from mbsd.spatial.results.views import FrameView


class BodyMotion(NamedTuple):
    """Motion of a body's centre of mass and principal axes; of ground it is at rest."""

    r: np.ndarray
    """(T, 3) m"""
    e: np.ndarray
    """(T, 4)"""
    v: np.ndarray
    """(T, 3) m/s"""
    w: np.ndarray
    """(T, 3) rad/s, in the world."""
    a: np.ndarray
    """(T, 3) m/s^2"""
    alpha: np.ndarray
    """(T, 3) rad/s^2, in the world."""


def body_motion(b: int, q: np.ndarray, v: np.ndarray, a: np.ndarray) -> BodyMotion:
    """Return the motion of body b from q (T, ..., 3 + 7 n), v and a (T, ..., 3 + 6 n)."""
    if b == 0:
        rest = np.zeros((*q.shape[:-1], 3))
        turned = np.broadcast_to([1.0, 0.0, 0.0, 0.0], (*q.shape[:-1], 4))
        return BodyMotion(rest, turned, rest, rest, rest, rest)
    c, d = 7 * b - 4, 6 * b - 3
    first, second = (slice(at, at + 3) for at in (d, d + 3))
    return BodyMotion(
        q[..., c : c + 3], q[..., c + 3 : c + 7], v[..., first], v[..., second], a[..., first], a[..., second]
    )


def moved_frame(body: Body, motion: BodyMotion, place: np.ndarray, axes: np.ndarray) -> FrameView:
    """Return the motion of a frame of a body, at ``place`` (3,) with ``axes`` (3, 3) in the body's frame."""
    own = body.principal[1].T
    arm = rotation_matrix(motion.e) @ (own @ (place - np.array(body.com)))
    swung = np.cross(motion.w, arm)
    return FrameView(
        place=motion.r + arm,
        orientation=product(motion.e, np.broadcast_to(euler_parameters(own @ axes), motion.e.shape)),
        velocity=motion.v + swung,
        w=motion.w,
        acceleration=motion.a + np.cross(motion.alpha, arm) + np.cross(motion.w, swung),
        alpha=motion.alpha,
    )


def marker_frame(marker: Marker, motion: BodyMotion) -> FrameView:
    """Return the motion of a marker."""
    return moved_frame(marker.body, motion, np.array(marker.place), marker.axes)


def turns_between(
    i: FrameView, j: FrameView, times: np.ndarray, begin: Any
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return turn (rad), rate and acceleration (T, ...) of frame j against i, whose z axes agree.

    Whole turns are counted from step to step, by the rates at both ends; the first is nearest to ``begin`` (rad).
    """
    x, y, axis = (i.rotation[..., k] for k in range(3))
    b = j.rotation[..., 0]
    raw = np.arctan2((y * b).sum(axis=-1), (x * b).sum(axis=-1))
    rate = (axis * (j.w - i.w)).sum(axis=-1)
    bend = (axis * (j.alpha - i.alpha)).sum(axis=-1) + (np.cross(i.w, axis) * (j.w - i.w)).sum(axis=-1)
    led = 0.5 * (np.diff(times) * (rate[1:] + rate[:-1]).T).T
    whole = np.round((raw[:-1] + led - raw[1:]) / (2 * math.pi))
    first = np.round((begin - raw[:1]) / (2 * math.pi))
    return raw + 2 * math.pi * np.cumsum(np.concatenate([first, whole]), axis=0), rate, bend


def slides_between(i: FrameView, j: FrameView) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return how far (m) frame j lies along the z axis of frame i, its rate and acceleration (T, ...)."""
    axis, d = i.rotation[..., 2], j.place - i.place
    rate, speed = np.cross(i.w, axis), j.velocity - i.velocity
    bend = np.cross(i.alpha, axis) + np.cross(i.w, rate)
    value = (axis * d).sum(axis=-1)
    first = (rate * d + axis * speed).sum(axis=-1)
    second = (bend * d + 2 * rate * speed + axis * (j.acceleration - i.acceleration)).sum(axis=-1)
    return value, first, second
