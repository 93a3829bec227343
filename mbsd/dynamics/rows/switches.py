"""Rows of J that are let go and taken up during a run: of contacts, joints that stick, and joints that actions let go.

The elimination sequence is planned with all of them; a row that is let go is -1 in its block.
"""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass

import numpy as np

from mbsd.arrays.packing import Packed
from mbsd.dynamics.reference.schur import Schur
from mbsd.equations.constraints.relative import AT, ROW
from mbsd.kinematics.pose.mobility import independent_rows, scaled_jacobian
from mbsd.model.contact import ContactKind
from mbsd.model.joint import Joint

OPEN, SLIDES, STICKS, RELEASED = "open", "slides", "sticks", "released"
"""States of a contact, one without friction slides, and of a joint with friction."""


@dataclass
class Touch:
    """A contact of a run."""

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
    state: str = OPEN

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

    def __init__(self, packed: Packed, schur: Schur, spare: Collection[int] = ()) -> None:
        self.packed = packed
        self.schur = schur
        self.place = {int(row): (k, s) for k, rows in enumerate(schur.rows) for s, row in enumerate(rows) if row >= 0}
        self.released: set[int] = set()
        """Rows of joints that an action let go."""
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
                    contact,
                    row,
                    None if slippery else row + 1,
                    -1 if slippery else friction,
                    contact.kind.always_closed,
                    slow / packed.row_scale()[row],
                )
            )
            friction += not slippery
        for row in (*spare, *range(packed.contact_rows, len(packed.ws.phi))):
            self.let_go(row)

    @property
    def spare(self) -> list[int]:
        """Rows of joints that repeat others: each can stand in for one of those, or holds once those are released."""
        held = {int(row) for row in self.bilateral()} | self.released
        return [row for row in sorted(self.place) if row < self.packed.contact_rows and row not in held]

    @property
    def friction_rows(self) -> np.ndarray:
        """(c, 2) rows of gap and way of the contacts with friction."""
        rows = [(touch.gap, touch.way) for touch in self.touches if touch.way is not None]
        return np.array(rows, np.int64).reshape(-1, 2)

    def let_go(self, row: int) -> None:
        """Row ``row`` of J holds no more."""
        k, s = self.place[row]
        self.schur.rows[k, s] = -1

    def take_up(self, row: int) -> None:
        """Row ``row`` of J holds."""
        k, s = self.place[row]
        self.schur.rows[k, s] = row

    def release(self, joint: int) -> None:
        """Let joint number ``joint`` of the packed mechanism go for good."""
        for row in range(int(self.packed.first_row[joint]), int(self.packed.first_row[joint + 1])):
            self.released.add(row)
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
        rows = self.schur.rows[self.schur.rows >= 0]
        out = np.arange(len(self.packed.ws.phi)) < self.packed.contact_rows
        out[sorted(self.released)] = False
        out[rows] = True
        return out

    def bilateral(self) -> np.ndarray:
        """Independent rows of joints and drivers that hold."""
        rows = self.schur.rows[self.schur.rows >= 0]
        return np.sort(rows[rows < self.packed.contact_rows])
