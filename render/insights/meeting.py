"""How much happens where two bodies meet: the force there times the speed at which they move on each other."""

from __future__ import annotations

import numpy as np

from render.insights.seen import Array
from render.magnitudes import length_scale
from shared.contract import JointMotion, Motion

PIN = 0.03
"""Radius of a pin in sizes of the mechanism: its bodies turn on each other."""


def meets(joint: JointMotion) -> bool:
    """Return True if something runs in a slot, on a cam, between teeth or into a Geneva wheel there."""
    shape = joint.shape
    if joint.pair == "slot" or shape is None or joint.pair is not None:
        return joint.pair == "slot"
    return bool(shape.slots or shape.outline_closed or (shape.teeth and joint.look != "band"))


def happening(motion: Motion, name: str) -> Array:
    """Return force times relative speed at a joint, (T,) W; the speed alone (m/s) where nothing is carried."""
    joint = motion.joints[name]
    x, y = place_of(joint)
    rows = [_rates(motion, body, x, y) for body in joint.bodies]
    vx, vy, omega = (second - first for first, second in zip(*rows, strict=True))
    speed = np.hypot(vx, vy) + PIN * length_scale(motion) * np.abs(omega)
    force = np.hypot(joint.fx, joint.fy)
    return speed * force if force.max() > 0 else speed


def place_of(joint: JointMotion) -> tuple[Array, Array]:
    """Return where a joint acts, (T,) x and y (m)."""
    at = joint.acts or joint
    return np.asarray(at.x), np.asarray(at.y)


def _rates(motion: Motion, body: str, x: Array, y: Array) -> tuple[Array, Array, Array]:
    """Return the velocity of the point of a body that is at (x, y), and its angular velocity."""
    own = motion.bodies.get(body)
    if own is None:
        still = np.zeros(len(motion.time))
        return still, still, still
    omega = np.asarray(own.omega)
    return np.asarray(own.vx) - omega * (y - np.asarray(own.y)), np.asarray(own.vy) + omega * (x - own.x), omega
