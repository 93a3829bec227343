"""All that events change in a run, in one record; everything else about a mechanism is constant meanwhile.

The arrays are those that kernels read: a change here is seen by the next evaluation. A copy is what a run goes on from.
"""

from __future__ import annotations

from dataclasses import dataclass, field, fields

import numpy as np

from mbsd.dynamics.reference.schur import Schur
from mbsd.dynamics.reference.sliding import Sliding
from mbsd.equations.interactions.switching import APPROACHED
from mbsd.equations.joint_friction import SENSE
from mbsd.equations.loads import Loads
from mbsd.equations.system import ZERO, Workspace

OPEN, SLIDES, STICKS, RELEASED = "open", "slides", "sticks", "released"
"""States of a contact, one without friction slides, and of a joint with friction."""


@dataclass(eq=False)
class Held:
    """Which rows of J hold, and what contacts, joints with friction and events of the user do."""

    rows: np.ndarray
    """(blocks, 2) rows of J in the blocks of Schur.rows; -1: it is released, or there is none."""
    remembered: np.ndarray
    """(k, 2) ZERO and LAST of Workspace.relative: from where sliding is counted, place on a crossing curve."""
    factors: np.ndarray
    """(c,) friction coefficient times direction of sliding of the contacts with friction; 0: it does not slide."""
    senses: np.ndarray
    """(f,) direction in which the friction of each joint acts, or BY_RATE or NONE: see equations/joint_friction.py."""
    approached: np.ndarray
    """(n,) speed at which the contact of each interaction began (m/s); NaN: it never did."""
    released: set[int] = field(default_factory=set)
    """Rows of joints that an action released for good."""
    contacts: list[str] = field(default_factory=list)
    """State of each contact."""
    sliding: list[float] = field(default_factory=list)
    """Direction of sliding of each contact: 1, -1, or 0."""
    joints: list[str] = field(default_factory=list)
    """State of each joint that sticks by events."""
    joints_sliding: list[float] = field(default_factory=list)
    """Direction of sliding of each: 1, -1, or 0."""
    events: dict[str, float] = field(default_factory=dict)
    """Sign of the value of each event of the user."""

    @classmethod
    def of(cls, schur: Schur, ws: Workspace, sliding: Sliding, loads: Loads) -> Held:
        """The record of arrays that kernels read."""
        senses, approached = loads.friction_number[:, SENSE], loads.switch[1:, APPROACHED]
        return cls(schur.rows, ws.relative[:, ZERO:], sliding.table[:, 0], senses, approached)

    def copy(self) -> Held:
        """As it is now."""
        return Held(**{entry.name: getattr(self, entry.name).copy() for entry in fields(self)})

    def restore(self, other: Held) -> None:
        """Become as ``other`` is, in place."""
        for entry in fields(self):
            own, given = getattr(self, entry.name), getattr(other, entry.name)
            if isinstance(own, np.ndarray):
                own[...] = given
            else:
                setattr(self, entry.name, given.copy())
