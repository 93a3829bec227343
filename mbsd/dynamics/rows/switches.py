"""Rows of J that are released and held during a run: of contacts, joints that stick, joints that actions release.

The elimination sequence is planned with all of them; a released row is -1 in its block.
"""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass

import numpy as np

from mbsd.arrays.packing import Packed
from mbsd.model.contact import ContactKind
from mbsd.model.joint import Joint


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
            row = int(packed.first_row[k])
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
    """(c, 2) rows of the gap and of the sliding of the contacts with friction."""
    rows = [
        (packed.first_row[k], packed.first_row[k] + 1)
        for k, joint in enumerate(packed.joints)
        if isinstance(joint.kind, ContactKind) and joint.params.get("friction", 0.0) != 0.0
    ]
    return np.array(rows, np.int64).reshape(-1, 2)
