"""Rows of J that are released and held during a run: of contacts, joints that stick, joints that actions release.

The elimination sequence is planned with all of them; a released row is -1 in its block. A joint that sticks has one of
its own:

    slides   s' != 0     friction of joint_friction.py with the sign of s', which stays until s' = 0
    sticks   s' = 0      s = const is a row of J;  |T| <= mu_s (N + N_0), of a pin |T| <= mu_s r (N + N_0)

s: angle of marker j against marker i of a pin (rad), position of marker j along the x axis of marker i (m).
"""

from __future__ import annotations

from collections.abc import Collection, Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from mbsd.arrays.packing import Packed
from mbsd.equations.joint_friction import BY_RATE, FIRST, NONE, SENSE, WAY
from mbsd.equations.loads import Loads
from mbsd.model.joint import ContactKind, Joint, JointKind


@dataclass(frozen=True, eq=False)
class RunContact:
    """A contact of a run."""

    joint: Joint
    gap: int
    """Row."""
    way: int | None
    """Row of the sliding way, if there is friction."""
    sliding: int
    """Its place among the contacts with friction; -1 without."""
    always_closed: bool
    settle: float
    """A rebound slower than this (m/s or rad/s) is none."""

    @property
    def name(self) -> str:
        """The contact's name."""
        return self.joint.name

    def given(self, argument: str) -> float:
        """Return a number of the contact, 0 where it has none."""
        return float(self.joint.params.get(argument, 0.0))

    @property
    def friction(self) -> float:
        """Coulomb's coefficient."""
        return self.given("friction")


SETTLE = 1e-4
"""Rebounds below this part of sqrt(size g), the speed gained in falling by half the size, end the bouncing."""


class Switches:
    """The rows that hold now. It is made while all of them do; then all contacts are open."""

    def __init__(self, packed: Packed, rows: np.ndarray, spare: Collection[int] = ()) -> None:
        """``rows`` (blocks, 2) of the elimination sequence, which kernels read; ``spare``: those that repeat others."""
        self.packed, self.rows = packed, rows
        self.released: set[int] = set()
        """Rows of joints that an event released for good."""
        self.place = {int(row): (k, s) for k, pair in enumerate(rows) for s, row in enumerate(pair) if row >= 0}
        self.contacts: list[RunContact] = []
        first = len(packed.joints) - packed.contacts
        friction = 0
        for k, joint in enumerate(packed.joints[first:], first):
            if not isinstance(joint.kind, ContactKind):
                continue  # the row of a joint that sticks
            row = packed.rows_of(k).start
            slow = SETTLE * float(np.sqrt(np.hypot(*packed.system.gravity) / packed.size or 1.0))
            slippery = joint.params.get("friction", 0.0) == 0.0
            self.contacts.append(
                RunContact(
                    joint,
                    row,
                    None if slippery else row + 1,
                    -1 if slippery else friction,
                    joint.kind.always_closed,
                    slow / packed.row_scale()[row],
                )
            )
            friction += not slippery
        for row in (*spare, *range(packed.contact_rows, len(packed.ws.phi))):
            self.release_row(row)

    @property
    def spare(self) -> list[int]:
        """Rows of joints that repeat others: each can stand in for one of those, or holds once those are released."""
        held = {int(row) for row in self.bilateral()} | self.released
        return [row for row in sorted(self.place) if row < self.packed.contact_rows and row not in held]

    def release_row(self, row: int) -> None:
        """Let row ``row`` of J no longer hold."""
        k, s = self.place[row]
        self.rows[k, s] = -1

    def hold_row(self, row: int) -> None:
        """Let row ``row`` of J hold from now on."""
        k, s = self.place[row]
        self.rows[k, s] = row

    def held(self) -> np.ndarray:
        """Return (m,) which rows hold; joints' redundant rows do too."""
        rows = self.rows[self.rows >= 0]
        out = np.arange(len(self.packed.ws.phi)) < self.packed.contact_rows
        if self.released:
            out[sorted(self.released)] = False
        out[rows] = True
        return out

    def bilateral(self) -> np.ndarray:
        """Return independent rows of joints and drivers that hold."""
        rows = self.rows[self.rows >= 0]
        return np.sort(rows[rows < self.packed.contact_rows])


def friction_rows(packed: Packed) -> np.ndarray:
    """Return (c, 2) rows of the gap and of the sliding of contacts with friction."""
    rows = [
        tuple(packed.rows_of(k)[:2])
        for k, joint in enumerate(packed.joints)
        if isinstance(joint.kind, ContactKind) and joint.params.get("friction", 0.0) != 0.0
    ]
    return np.array(rows, np.int64).reshape(-1, 2)


def _example(m: Any, i: Any, j: Any) -> None:
    m.revolute("pin", i, j)
    m.friction("example", "pin", 0.3, radius=0.2, sticks=True)


STUCK_ANGLE = JointKind("stuck_angle", ("turn",), example=_example, numbers=lambda params: ((0.0, 0.0, 1.0, 0.0),))
STUCK_PLACE = JointKind("stuck_place", ("linear",), example=_example, numbers=lambda params: ((1.0, 0.0, 0.0, 0.0),))


def stuck_rows(packed: Packed) -> list[Joint]:
    """Return what holds the joints that may stick while they do, by the names of their frictions."""
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
    """Return the joints that may stick of a packed mechanism with the rows of ``stuck_rows``."""
    name_of = {packed.rows_of(k).start: joint.name for k, joint in enumerate(packed.joints)}
    return [JointStick(name_of[way], way, at) for at, way in enumerate(loads.friction[:, WAY].tolist()) if way >= 0]


def standing(loads: Loads, held: np.ndarray) -> Iterator[tuple[Loads, np.ndarray]]:
    """Yield loads with the friction of a known motion with rows ``held`` (T, m), and the times (t,) where they act.

    What multipliers hold, and friction of joints that an action released, is no part of it.
    """
    if not len(loads.friction):
        return
    patterns, which = np.unique(held[:, loads.friction[:, FIRST]], axis=0, return_inverse=True)
    for k, there in enumerate(patterns):
        number = loads.friction_number.copy()
        number[:, SENSE] = np.where((loads.friction[:, WAY] < 0) & there, BY_RATE, NONE)
        yield loads._replace(friction_number=number), np.flatnonzero(which.ravel() == k)
