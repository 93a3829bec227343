"""Where the force of a joint, driver or contact acts, and with which torque it acts there.

A joint acts at its second marker, unless its bodies touch beside it (``JointKind.touching``):

    line     at the foot of the second marker on the x axis of the first, ``radius`` away, whatever the friction
    curve    on the rim of the disc about the second marker, from where the force has the torque that it has
    discs    where the rims of both discs are nearest
    place    on the line on which the force has no torque about the second marker

A driver acts on its bodies: of a distance at both markers, of an angle at the pin of its bodies where they share one.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from mbsd.arrays.reactions import marker_axes, marker_places
from mbsd.results.force_view import Action
from mbsd.results.views import Wrench

if TYPE_CHECKING:
    from mbsd.arrays.packing import Packed
    from mbsd.model.joint import Joint

ROUNDING = 1e-9
"""Fraction of the torque about the second marker: less counts as nothing."""


def acting(packed: Packed, q: np.ndarray, wrench: np.ndarray, k: int) -> Wrench:
    """Return the wrench of joint, driver or contact number ``k`` on its second body, where it acts.

    q (T, nb, 3) poses, wrench (T, joints, 3) as a solution has them: N and N m about the second marker.
    """
    joint, (i, j) = packed.joints[k], (int(marker) for marker in packed.markers[k])
    flat = np.ascontiguousarray(q.reshape(len(q), -1))
    force, torque, second = wrench[:, k, :2], wrench[:, k, 2], marker_places(packed, flat, j)
    if joint.kind.driven and joint.kind.angular:
        place = _pin_of(packed, flat, joint, second)
        return Wrench(place[:, 0], place[:, 1], force[:, 0], force[:, 1], torque)
    if not joint.kind.touching:
        return Wrench(second[:, 0], second[:, 1], force[:, 0], force[:, 1], torque)
    arm = _touch(joint, marker_places(packed, flat, i), marker_axes(packed, flat, i), second, force, torque)
    moved = arm[:, 0] * force[:, 1] - arm[:, 1] * force[:, 0]
    left = torque - moved
    left = np.where(np.abs(left) > ROUNDING * (np.abs(torque) + np.abs(moved)), left, 0.0)
    place = second + arm
    return Wrench(place[:, 0], place[:, 1], force[:, 0], force[:, 1], left)


def actions(packed: Packed, q: np.ndarray, wrench: np.ndarray, k: int) -> list[Action]:
    """Return the wrenches of joint, driver or contact number ``k`` on its first and its second body."""
    joint, on = packed.joints[k], acting(packed, q, wrench, k)
    first = np.stack([on.x, on.y], axis=1)
    if "distance" in joint.kind.constraints:  # along the line between the markers, so at either
        first = marker_places(packed, np.ascontiguousarray(q.reshape(len(q), -1)), int(packed.markers[k][0]))
    a, b = joint.bodies
    return [
        Action(first[:, 0], first[:, 1], -on.fx, -on.fy, -on.torque, a),
        Action(on.x, on.y, on.fx, on.fy, on.torque, b),
    ]


def felt(packed: Packed, q: np.ndarray, wrench: np.ndarray, k: int) -> Action:
    """Return the wrench of joint, driver or contact ``k`` on its moving body.

    It is the second body, or the first if the second is ground.
    """
    on, (first, second) = acting(packed, q, wrench, k), packed.joints[k].bodies
    body, sign = (first, -1.0) if second == "ground" else (second, 1.0)
    return Action(on.x, on.y, sign * on.fx, sign * on.fy, sign * on.torque, body)


def _pin_of(packed: Packed, q: np.ndarray, driver: Joint, otherwise: np.ndarray) -> np.ndarray:
    """(T, 2) of the pin that the bodies of a driver share."""
    for joint, (_, j) in zip(packed.joints, packed.markers, strict=False):
        if joint.kind.pair == "pin" and set(joint.bodies) == set(driver.bodies):
            return marker_places(packed, q, int(j))
    return otherwise


def _touch(
    joint: Joint, first: np.ndarray, axis: np.ndarray, second: np.ndarray, force: np.ndarray, torque: np.ndarray
) -> np.ndarray:
    """Return (T, 2) vectors from the second marker to the touching point.

    ``first`` and ``axis`` (T, 2) are of the first one.
    """
    radius = joint.params.get("radius", 0.0)
    if joint.kind.touching == "line":
        return -radius * np.stack([-axis[:, 1], axis[:, 0]], axis=1)
    if joint.kind.touching == "curve":
        return _toward(force, torque, radius) if force.any() else np.zeros_like(second)
    if joint.kind.touching == "discs":
        gap = first - second
        length = np.hypot(*gap.T)[:, None]
        side = -joint.params["radius_j"] if joint.params["inside"] else joint.params["radius_j"]
        return side * np.divide(gap, length, out=np.zeros_like(gap), where=length > 0)
    square = (force**2).sum(axis=1)
    off = np.divide(torque, square, out=np.zeros(len(torque)), where=square > 0)
    return off[:, None] * np.stack([force[:, 1], -force[:, 0]], axis=1)


def _toward(force: np.ndarray, torque: np.ndarray, radius: float) -> np.ndarray:
    """Return (T, 2) from a disc's centre to the rim point that this force and torque push.

    It is against the normal force.
    """
    size = np.hypot(*force.T)
    lever = np.divide(torque, size, out=np.zeros(len(torque)), where=size > 0)
    lean = np.arcsin(np.clip(lever / radius, -1.0, 1.0)) if radius > 0 else np.zeros(len(torque))
    angle = np.arctan2(force[:, 1], force[:, 0]) + math.pi + lean
    return radius * np.stack([np.cos(angle), np.sin(angle)], axis=1)
