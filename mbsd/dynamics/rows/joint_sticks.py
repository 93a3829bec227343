"""Joints that stick and slide by events: the row of J that holds one while it sticks, and what it does now.

    slides   s' != 0     friction of joint_friction.py with the sign of s', which stays until s' = 0
    sticks   s' = 0      s = const is a row of J;  |T| <= mu_s (N + N_0), of a pin |T| <= mu_s r (N + N_0)

s: angle of marker j against marker i of a pin (rad), place of marker j along the x axis of marker i (m).
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from mbsd.arrays.packing import Packed
from mbsd.equations.joint_friction import BY_RATE, FIRST, NONE, SENSE, WAY
from mbsd.equations.loads import Loads
from mbsd.model.joint import Joint, JointKind


def _example(m: Any, i: Any, j: Any) -> None:
    m.revolute("pin", i, j)
    m.friction("example", "pin", 0.3, radius=0.2, sticks=True)


STUCK_ANGLE = JointKind("stuck_angle", ("turn",), example=_example, numbers=lambda params: ((0.0, 0.0, 1.0, 0.0),))
STUCK_PLACE = JointKind("stuck_place", ("linear",), example=_example, numbers=lambda params: ((1.0, 0.0, 0.0, 0.0),))


def stuck_rows(packed: Packed) -> list[Joint]:
    """What holds the joints with such friction while they stick, by the names of the frictions."""
    pins = {joint.name for joint in packed.joints if joint.kind.pair == "pin"}
    return [
        Joint(STUCK_ANGLE if force.params["joint"] in pins else STUCK_PLACE, force.name, force.i, force.j, {})
        for force in packed.forces
        if force.kind.of_reactions and force.params["sticks"]
    ]


@dataclass(frozen=True, eq=False)
class JointStick:
    """One joint of a run that may stick."""

    name: str
    """The name of its friction."""
    way: int
    """The row of s in J."""
    at: int
    """Its row in Loads.friction."""


def joint_sticks(packed: Packed, loads: Loads) -> list[JointStick]:
    """Return those of a packed mechanism with the rows of ``stuck_rows``."""
    name_of = {int(packed.first_row[k]): joint.name for k, joint in enumerate(packed.joints)}
    return [JointStick(name_of[way], way, at) for at, way in enumerate(loads.friction[:, WAY].tolist()) if way >= 0]


def standing(loads: Loads, held: np.ndarray) -> Iterator[tuple[Loads, np.ndarray]]:
    """Loads with the friction that a known motion with rows ``held`` (T, m) has, and the times (t,) where they act.

    What multipliers hold, and friction of joints that an action released, is no part of it.
    """
    if not len(loads.friction):
        return
    patterns, which = np.unique(held[:, loads.friction[:, FIRST]], axis=0, return_inverse=True)
    for k, there in enumerate(patterns):
        number = loads.friction_number.copy()
        number[:, SENSE] = np.where((loads.friction[:, WAY] < 0) & there, BY_RATE, NONE)
        yield loads._replace(friction_number=number), np.flatnonzero(which.ravel() == k)
