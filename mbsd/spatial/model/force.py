"""Forces in space: rows that nothing holds, and that push by a law of what they measure.

    F = amount(t) - stiffness (x - free) - damping x',    Q += J^T F

x is the sum of a row's terms (rows.py) and J that of the row, so a force needs no equations of its own: a distance
makes a spring, a turn a torsion spring or a torque, a place along an axis a push or a drag. Others have a function of
frames instead, one of mbsd (contacts, bushings, tyres) or of the user: equations/calls.py.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, TypeVar

from mbsd.base.arguments import adding
from mbsd.base.names import Suggesting
from mbsd.base.pickled import ByName, WithFunctions
from mbsd.model.laws import Motion
from mbsd.spatial.model.body import Body, Marker
from mbsd.spatial.model.joint import Joint
from mbsd.spatial.model.rows import Row

F = TypeVar("F", bound=Callable[..., Any])


@dataclass(frozen=True)
class Push:
    """A row and the numbers by which it pushes (SI)."""

    row: Row
    stiffness: float = 0.0
    free: float = 0.0
    """Value of the row at which stiffness pushes nothing."""
    damping: float = 0.0
    amount: float = 0.0
    law: str = ""
    """Name of the force's law of time that is added; empty: none."""


@dataclass(frozen=True)
class Call:
    """A function of frames, and its numbers."""

    function: Any
    """The name of a law of mbsd (arrays/calls.py), or a function of the user."""
    frames: tuple[Marker, ...]
    numbers: Sequence[float] = ()


@dataclass(frozen=True)
class ForceKind(ByName):
    """A kind of force: it has rows, or a function of frames."""

    name: str
    pushes: Callable[[Force], list[Push]]
    """Function of a force: its rows, in their order."""
    example: Callable[[Any, Body, Body], object]
    """Adds one of this kind between two bodies, with what it needs."""
    call: Callable[[Force], Call] | None = None
    """Function of a force: its own function with its frames."""
    friction_of: Callable[[Force], list[float]] | None = None
    """Function of a force of one row that is friction: its numbers (equations/friction.py)."""
    look: str = ""
    """Look in pictures, as forces of data.json have it; empty: not drawn."""
    add: Callable[..., Any] | None = field(default=None, init=False, compare=False)
    """The function ``add(m, name, ...)`` that adds one of this kind, with its arguments checked."""

    def adds(self, function: F) -> F:
        """Decorate that function."""
        checked = adding(function)
        object.__setattr__(self, "add", checked)
        return checked


def no_rows(force: Force) -> list[Push]:
    """Return the rows of a force that is a function."""
    return []


FORCE_KINDS: dict[str, ForceKind] = {}


def register_force(kind: ForceKind) -> ForceKind:
    """Enter a kind; raises ValueError if its name is known."""
    if kind.name in FORCE_KINDS:
        raise ValueError(f"{kind.name}: registered twice")
    FORCE_KINDS[kind.name] = kind
    return kind


@dataclass(frozen=True, eq=False)
class Force(Suggesting, WithFunctions):
    """A force between marker i (first body) and marker j (second body)."""

    kind: ForceKind
    name: str
    i: Marker
    j: Marker
    params: Mapping[str, Any] = field(default_factory=dict)
    laws: Mapping[str, Motion] = field(default_factory=dict)
    """Laws of time by the names of the method's arguments."""
    joint: Joint | None = None
    """The joint about or along whose axis it acts."""

    @property
    def pushes(self) -> list[Push]:
        """Its rows."""
        return self.kind.pushes(self)

    @property
    def call(self) -> Call | None:
        """Its function, None of forces that are rows."""
        return None if self.kind.call is None else self.kind.call(self)

    def __repr__(self) -> str:
        return f"<{self.kind.name} '{self.name}' between {self.i.body.name} and {self.j.body.name}>"
