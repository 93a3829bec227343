"""Rollers turn as they roll without slip: on a cam, or on the wall of a slot from which their force comes.

    n     from the roller's centre C to where it touches, P = C + r n;  t = n turned by a quarter, counter-clockwise
    r w = (v_P - v_C) . t      v_P the other body's velocity there; w the roller's angular velocity

In a motion that repeats, its turning over a period is rounded to one after which it looks the same, so that films have
no seam: by less than half a mark's angle, evenly over the period.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from render.markers import moved
from render.poses import Moment, Poses
from render.vectors import at_time
from shared.contract import JointMotion, Motion, Parts, Rolling

Array = NDArray[np.float64]
KINDS = ("cam_roller", "pin_in_slot")


@dataclass(frozen=True)
class Roller:
    """A piece that turns about a point of its body (m) by angles (T,) at the times of data.json (rad)."""

    body: str
    piece: str
    at: tuple[float, float]
    turned: Array
    """Against its body."""


class Rollers:
    """Those of a film; what its joint does not tell stands still on its body."""

    def __init__(self, poses: Poses, parts: Parts) -> None:
        self._poses = poses
        self.found = [
            Roller(body, name, (piece.rolls.x, piece.rolls.y), turned(poses.motion, body, piece.rolls))
            for body, solids in parts.bodies.items()
            for name, piece in solids.pieces.items()
            if piece.rolls is not None
        ]

    def poses(self, at: Moment) -> dict[str, tuple[float, float, float]]:
        """x, y (m) of the axis of each and its angle (rad), by ``body/piece``."""
        out = {}
        for roller in self.found:
            x, y, theta = self._poses.body(roller.body, at)
            (u, v), c, s = roller.at, math.cos(theta), math.sin(theta)
            angle = theta + float(at_time(self._poses.time, roller.turned[:, None], at.time)[0])
            out[f"{roller.body}/{roller.piece}"] = (x + c * u - s * v, y + s * u + c * v, angle)
        return out


def turned(motion: Motion, body: str, rolls: Rolling) -> Array:
    """(T,) angle (rad) by which a roller has turned against its body since the start."""
    time = np.asarray(motion.time)
    joint = motion.joints.get(rolls.joint)
    if joint is None or joint.shape is None or joint.kind not in KINDS or body not in joint.bodies:
        return np.zeros(len(time))
    other = joint.bodies[1 - joint.bodies.index(body)]
    centre = moved(motion, body, (rolls.x, rolls.y, 0.0))[0]
    normal = _to_cam(motion, joint, centre) if joint.kind == "cam_roller" else _to_wall(motion, joint)
    gap = _velocity(motion, other, centre + rolls.radius * normal) - _velocity(motion, body, centre)
    across = np.stack([-normal[:, 1], normal[:, 0]], axis=1)
    rate = (gap * across).sum(axis=1) / rolls.radius - _omega(motion, body)
    angle = np.concatenate([[0.0], np.cumsum((rate[1:] + rate[:-1]) / 2 * np.diff(time))])
    if motion.period is not None:
        step = math.tau / rolls.marks
        angle += (step * round(angle[-1] / step) - angle[-1]) * (time - time[0]) / (time[-1] - time[0])
    return angle


def _to_cam(motion: Motion, joint: JointMotion, centre: Array) -> Array:
    """(T, 2) from the roller's centre to the nearest point of the cam's outline: unit vectors."""
    assert joint.shape is not None
    place, angle = moved(motion, joint.shape.bodies[0], joint.shape.markers[0])
    c, s = np.cos(angle), np.sin(angle)
    off = centre - place
    seen = np.stack([c * off[:, 0] + s * off[:, 1], c * off[:, 1] - s * off[:, 0]], axis=1)
    outline = np.asarray(joint.shape.outline)
    starts, ways = outline, np.roll(outline, -1, axis=0) - outline
    part = ((seen[:, None] - starts) * ways).sum(axis=2) / np.maximum((ways**2).sum(axis=1), 1e-300)
    feet = starts + np.clip(part, 0.0, 1.0)[..., None] * ways
    away = feet - seen[:, None]
    nearest = (away**2).sum(axis=2).argmin(axis=1)
    way = np.take_along_axis(away, nearest[:, None, None], axis=1)[:, 0]
    way /= np.maximum(np.linalg.norm(way, axis=1, keepdims=True), 1e-300)
    return np.stack([c * way[:, 0] - s * way[:, 1], s * way[:, 0] + c * way[:, 1]], axis=1)


def _to_wall(motion: Motion, joint: JointMotion) -> Array:
    """(T, 2) across the slot to the wall that pushes the roller; else to the last that did, else to its left."""
    assert joint.shape is not None
    angle = moved(motion, joint.shape.bodies[0], joint.shape.markers[0])[1]
    left = np.stack([-np.sin(angle), np.cos(angle)], axis=1)
    force = np.asarray(joint.fx) * left[:, 0] + np.asarray(joint.fy) * left[:, 1]  # on the second body
    side = -np.sign(np.where(np.abs(force) > 1e-9 * np.abs(force).max(initial=0.0), force, 0.0))
    last = np.maximum.accumulate(np.where(side != 0, np.arange(len(side)), 0))
    side = np.where(side[last] != 0, side[last], 1.0)
    return side[:, None] * left


def _velocity(motion: Motion, body: str, places: Array) -> Array:
    """(T, 2) of the material of a body at places (T, 2) of the world."""
    if body not in motion.bodies:
        return np.zeros_like(places)
    one = motion.bodies[body]
    arm = places - np.stack([np.asarray(one.x), np.asarray(one.y)], axis=1)
    across = np.stack([-arm[:, 1], arm[:, 0]], axis=1)
    return np.stack([np.asarray(one.vx), np.asarray(one.vy)], axis=1) + _omega(motion, body)[:, None] * across


def _omega(motion: Motion, body: str) -> Array:
    return np.asarray(motion.bodies[body].omega) if body in motion.bodies else np.zeros(len(motion.time))
