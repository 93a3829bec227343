"""The block of an engine on its mounts: what shakes is then a motion, with modes and resonances.

    k = m (2 pi f)^2 / n,   c = 2 zeta m (2 pi f) / n        of each of n mounts; f: natural frequency of the mass

A mount is a bushing: springs and dampers along x and y. Source: Rao, Mechanical Vibrations, ch. 2.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from mbsd.base.arguments import not_negative_number, number_pair, positive_number
from mbsd.base.errors import ModelError
from mbsd.base.names import shown


@dataclass(frozen=True)
class Mount:
    """A place on the block (m) and its springs and dampers along x and y (N/m, N s/m)."""

    at: tuple[float, float]
    stiffness: tuple[float, float]
    damping: tuple[float, float] = (0.0, 0.0)

    def __post_init__(self) -> None:
        number_pair("engine: at of a mount (m)", self.at)
        for what, unit in (("stiffness", "N/m"), ("damping", "N s/m")):
            for value in number_pair(f"engine: {what} of a mount", getattr(self, what)):
                not_negative_number(f"engine: {what} of the mount at {self.at}", value, unit)


@dataclass(frozen=True)
class Block:
    """Mass (kg), inertia about its centre of mass (kg m^2) and mounts of what the shaft turns in.

    ``com``: place of its centre of mass against the shaft's axis (m). ``motor_on``: where stands what drives the shaft:
    "block", as a starter does, so that gas and load act within the engine; or "ground", as the drive line of a heavy
    load does, so that the torque of gas and inertia rocks the block.
    """

    mass: float
    inertia: float
    mounts: tuple[Mount, ...]
    com: tuple[float, float] = (0.0, 0.0)
    motor_on: str = "block"

    def __post_init__(self) -> None:
        for what, unit in (("mass", "kg"), ("inertia", "kg m^2")):
            positive_number(f"engine: {what} of the block", getattr(self, what), unit)
        number_pair("engine: com of the block (m)", self.com)
        if self.motor_on not in ("block", "ground"):
            raise ModelError(f"engine: motor_on of the block is {shown(self.motor_on)}; it is 'block' or 'ground'")
        if not self.mounts or not all(isinstance(mount, Mount) for mount in self.mounts):
            raise ModelError("engine: a block needs a list of Mount(...), or it falls")


def mounts_of_frequency(
    mass: float, frequency: float, at: Sequence[tuple[float, float]], damping_ratio: float = 0.1
) -> tuple[Mount, ...]:
    """Equal mounts at the places ``at`` (m) on which a mass (kg) has a natural frequency (Hz) along x and y.

    Raises ModelError for numbers that are not positive.
    """
    positive_number("engine: mass of the mounts", mass, "kg")
    positive_number("engine: frequency of the mounts", frequency, "Hz")
    not_negative_number("engine: damping_ratio of the mounts", damping_ratio)
    if not at:
        raise ModelError("engine: mounts need at least one place")
    omega = 2 * math.pi * frequency
    stiffness, damping = mass * omega**2 / len(at), 2 * damping_ratio * mass * omega / len(at)
    return tuple(Mount(place, (stiffness, stiffness), (damping, damping)) for place in at)
