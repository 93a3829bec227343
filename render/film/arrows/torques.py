"""What curved arrows stand for: torques of joints, drivers, springs and loads over the motion, each where it acts."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from render.film.arrows.vectors import TOUCHING, Acting, Vector
from render.film.markers import moved
from shared.contract import DriverMotion, Motion
from shared.contract.shot import Quantity

Array = NDArray[np.float64]
UNIT = "N m"
NOTHING = 1e-9
"""Torques below this part of the largest force at the length of the mechanism are rounding."""


@dataclass(frozen=True)
class Torque(Acting):
    """One torque."""

    value: Array
    """(T,) N m, positive counter-clockwise."""

    @property
    def size(self) -> Array:
        """(T,)"""
        return np.abs(self.value)

    @property
    def unit(self) -> str:
        """Of its value."""
        return UNIT


def torques(motion: Motion, show: Sequence[Quantity]) -> list[Torque]:
    """All that ``show`` asks for, in the order of the file; those that are nothing all the time are among them.

    A torque between two bodies is there once: as the second one feels it, or the first where the second is ground.
    """
    made = {"forces": _applied, "reactions": _reactions}
    return [torque for quantity in show if quantity in made for torque in made[quantity](motion, quantity)]


def rounding(vectors: Sequence[Vector], size: float) -> float:
    """Torques up to this (N m) are rounding beside these forces in a mechanism that is ``size`` (m) large."""
    forces = [float(vector.size.max()) for vector in vectors if vector.unit == "N"]
    return NOTHING * max(forces, default=0.0) * size


def _reactions(motion: Motion, quantity: Quantity) -> Iterator[Torque]:
    """Of joints and contacts. Where they touch beside the marker, the force alone has the torque, if there is one."""
    for name, one in (*motion.joints.items(), *motion.contacts.items()):
        torque = np.asarray(one.torque, float)
        if one.kind in TOUCHING or name in motion.contacts:
            torque = np.where((np.asarray(one.fx) == 0) & (np.asarray(one.fy) == 0), torque, 0.0)
        sign = 1.0 if one.bodies[1] != "ground" else -1.0
        yield Torque(quantity, name, one.bodies, _two(one.x, one.y), sign * torque)


def _applied(motion: Motion, quantity: Quantity) -> Iterator[Torque]:
    """Of forces and of drivers of angles."""
    for name, force in motion.forces.items():
        actions = [action for action in force.actions if action.body != "ground"]
        for action in actions if force.several else actions[-1:]:
            bodies = (action.body,) if force.several else tuple(one.body for one in force.actions)
            value = np.asarray(action.torque, float)
            yield Torque(quantity, f"{name} on {action.body}", bodies, _two(action.x, action.y), value)
    for name, driver in motion.drivers.items():
        if driver.kind in ("angle", "relative_angle") and driver.bodies is not None:
            first, second = driver.bodies
            sign, on = (1.0, second) if second != "ground" else (-1.0, first)
            value = sign * np.asarray(driver.effort, float)
            yield Torque(quantity, f"{name} on {on}", driver.bodies, _pivot(motion, driver), value)


def _pivot(motion: Motion, driver: DriverMotion) -> Array:
    """(T, 2) where a driver of an angle turns its bodies against each other: their pin, else its own marker."""
    assert driver.bodies is not None
    for joint in motion.joints.values():
        if joint.kind == "revolute" and set(joint.bodies) == set(driver.bodies):
            return _two(joint.x, joint.y)
    body, marker = driver.bodies[1], (0.0, 0.0, 0.0)
    if driver.shape is not None:
        body, marker = driver.shape.bodies[1], driver.shape.markers[1]
    return moved(motion, body, marker)[0]


def _two(x: Sequence[float], y: Sequence[float]) -> Array:
    return np.stack([np.asarray(x, float), np.asarray(y, float)], axis=1)
