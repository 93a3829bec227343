"""Unilateral contacts: their data, and the registry of kinds.

The first constraint is the gap g >= 0; a second one, if there is one, is the way s that the bodies slide on each
other. While the contact is closed, g = 0 is a row of J with the normal force N >= 0; while it sticks, s is one too.

    open     g > 0                        nothing acts
    slides   g = 0, N >= 0, s' != 0       friction -mu N sign(s')
    sticks   g = 0, N >= 0, s' = 0        |T| <= mu N
    impact   g = 0, g' < 0                velocities jump; see mbsd/dynamics/events/jumps.py
"""

from __future__ import annotations

from dataclasses import dataclass

from mbsd.model.joint import ROWS, SPECIALS, JointKind
from mbsd.model.looks import refuse_unknown_look


@dataclass(frozen=True)
class ContactKind(JointKind):
    """A kind of contact."""

    always_closed: bool = False
    """The gap is no place but a way that may only grow: a one-way clutch."""

    @property
    def of_angle(self) -> bool:
        """True if its gap is an angle (rad) and what pushes it open a torque (N m)."""
        return SPECIALS[self.constraints[0]].unit == "rad"


CONTACT_KINDS: dict[str, ContactKind] = {}


def register(kind: ContactKind) -> ContactKind:
    """Register a kind; raises ValueError if its name is taken or a constraint is not of relative pose."""
    if not kind.constraints or any(name not in SPECIALS or ROWS[name] != 1 for name in kind.constraints):
        raise ValueError(f"{kind.name}: constraints {kind.constraints}; there are {', '.join(SPECIALS)}")
    refuse_unknown_look(kind.name, kind.look)
    if kind.name in CONTACT_KINDS:
        raise ValueError(f"{kind.name}: registered twice")
    CONTACT_KINDS[kind.name] = kind
    return kind
