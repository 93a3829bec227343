"""Rods of parts.json, which join two places of bodies: their motion follows from these bodies.

    p = second place - first place    l = |p|     u = p / l     n = u turned by a quarter, counter-clockwise
    theta = angle of p                omega = p' . n / l        alpha = (p'' . n - 2 l' omega) / l     l' = p' . u

The rod's frame is at the first place. It has no mass here: in the model it is a constraint. A rod that an event
releases stays on the body of its first place as it is then.
"""

from __future__ import annotations

import msgspec
import numpy as np

from shared.contract import BodyMotion, End, Motion, Parts
from shared.stage.errors import UserError


def with_rods(motion: Motion, parts: Parts) -> Motion:
    """Return the motion with a body for each rod of the parts.

    Raises UserError if a rod ends on no body, or on itself.
    """
    rods = {name: body.spans for name, body in parts.bodies.items() if body.spans is not None}
    if not rods:
        return motion
    made = {name: _moved(name, ends, parts.bodies[name].z, motion) for name, ends in rods.items()}
    for name in set(rods) & set(motion.joints):
        rows = motion.joints[name].rows_held(motion.time)
        if 0 < rows < len(motion.time):
            _leave(made[name], motion.bodies.get(rods[name][0].body), rows)
    return msgspec.structs.replace(motion, bodies=motion.bodies | made)


def _moved(name: str, ends: tuple[End, End], z: float, motion: Motion) -> BodyMotion:
    if name in motion.bodies:
        raise UserError(
            f"{motion.mechanism}: parts.json has a rod '{name}', and data.json a body of that name; rename the joint"
        )
    (place, rate, change), second = (_place(name, end, motion) for end in ends)
    way, way_rate, way_change = (b - a for a, b in zip((place, rate, change), second, strict=True))
    length = np.hypot(*way.T)
    joint = motion.joints.get(name)
    rows = len(length) if joint is None else joint.rows_held(motion.time)
    if length[:rows].min() < 1e-9:
        at = motion.time[int(length[:rows].argmin())]
        raise UserError(
            f"{motion.mechanism}: both ends of the rod '{name}' are on one place at t={at:.4g} s; join others"
        )
    length = np.maximum(length, 1e-9)  # after a release the ends may meet
    along = way / length[:, None]
    across = np.stack([-along[:, 1], along[:, 0]], axis=1)
    omega = (way_rate * across).sum(axis=1) / length
    alpha = ((way_change * across).sum(axis=1) - 2 * (way_rate * along).sum(axis=1) * omega) / length
    theta = np.unwrap(np.arctan2(way[:, 1], way[:, 0]))
    if motion.period is not None:  # what repeats but for whole turns does so to the last digit
        theta += (theta[0] + np.round((theta[-1] - theta[0]) / np.pi / 2) * 2 * np.pi - theta[-1]) * (
            np.arange(len(theta)) == len(theta) - 1
        )
    series = (*place.T, theta, *rate.T, omega, *change.T, alpha)
    names = ("x", "y", "theta", "vx", "vy", "omega", "ax", "ay", "alpha")
    values = {key: column.tolist() for key, column in zip(names, series, strict=True)}
    return BodyMotion(**values, z=z, mass=0.0, com=(0.0, 0.0), inertia=0.0)


def _leave(rod: BodyMotion, body: BodyMotion | None, rows: int) -> None:
    """Turn a rod with ``body``, which is ground if None, from the row after ``rows`` on."""
    at = rod.theta[rows - 1]
    count = len(rod.theta) - rows
    if body is None:
        rod.theta[rows:], rod.omega[rows:], rod.alpha[rows:] = [at] * count, [0.0] * count, [0.0] * count
        return
    rod.theta[rows:] = [at + angle - body.theta[rows - 1] for angle in body.theta[rows:]]
    rod.omega[rows:], rod.alpha[rows:] = body.omega[rows:], body.alpha[rows:]


def _place(name: str, end: End, motion: Motion) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return the place of an end, its velocity and its acceleration, (T, 2) each."""
    if end.body == "ground":
        still = np.zeros((len(motion.time), 2))
        return still + np.array([end.x, end.y]), still, still
    if end.body not in motion.bodies:
        raise UserError(
            f"{motion.mechanism}: the rod '{name}' of parts.json ends on '{end.body}', which data.json does not move; "
            f"there is: ground, {', '.join(motion.bodies)}"
        )
    body = motion.bodies[end.body]
    theta, omega, alpha = (np.asarray(column)[:, None] for column in (body.theta, body.omega, body.alpha))
    arm = np.hstack([np.cos(theta) * end.x - np.sin(theta) * end.y, np.sin(theta) * end.x + np.cos(theta) * end.y])
    side = np.stack([-arm[:, 1], arm[:, 0]], axis=1)
    place = np.column_stack([body.x, body.y]) + arm
    rate = np.column_stack([body.vx, body.vy]) + omega * side
    return place, rate, np.column_stack([body.ax, body.ay]) + alpha * side - omega**2 * arm
