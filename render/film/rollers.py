"""Chains: rollers, and the flanks of their sprockets."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from render.film.poses import Moment, Poses, moved, planar_pose
from render.film.scene import Pose
from render.film.vectors import at_time
from shared.contract import ContactMotion, JointMotion, Motion, Parts, Rolling, Shape

# Where a roller touches what it rolls on, as the reactions tell: the direction from its centre, and when it touches.
#
# roller, contacts        the nearest point of the outline; of a contact while it is closed captive, in a slot
# across the slot, to the wall from which the reaction on the pin comes captive, on a curve     across the curve, to the
# side from which the reaction comes captive, of a wheel     across the slot that the pin is in, to the flank that it
# pushes; none while the wheel is locked
#
# Without a reaction that is more than rounding the last flank counts that had one, and before the first nothing is
# touched.

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]
ROUNDING = 1e-9
"""Fraction of the largest reaction: smaller ones do not say which flank touches."""


@dataclass(frozen=True)
class Flank:
    """Over the times of data.json."""

    normal: Array
    """(T, 2) unit vectors from the roller's centre to where it touches."""
    touches: Mask
    """(T,); elsewhere there is nothing to roll on."""
    free: Mask
    """(T,) whether it has left what it rolled on, with nothing to brake it."""


def flank_of(motion: Motion, name: str, centre: Array) -> Flank | None:
    """Return the flank of a roller with its middle at ``centre`` (T, 2); None if nothing rolls in it.

    It rolls in a joint or contact.
    """
    joint, contact = motion.joints.get(name), motion.contacts.get(name)
    if joint is not None and joint.shape is not None:
        shape = joint.shape
        if joint.look == "roller":
            return _always(_nearest(motion, shape, centre)[0])
        if joint.look == "captive" and shape.slots is not None:
            return _in_wheel(motion, joint, shape)
        if joint.look == "captive" and shape.outline:
            along = _nearest(motion, shape, centre)[1]
            return _pushed(np.stack([-along[:, 1], along[:, 0]], axis=1), joint, -1.0)
        if joint.look == "captive":
            return _pushed(_across(moved(motion, shape.bodies[0], shape.markers[0])[1]), joint, -1.0)
    if contact is not None and contact.shape.outline:
        return _leaving(_nearest(motion, contact.shape, centre)[0], contact)
    return None


def _always(normal: Array) -> Flank:
    every = np.ones(len(normal), bool)
    return Flank(normal, every, ~every)


def _leaving(normal: Array, contact: ContactMotion) -> Flank:
    """Return the flank of a contact that opens.

    Before the first time it is closed the roller does not turn, later it is free.
    """
    closed = np.array([state != "open" for state in contact.state])
    return Flank(normal, closed, ~closed & (np.cumsum(closed) > 0))


def _pushed(across: Array, joint: JointMotion, sense: float, there: Mask | None = None) -> Flank:
    """Return the flank that the reaction on the second body chooses, times ``sense``.

    It is left or right in a slot, while a pin is ``there``.
    """
    fx, fy = np.asarray(joint.fx), np.asarray(joint.fy)
    force = np.where(True if there is None else there, sense * (fx * across[:, 0] + fy * across[:, 1]), 0.0)
    side = np.sign(np.where(np.abs(force) > ROUNDING * np.hypot(fx, fy).max(initial=0.0), force, 0.0))
    last = np.maximum.accumulate(np.where(side != 0, np.arange(len(side)), -1))
    side = np.where(last >= 0, side[np.maximum(last, 0)], 0.0)
    touches = side != 0
    return Flank(side[:, None] * across, touches if there is None else touches & there, np.zeros(len(side), bool))


def _in_wheel(motion: Motion, joint: JointMotion, shape: Shape) -> Flank:
    """Return the crank's pin, which pushes the wheel (the second body)."""
    (crank, wheel), (first, second) = shape.bodies, shape.markers
    place, turn = moved(motion, crank, first)
    arm, middle = np.stack([np.cos(turn), np.sin(turn)], axis=1), moved(motion, wheel, second)[0]
    radius = shape.pin_radius or 0.0
    way = place + radius * arm - middle
    entered = ((middle - place) * arm).sum(axis=1) > radius  # as the joint's equation has it
    return _pushed(_across(np.arctan2(way[:, 1], way[:, 0])), joint, 1.0, entered)


