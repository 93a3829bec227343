"""Rows of J that are let go and taken up during a run: of contacts, joints that stick, and joints that actions let go.

The elimination sequence is planned with all of them; a row that is let go is -1 in its block.
"""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass

import numpy as np

from mbsd.arrays.packing import Packed
from mbsd.dynamics.rows.held import OPEN, Held
from mbsd.equations.constraints.relative import AT, ROW
from mbsd.kinematics.pose.mobility import independent_rows, scaled_jacobian
from mbsd.model.contact import ContactKind
from mbsd.model.joint import Joint


@dataclass(eq=False)
class Touch:
    """A contact of a run."""

    held: Held
    number: int
    """Its place in ``held``."""
    contact: Joint
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
        """Of the contact: OPEN, SLIDES or STICKS."""
        return self.held.contacts[self.number]

    def set(self, state: str, sign: float = 0.0) -> None:
        """Open, slide with this sign, or stick."""
        self.held.contacts[self.number], self.held.sliding[self.number] = state, sign

    @property
    def sign(self) -> float:
        """Of its sliding."""
        return self.held.sliding[self.number]

    @property
    def name(self) -> str:
        """Of the contact."""
        return self.contact.name

    @property
    def friction(self) -> float:
        """Coulomb's coefficient."""
        return self.contact.params.get("friction", 0.0)

    @property
    def static_friction(self) -> float:
        """The same for what sticks."""
        return self.contact.params.get("static_friction", 0.0)

    @property
    def restitution(self) -> float:
        """Speed after over speed before."""
        return self.contact.params.get("restitution", 0.0)


SETTLE = 1e-4
"""Rebounds below this part of sqrt(size g), the speed gained in falling by half the size, end the bouncing."""


class Switches:
    """What holds now. Made before anything is let go; then all contacts are open."""

    def __init__(self, packed: Packed, held: Held, spare: Collection[int] = ()) -> None:
        self.packed = packed
        self.now = held
        self.place = {int(row): (k, s) for k, rows in enumerate(held.rows) for s, row in enumerate(rows) if row >= 0}
        self.touches: list[Touch] = []
        special = packed.system.special
        self._number_of = {int(special[k, ROW]): int(special[k, AT]) for k in range(len(special))}
        first = len(packed.joints) - packed.contacts
        slow = SETTLE * float(np.sqrt(np.hypot(*packed.system.gravity) / packed.size or 1.0))
        friction = 0
        for k, contact in enumerate(packed.joints[first:], first):
            if not isinstance(contact.kind, ContactKind):
                continue  # the row of a joint that sticks
            row = int(packed.first_row[k])
            slippery = contact.params.get("friction", 0.0) == 0.0
            self.touches.append(
                Touch(
                    held,
                    len(self.touches),
                    contact,
                    row,
                    None if slippery else row + 1,
                    -1 if slippery else friction,
                    contact.kind.always_closed,
                    slow / packed.row_scale()[row],
                )
            )
            friction += not slippery
        held.contacts, held.sliding = [OPEN] * len(self.touches), [0.0] * len(self.touches)
        for row in (*spare, *range(packed.contact_rows, len(packed.ws.phi))):
            self.let_go(row)

    @property
    def spare(self) -> list[int]:
        """Rows of joints that repeat others: each can stand in for one of those, or holds once those are released."""
        held = {int(row) for row in self.bilateral()} | self.now.released
        return [row for row in sorted(self.place) if row < self.packed.contact_rows and row not in held]

    def let_go(self, row: int) -> None:
        """Row ``row`` of J holds no more."""
        k, s = self.place[row]
        self.now.rows[k, s] = -1

    def take_up(self, row: int) -> None:
        """Row ``row`` of J holds."""
        k, s = self.place[row]
        self.now.rows[k, s] = row

    def release(self, joint: int) -> None:
        """Let joint number ``joint`` of the packed mechanism go for good."""
        for row in range(int(self.packed.first_row[joint]), int(self.packed.first_row[joint + 1])):
            self.now.released.add(row)
            if row in self.place:
                self.let_go(row)

    def stand_in(self, q: np.ndarray) -> None:
        """Take up the spare rows that no others repeat any more in pose q (3 nb,)."""
        left = self.spare
        if left:
            held = [int(row) for row in self.bilateral()]
            rows = [*held, *left]
            for k in independent_rows(scaled_jacobian(self.packed, q)[rows]):
                if k >= len(held):
                    self.take_up(rows[k])

    def move_zero(self, row: int, residual: float) -> None:
        """Count the way of a contact or of a joint that sticks from here, where its residual is ``residual``."""
        from mbsd.equations.relative.equation import PHASE

        self.packed.system.numbers[self._number_of[row] + PHASE] += residual

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
