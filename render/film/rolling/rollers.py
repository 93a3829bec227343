"""Rollers turn as they roll without slip on what they touch (render/film/rolling/flanks.py).

    n     from the roller's centre C to where it touches, P = C + r n;  t = n turned by a quarter, counter-clockwise
    r w = (v_P - v_C) . t      v_P the other body's velocity there; w the roller's angular velocity

In a motion that repeats, its turning over a period is rounded to one after which it looks the same, so that films have
no seam: by less than half a mark's angle, shared out over the way it rolls.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from render.film.arrows.vectors import at_time
from render.film.markers import moved
from render.film.poses import Moment, Poses
from render.film.rolling.flanks import flank_of
from shared.contract import Motion, Parts, Rolling

Array = NDArray[np.float64]


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
    """(T,) angle (rad) by which a roller has turned against its body since the start.

    It stands still on its body where nothing tells what it touches; where it has left a cam it turns on as it did.
    """
    time = np.asarray(motion.time)
    joint = motion.joints.get(rolls.joint) or motion.contacts.get(rolls.joint)
    if joint is None or body not in joint.bodies:
        return np.zeros(len(time))
    centre = moved(motion, body, (rolls.x, rolls.y, 0.0))[0]
    flank = flank_of(motion, rolls.joint, centre)
    if flank is None:
        return np.zeros(len(time))
    other = joint.bodies[1 - joint.bodies.index(body)]
    gap = _velocity(motion, other, centre + rolls.radius * flank.normal) - _velocity(motion, body, centre)
    across = np.stack([-flank.normal[:, 1], flank.normal[:, 0]], axis=1)
    spin = (gap * across).sum(axis=1) / rolls.radius
    last = np.maximum.accumulate(np.where(flank.touches, np.arange(len(time)), 0))
    rate = np.where(flank.touches | flank.free, np.where(flank.free, spin[last], spin) - _omega(motion, body), 0.0)
    angle = np.concatenate([[0.0], np.cumsum((rate[1:] + rate[:-1]) / 2 * np.diff(time))])
    if motion.period is not None:
        step = math.tau / rolls.marks
        way = np.concatenate([[0.0], np.cumsum((np.abs(rate[1:]) + np.abs(rate[:-1])) / 2 * np.diff(time))])
        angle += (step * round(angle[-1] / step) - angle[-1]) * way / max(way[-1], 1e-300)
    return angle


def _velocity(motion: Motion, body: str, places: Array) -> Array:
    """(T, 2) of the material of a body at places (T, 2) of the world."""
    if body not in motion.bodies:
        return np.zeros_like(places)
    frame = motion.bodies[body]
    arm = places - np.stack([np.asarray(frame.x), np.asarray(frame.y)], axis=1)
    across = np.stack([-arm[:, 1], arm[:, 0]], axis=1)
    return np.stack([np.asarray(frame.vx), np.asarray(frame.vy)], axis=1) + _omega(motion, body)[:, None] * across


def _omega(motion: Motion, body: str) -> Array:
    return np.asarray(motion.bodies[body].omega) if body in motion.bodies else np.zeros(len(motion.time))