def _across(angle: Array) -> Array:
    """Return (T, 2) to the left of directions (rad)."""
    return np.stack([-np.sin(angle), np.cos(angle)], axis=1)


def _nearest(motion: Motion, shape: Shape, centre: Array) -> tuple[Array, Array]:
    """Return (T, 2) from the roller's centre to the nearest point of the outline, and (T, 2) along it."""
    place, angle = moved(motion, shape.bodies[0], shape.markers[0])
    c, s = np.cos(angle), np.sin(angle)
    off = centre - place
    seen = np.stack([c * off[:, 0] + s * off[:, 1], c * off[:, 1] - s * off[:, 0]], axis=1)
    outline = np.asarray(shape.outline)
    starts, ways = outline, np.roll(outline, -1, axis=0) - outline
    if not shape.outline_closed:
        starts, ways = starts[:-1], ways[:-1]
    part = ((seen[:, None] - starts) * ways).sum(axis=2) / np.maximum((ways**2).sum(axis=1), 1e-300)
    feet = starts + np.clip(part, 0.0, 1.0)[..., None] * ways
    away = feet - seen[:, None]
    nearest = (away**2).sum(axis=2).argmin(axis=1)
    both = np.take_along_axis(away, nearest[:, None, None], axis=1)[:, 0], ways[nearest]
    normal, along = (way / np.maximum(np.linalg.norm(way, axis=1, keepdims=True), 1e-300) for way in both)
    return tuple(  # pyright: ignore[reportReturnType]
        np.stack([c * way[:, 0] - s * way[:, 1], s * way[:, 0] + c * way[:, 1]], axis=1) for way in (normal, along)
    )


# Rollers turn as they roll without slip on what they touch (render/film/rollers.py).
#
#     n     from the roller's centre C to where it touches, P = C + r n;  t = n turned by a quarter, counter-clockwise
#     r w = (v_P - v_C) . t      v_P the other body's velocity there; w the roller's angular velocity
#
# In a motion that repeats, its turning over a period is rounded to one after which it looks the same, so that films
# have no seam: by less than half a mark's angle, shared out over the way it rolls.


@dataclass(frozen=True)
class Roller:
    """A piece that turns about a point of its body (m) by angles (T,) at the times of data.json (rad)."""

    body: str
    piece: str
    at: tuple[float, float]
    turned: Array
    """Against its body."""


class Rollers:
    """Rollers of a film; one whose joint gives no rotation stands still on its body."""

    def __init__(self, poses: Poses, parts: Parts) -> None:
        self._poses = poses
        self.found = [
            Roller(body, name, (piece.rolls.x, piece.rolls.y), turned(poses.motion, body, piece.rolls))
            for body, solids in parts.bodies.items()
            for name, piece in solids.pieces.items()
            if piece.rolls is not None
        ]

    def poses(self, at: Moment) -> dict[str, Pose]:
        """Return the pose of each, at its axis, by ``body/piece``."""
        out = {}
        for roller in self.found:
            x, y, theta = self._poses.body(roller.body, Moment(at.time, 0))
            (u, v), c, s = roller.at, math.cos(theta), math.sin(theta)
            angle = theta + float(at_time(self._poses.time, roller.turned[:, None], at.time)[0])
            out[f"{roller.body}/{roller.piece}"] = planar_pose(x + c * u - s * v, y + s * u + c * v, angle)
        return out


def turned(motion: Motion, body: str, rolls: Rolling) -> Array:
    """Return (T,) angle (rad) by which a roller has turned against its body since the start.

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
    """Return (T, 2) of the material of a body at places (T, 2) of the world."""
    if body not in motion.bodies:
        return np.zeros_like(places)
    frame = motion.bodies[body]
    arm = places - np.stack([np.asarray(frame.x), np.asarray(frame.y)], axis=1)
    across = np.stack([-arm[:, 1], arm[:, 0]], axis=1)
    return np.stack([np.asarray(frame.vx), np.asarray(frame.vy)], axis=1) + _omega(motion, body)[:, None] * across


def _omega(motion: Motion, body: str) -> Array:
    return np.asarray(motion.bodies[body].omega) if body in motion.bodies else np.zeros(len(motion.time))
