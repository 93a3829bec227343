"""Joints that stick and slide by events: the row of J that holds one while it sticks, and what it does now.

    slides   s' != 0     friction of joint_friction.py with the sign of s', which stays until s' = 0
    sticks   s' = 0      s = const is a row of J;  |T| <= mu_s (N + N_0), of a pin |T| <= mu_s r (N + N_0)

s: angle of marker j against marker i of a pin (rad), place of marker j along the x axis of marker i (m).
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from mbsd.arrays.packing import Packed
from mbsd.dynamics.rows.held import RELEASED, SLIDES, Held
from mbsd.equations.joint_friction import BY_RATE, FIRST, NONE, PIN, PRELOAD, SENSE, SHAPE, SIZE, STATIC, WAY
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


@dataclass(eq=False)
class JointStick:
    """One joint of a run that may stick."""

    held: Held
    place: int
    """In ``held``."""
    name: str
    """The name of its friction."""
    way: int
    """The row of s in J."""
    at: int
    """Its row in Loads.friction."""
    loads: Loads

    @property
    def state(self) -> str:
        """SLIDES, STICKS or RELEASED."""
        return self.held.joints[self.place]

    @property
    def sign(self) -> float:
        """The direction of its sliding: 1, -1, or 0."""
        return self.held.joints_sliding[self.place]

    @property
    def number(self) -> np.ndarray:
        """Its row of Loads.friction_number."""
        return self.loads.friction_number[self.at]

    @property
    def holds(self) -> bool:
        """Whether friction can hold it: with a coefficient of zero it slides for ever, and rests by chance."""
        return bool(self.number[STATIC] > 0.0)

    def limit(self, normal: np.ndarray) -> np.ndarray:
        """Largest friction (N, N m) of the joint at rest under normal forces (..., f) of all joints (N)."""
        lever = self.number[SIZE] if self.loads.friction[self.at, SHAPE] == PIN else 1.0
        return self.number[STATIC] * lever * (normal[..., self.at] + self.number[PRELOAD])

    def set(self, state: str, sign: float) -> None:
        """Slide with this sign, stick (0), or be released for good."""
        self.held.joints[self.place], self.held.joints_sliding[self.place] = state, sign
        self.held.senses[self.at] = sign if state == SLIDES else NONE


def joint_sticks(packed: Packed, loads: Loads, held: Held) -> list[JointStick]:
    """Those of a packed mechanism with the rows of ``stuck_rows``; all slide at first."""
    name_of = {int(packed.first_row[k]): joint.name for k, joint in enumerate(packed.joints)}
    rows = [(at, int(way)) for at, way in enumerate(loads.friction[:, WAY]) if way >= 0]
    held.joints, held.joints_sliding = [SLIDES] * len(rows), [1.0] * len(rows)
    return [JointStick(held, place, name_of[way], way, at, loads) for place, (at, way) in enumerate(rows)]


def release(held: Held, loads: Loads, sticks: Sequence[JointStick], first_row: int) -> None:
    """The joint whose rows begin at ``first_row`` holds no more, and has no friction."""
    for at in np.flatnonzero(loads.friction[:, FIRST] == first_row):
        held.senses[at] = NONE
        for stick in sticks:
            if stick.at == at:
                stick.set(RELEASED, 0.0)


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
