"""Joints, couplings and drivers in space: their data, and the registry of kinds.

A kind says which rows its joints have. It must bring an example, so that none escapes the test.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any, TypeVar

from mbsd.base.arguments import adding
from mbsd.base.names import Suggesting
from mbsd.base.pickled import ByName
from mbsd.model.laws import Motion
from mbsd.spatial.model.body import Body, Marker
from mbsd.spatial.model.rows import Row

F = TypeVar("F", bound=Callable[..., Any])


@dataclass(frozen=True)
class JointKind(ByName):
    """A kind of joint or coupling, or of driver where ``driven``."""

    name: str
    rows: Callable[[Joint], list[Row]]
    """Function of a joint: its rows, in their order."""
    example: Callable[[Any, Body, Body], object]
    """Adds one of this kind between two bodies, with what it needs."""
    turns: bool = False
    """True if marker j turns about the z axis of marker i, and this turn can be driven."""
    slides: bool = False
    """True if marker j moves along the z axis of marker i, and this slide can be driven."""
    has_friction: bool = False
    """True if friction is known from its reaction, of a pin or a guide."""
    holds_rates: bool = False
    """True if rows hold rates and no place, so that no value of the drivers says where it is."""
    coupling: int = 0
    """Number of its last rows that couple its turn and slide."""
    driven: bool = False
    unit: str = ""
    """Unit of what a driver imposes: m or rad."""
    add: Callable[..., Any] | None = field(default=None, init=False, compare=False)
    """The function ``add(m, name, ...)`` that adds one of this kind, with its arguments checked."""

    def adds(self, function: F) -> F:
        """Decorate that function."""
        checked = adding(function)
        object.__setattr__(self, "add", checked)
        return checked

    @property
    def angular(self) -> bool:
        """True if a driver of this kind imposes an angle."""
        return self.unit == "rad"

    @property
    def constraints(self) -> tuple[str, ...]:
        """The word by which checks of laws know a driven distance."""
        return ("distance",) if self.name == "drive_distance" else ()


KINDS: dict[str, JointKind] = {}


def register_joint(kind: JointKind) -> JointKind:
    """Enter a kind; raises ValueError if its name is known or its example missing."""
    if not callable(kind.example):
        raise ValueError(f"{kind.name}: an example is missing; the registry test needs one")
    if kind.name in KINDS:
        raise ValueError(f"{kind.name}: registered twice")
    KINDS[kind.name] = kind
    return kind


@dataclass(frozen=True, eq=False)
class Joint(Suggesting):
    """A joint, coupling or driver between marker i (first body) and marker j (second body)."""

    kind: JointKind
    name: str
    i: Marker
    j: Marker
    params: Mapping[str, Any] = field(default_factory=dict)
    """Numbers of this joint by the names of its method's arguments (SI)."""
    motion: Motion | None = None
    coupled: tuple[Joint, ...] = ()
    """Joints whose turns and slides this one couples or drives."""

    @property
    def rows(self) -> list[Row]:
        """Its rows."""
        return self.kind.rows(self)

    @property
    def bodies(self) -> tuple[str, str]:
        """Names of the first and second body."""
        return self.i.body.name, self.j.body.name

    def __repr__(self) -> str:
        return f"<{self.kind.name} '{self.name}' between {self.i.body.name} and {self.j.body.name}>"
