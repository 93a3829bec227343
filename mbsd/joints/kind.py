"""What a joint or driver is made of, and the registry that one test walks through.

A kind names its constraints in the order of its rows. It must bring an example, so that none escapes the test.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from mbsd.model import Marker, Mechanism

ROWS = {"point": 2, "angle": 1, "slot": 1, "along": 1, "distance": 1}
"""Rows that each constraint takes in J."""


@dataclass(frozen=True)
class JointKind:
    """A kind of joint, or of driver where ``driven``."""

    name: str
    constraints: tuple[str, ...]
    example: Callable[[Mechanism, Marker, Marker], object]
    """Adds one of this kind between two markers of different bodies."""
    driven: bool = False
    units: tuple[str, str] = ("N", "N m")
    """Units of a driver's effort and, unused for joints, of its value."""

    @property
    def rows(self) -> int:
        """Rows in J: freedoms taken away."""
        return sum(ROWS[name] for name in self.constraints)


KINDS: dict[str, JointKind] = {}


def register(kind: JointKind) -> JointKind:
    """Enter a kind; raises ValueError if its name is taken, a constraint unknown or the example missing."""
    unknown = [name for name in kind.constraints if name not in ROWS]
    if unknown or not kind.constraints:
        raise ValueError(f"{kind.name}: constraints {unknown or 'are missing'}; there are {', '.join(ROWS)}")
    if not callable(kind.example):
        raise ValueError(f"{kind.name}: an example is missing; the registry test needs one")
    if kind.name in KINDS:
        raise ValueError(f"{kind.name}: registered twice")
    KINDS[kind.name] = kind
    return kind
