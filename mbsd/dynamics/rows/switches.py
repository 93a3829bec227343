"""Rows of J that are released and held during a run: of contacts, joints that stick, joints that actions release.

The elimination sequence is planned with all of them; a released row is -1 in its block.
"""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass

import numpy as np

from mbsd.arrays.packing import Packed
from mbsd.dynamics.rows.held import OPEN, Held
from mbsd.equations.constraints.relative import ROW
from mbsd.kinematics.pose.mobility import independent_rows, scaled_jacobian
from mbsd.model.contact import ContactKind
from mbsd.model.joint import Joint


@dataclass(eq=False)
class RunContact:
    """A contact of a run."""

    held: Held
    number: int
    """Its place in ``held``."""
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
    def state(self) -> str:
        """State of the contact: OPEN, SLIDES or STICKS."""
        return self.held.contacts[self.number]

    def set(self, state: str, sign: float = 0.0) -> None:
        """Open, slide with this sign, or stick."""
        self.held.contacts[self.number], self.held.sliding[self.number] = state, sign

    @property
    def sign(self) -> float:
        """The direction of its sliding: 1, -1, or 0."""
        return self.held.sliding[self.number]

    @property
    def name(self) -> str:
        """The contact's name."""
        return self.joint.name

    @property
    def friction(self) -> float:
        """Coulomb's coefficient."""
        return self.joint.params.get("friction", 0.0)

    @property
    def static_friction(self) -> float:
        """Coulomb's coefficient while it sticks."""
        return self.joint.params.get("static_friction", 0.0)

    @property
    def restitution(self) -> float:
        """The speed after an impact divided by the speed before."""
        return self.joint.params.get("restitution", 0.0)


SETTLE = 1e-4
"""Rebounds below this part of sqrt(size g), the speed gained in falling by half the size, end the bouncing."""


class Switches:
    """Says which rows hold now. It is made while all of them do; then all contacts are open."""

    def __init__(self, packed: Packed, held: Held, spare: Collection[int] = ()) -> None:
        self.packed = packed
        self.now = held
        self.place = {int(row): (k, s) for k, rows in enumerate(held.rows) for s, row in enumerate(rows) if row >= 0}
        self.contacts: list[RunContact] = []
        special = packed.system.special
        self._special_of = {int(special[k, ROW]): k for k in range(len(special))}
        first = len(packed.joints) - packed.contacts
        friction = 0
        for k, joint in enumerate(packed.joints[first:], first):
            if not isinstance(joint.kind, ContactKind):
                continue  # the row of a joint that sticks
            row = int(packed.first_row[k])
            slow = SETTLE * float(np.sqrt(np.hypot(*packed.system.gravity) / packed.size or 1.0))
            slippery = joint.params.get("friction", 0.0) == 0.0
            self.contacts.append(
                RunContact(
                    held,
                    len(self.contacts),
                    joint,
                    row,
                    None if slippery else row + 1,
                    -1 if slippery else friction,
                    joint.kind.always_closed,
                    slow / packed.row_scale()[row],
                )
            )
            friction += not slippery
        held.contacts, held.sliding = [OPEN] * len(self.contacts), [0.0] * len(self.contacts)
        for row in (*spare, *range(packed.contact_rows, len(packed.ws.phi))):
            self.release_row(row)

    @property
    def spare(self) -> list[int]:
        """Rows of joints that repeat others: each can stand in for one of those, or holds once those are released."""
        held = {int(row) for row in self.bilateral()} | self.now.released
        return [row for row in sorted(self.place) if row < self.packed.contact_rows and row not in held]

    def release_row(self, row: int) -> None:
        """Row ``row`` of J no longer holds."""
        k, s = self.place[row]
        self.now.rows[k, s] = -1

    def hold_row(self, row: int) -> None:
        """Row ``row`` of J holds from now on."""
        k, s = self.place[row]
        self.now.rows[k, s] = row

    def release(self, joint: int) -> None:
        """Release joint number ``joint`` of the packed mechanism for good."""
        for row in range(int(self.packed.first_row[joint]), int(self.packed.first_row[joint + 1])):
            self.now.released.add(row)
            if row in self.place:
                self.release_row(row)

    def hold_spare(self, q: np.ndarray) -> None:
        """Hold the spare rows that no others repeat any more in pose q (3 nb,)."""
        left = self.spare
        if left:
            held = [int(row) for row in self.bilateral()]
            rows = [*held, *left]
            for k in independent_rows(scaled_jacobian(self.packed, q)[rows]):
                if k >= len(held):
                    self.hold_row(rows[k])

    def move_zero(self, row: int, residual: float) -> None:
        """Count the way of a contact or of a joint that sticks from here, where its residual is ``residual``."""
        self.now.remembered[self._special_of[row], 0] += residual

    def held(self) -> np.ndarray:
        """(m,) which rows hold; joints' redundant rows do too."""
        rows = self.now.rows[self.now.rows >= 0]
        out = np.arange(len(self.packed.ws.phi)) < self.packed.contact_rows
        out[sorted(self.now.released)] = False
        out[rows] = True
        return out

    def bilateral(self) -> np.ndarray:
        """Independent rows of joints and drivers that hold."""
        rows = self.now.rows[self.now.rows >= 0]
        return np.sort(rows[rows < self.packed.contact_rows])


def friction_rows(packed: Packed) -> np.ndarray:
    """(c, 2) rows of the gap and of the sliding of the contacts with friction."""
    rows = [
        (packed.first_row[k], packed.first_row[k] + 1)
        for k, joint in enumerate(packed.joints)
        if isinstance(joint.kind, ContactKind) and joint.params.get("friction", 0.0) != 0.0
    ]
    return np.array(rows, np.int64).reshape(-1, 2)
