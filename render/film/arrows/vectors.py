"""What straight arrows stand for: forces, reactions, velocities, accelerations over the motion, each where it acts."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from render.film.markers import moved
from shared.contract import BodyMotion, DriverMotion, Motion
from shared.contract.shot import Quantity

Array = NDArray[np.float64]
UNITS = {"velocities": "m/s", "accelerations": "m/s²", "forces": "N", "reactions": "N"}
TOUCHING = {
    *("rolling_disc", "rolling_on_curve", "rack_and_pinion", "gear_pair"),
    *("cam_flat", "geneva", "point_on_curve", "constraint"),
}
"""Joints whose force acts beside the second marker: on the line where it has no torque."""


@dataclass(frozen=True)
class Acting:
    """What acts over the times of data.json, at a place."""

    quantity: Quantity
    name: str
    bodies: tuple[str, ...]
    """Between which, or on which it acts."""
    place: Array
    """(T, 2) where an arrow begins, about which an arc is drawn (m)."""


@dataclass(frozen=True)
class Vector(Acting):
    """One vector, world axes."""

    value: Array
    """(T, 2) in the unit of its quantity."""
    weight: bool = False
    """Whether it is the weight of a body, one of the forces."""

    @property
    def size(self) -> Array:
        """(T,)"""
        return np.hypot(*self.value.T)

    @property
    def unit(self) -> str:
        """Of its value."""
        return UNITS[self.quantity]

    @property
    def row(self) -> str:
        """What the legend calls it: weights have a row and a colour of their own."""
        return "weights" if self.weight else self.quantity


def vectors(motion: Motion, show: Sequence[Quantity]) -> list[Vector]:
    """All that ``show`` asks for, in the order of the file; vectors that are nothing all the time are among them."""
    made = {"velocities": _movements, "accelerations": _movements, "forces": _forces, "reactions": _reactions}
    return [vector for quantity in show for vector in made[quantity](motion, quantity)]


def at_time(time: Array, values: Array, t: float) -> Array:
    """Rows of ``values`` (T, n) at ``t``, linear between rows; of rows that share a time the later counts."""
    t = min(max(t, float(time[0])), float(time[-1]))
    starts = np.flatnonzero(np.diff(time) > 0)
    i = starts[max(int(np.searchsorted(time[starts], t, side="right")) - 1, 0)]
    part = (t - time[i]) / (time[i + 1] - time[i])
    return (1 - part) * values[i] + part * values[i + 1]


def _reactions(motion: Motion, quantity: Quantity) -> Iterator[Vector]:
    """What joints and rigid contacts do to their second body; to the first one where the second is ground."""
    for name, one in (*motion.joints.items(), *motion.contacts.items()):
        place, force = _two(one.x, one.y), _two(one.fx, one.fy)
        if one.kind in TOUCHING or name in motion.contacts:
            place = place + _beside(force, np.asarray(one.torque))
        on = one.bodies[1] if one.bodies[1] != "ground" else one.bodies[0]
        yield Vector(quantity, name, one.bodies, place, force if on == one.bodies[1] else -force)


def _forces(motion: Motion, quantity: Quantity) -> Iterator[Vector]:
    """On each moving body that feels them, of drivers of a length too, and the weights."""
    for name, force in motion.forces.items():
        for action in force.actions:
            if action.body != "ground":
                place, value = _two(action.x, action.y), _two(action.fx, action.fy)
                yield Vector(quantity, f"{name} on {action.body}", (action.body,), place, value)
    for name, driver in motion.drivers.items():
        for body, place, value in _pushes(motion, driver):
            if body != "ground":
                yield Vector(quantity, f"{name} on {body}", (body,), place, value)
    gravity = np.array(motion.gravity)
    for name, body in motion.bodies.items():
        if body.mass > 0 and gravity.any():
            place = _centre(body)[0]
            value = np.tile(body.mass * gravity, (len(place), 1))
            yield Vector(quantity, f"weight of {name}", (name,), place, value, weight=True)


def _pushes(motion: Motion, driver: DriverMotion) -> Iterator[tuple[str, Array, Array]]:
    """What a driver of a distance or coordinate does to its two bodies: each, where (T, 2), and the force (T, 2)."""
    shape = driver.shape
    if shape is None or driver.kind not in ("distance", "coordinate"):
        return
    (first, angle), (second, _) = (moved(motion, b, m) for b, m in zip(shape.bodies, shape.markers, strict=True))
    if driver.kind == "distance":  # along the line between the two, on each at its end
        way = second - first
        length = np.hypot(*way.T)[:, None]
        way = np.divide(way, length, out=np.zeros_like(way), where=length > 0)
    else:  # along the first marker's axis, on both where the second is
        way, first = np.stack([np.cos(angle), np.sin(angle)], axis=1), second
    force = np.asarray(driver.effort)[:, None] * way
    yield shape.bodies[0], first, -force
    yield shape.bodies[1], second, force


def _movements(motion: Motion, quantity: Quantity) -> Iterator[Vector]:
    """Of traced points, and of the centres of mass of bodies that have none."""
    fast = quantity == "velocities"
    for name, point in motion.points.items():
        value = _two(point.vx, point.vy) if fast else _two(point.ax, point.ay)
        yield Vector(quantity, f"{quantity} of {name}", (point.body,), _two(point.x, point.y), value)
    traced = {point.body for point in motion.points.values()}
    for name, body in motion.bodies.items():
        if name not in traced:
            place, velocity, acceleration = _centre(body)
            yield Vector(quantity, f"{quantity} of {name}", (name,), place, velocity if fast else acceleration)


def _centre(body: BodyMotion) -> tuple[Array, Array, Array]:
    """Place, velocity and acceleration (T, 2) of a body's centre of mass."""
    theta, omega, alpha = (np.asarray(s)[:, None] for s in (body.theta, body.omega, body.alpha))
    x, y = body.com
    arm = np.hstack([np.cos(theta) * x - np.sin(theta) * y, np.sin(theta) * x + np.cos(theta) * y])
    across = np.stack([-arm[:, 1], arm[:, 0]], axis=1)
    return (
        _two(body.x, body.y) + arm,
        _two(body.vx, body.vy) + omega * across,
        _two(body.ax, body.ay) + alpha * across - omega**2 * arm,
    )


def _beside(force: Array, torque: Array) -> Array:
    """(T, 2) from the second marker to the line on which the force has no torque."""
    square = (force**2).sum(axis=1)
    off = np.divide(torque, square, out=np.zeros(len(torque)), where=square > 0)
    return off[:, None] * np.stack([force[:, 1], -force[:, 0]], axis=1)


def _two(x: Sequence[float], y: Sequence[float]) -> Array:
    return np.stack([np.asarray(x, float), np.asarray(y, float)], axis=1)
