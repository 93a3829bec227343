"""What curved arrows stand for: torques of joints, drivers, springs and loads over the motion, each where it acts."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from render.film.arrows.vectors import Acting, Vector
from shared.contract import Motion
from shared.contract.felt import felt
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
        """Unit of its value."""
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
    """Torques of joints and contacts, about where they act."""
    for name, joint in (*motion.joints.items(), *motion.contacts.items()):
        on = felt(joint)
        yield Torque(quantity, name, joint.bodies, on.place, on.torque)


def _applied(motion: Motion, quantity: Quantity) -> Iterator[Torque]:
    """Torques of forces and drivers."""
    for name, load in (*motion.forces.items(), *motion.drivers.items()):
        several = getattr(load, "several", False)
        moving = [action for action in load.actions if action.body != "ground"]
        for action in moving if several else moving[-1:]:
            bodies = (action.body,) if several else tuple(other.body for other in load.actions)
            value = np.asarray(action.torque, float)
            yield Torque(quantity, f"{name} on {action.body}", bodies, _two(action.x, action.y), value)


def _two(x: Sequence[float], y: Sequence[float]) -> Array:
    return np.stack([np.asarray(x, float), np.asarray(y, float)], axis=1)
