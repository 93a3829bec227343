"""Joints, drivers and contacts: their data, and the registries of kinds.

A kind names its constraints in the order of its rows. It must bring an example, so that none escapes the test.

Its look is what pictures of solids draw of a joint, driver, force or contact, in addition to the parts:

band        a belt or chain round both wheels
roller      a roller about marker j that is pressed on one side: a cam's
captive     a roller or pin about marker j between two walls: of a slot, a curve, a wheel with slots
coil        a coil spring; of what holds no potential energy a cylinder with its rod
cylinder    a cylinder with its rod
spiral      a flat spiral over the pin of both bodies; of what holds no potential energy nothing
cord        a rope

The first constraint of a contact is the gap g >= 0. A second one, if there is one, is the distance s that the bodies
slide on each other. While the contact is closed, g = 0 is a row of J with the normal force N >= 0; while it sticks, s
is one too.

    open     g > 0                        nothing acts
    slides   g = 0, N >= 0, s' != 0       friction -mu N sign(s')
    sticks   g = 0, N >= 0, s' = 0        |T| <= mu N
    impact   g = 0, g' < 0                velocities jump; see mbsd/dynamics/events/jumps.py
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, TypeVar

from mbsd.base.arguments import adding
from mbsd.base.names import Suggesting
from mbsd.base.pickled import ByName, WithFunctions
from mbsd.model.body import Marker
from mbsd.model.laws import Motion
from mbsd.model.teeth import with_radii

if TYPE_CHECKING:
    import numpy as np


F = TypeVar("F", bound=Callable[..., Any])


@dataclass(frozen=True)
class Special:
    """A constraint F(x, y, a) of the relative pose, one row; see mbsd/equations/relative/equation.py."""

    equation: str
    """File in mbsd/equations/relative."""
    unit: str
    """Unit of the residual: m or rad."""
    phased: bool = False
    """Its constant is taken from the closed start pose: it holds how the bodies roll on each other, not where."""


SPECIALS: dict[str, Special] = {
    "gear": Special("gear", "m", phased=True),
    "turns": Special("gear", "rad", phased=True),
    "rack": Special("linear", "m", phased=True),
    "span": Special("span", "m", phased=True),
    "height": Special("linear", "m"),
    "curve": Special("curve", "m"),
    "curve_rolling": Special("curve_rolling", "m", phased=True),
    "support": Special("support", "m"),
    "outline": Special("outline", "m"),
    "outline_sliding": Special("outline_sliding", "m"),
    "geneva": Special("geneva", "rad"),
    "user": Special("user", "m"),
    "linear": Special("linear", "m"),
    "turn": Special("linear", "rad"),
    "radial": Special("radial", "m"),
}
ROWS = {"point": 2, "angle": 1, "slot": 1, "along": 1, "distance": 1} | dict.fromkeys(SPECIALS, 1)
"""Rows that each constraint takes in J."""
TOUCHING = ("", "line", "curve", "discs", "place")
"""See :attr:`JointKind.touching`."""
_PAIRS = {frozenset({"point"}): "pin", frozenset({"slot", "angle"}): "guide", frozenset({"slot"}): "slot"}


@dataclass(frozen=True)
class JointKind(ByName):
    """A kind of joint, or of driver where ``driven``."""

    name: str
    constraints: tuple[str, ...]
    example: Callable[[Any, Marker, Marker], object]
    """Adds one of this kind between two markers of different bodies."""
    driven: bool = False
    units: tuple[str, str] = ("N", "N m")
    """Units of a driver's effort and, unused for joints, of its value."""
    numbers: Callable[[Mapping[str, Any]], Sequence[Sequence[float] | np.ndarray]] | None = None
    """Function of a joint's params: the numbers of each special constraint, in their order."""
    problem: Callable[[Mapping[str, Any], float, float], str | None] | None = None
    """Function of params and the place (x, y) of marker j against marker i at the start: why this joint cannot be."""
    kept: Callable[[Mapping[str, Any], Any, Any], Any] | None = None
    """Function of params and places (x, y), arrays of them too: a length (m) that must stay for this joint to be."""
    lengths: tuple[str, ...] = ()
    """Params that are lengths (m), or places of a curve, and say how large the mechanism is."""
    touching: str = ""
    """Where its force acts if that is beside marker j: on a "line" along the x axis of marker i, a "curve" of body i,
    between "discs" about both markers, or at a "place" that follows from its torque."""
    look: str = ""
    """Its look in pictures of solids: one of ``LOOKS`` in mbsd/model/joint.py."""
    symmetry: Callable[[Mapping[str, Any]], int] | None = None
    """From params: the order n of the rotational symmetry of body j about marker j, where its equations do not tell
    n-th parts of a turn apart, as of a wheel that is indexed by its slots.
    """
    sign: str = ""
    """The kind whose sign it has in drawings; its own if empty. See mbsd/drawing/symbols."""
    saved: bool = True
    """True if a file can hold its params; a Python function cannot be saved."""
    add: Callable[..., Any] | None = field(default=None, init=False, compare=False)
    """The function ``add(m, name, ...)`` that adds one of this kind, with its arguments checked; see :meth:`adds`."""

    def adds(self, function: F) -> F:
        """Decorator of that function: it is what change(), a saved file and the schema go by."""
        made = adding(function)
        object.__setattr__(self, "add", made)
        return made

    def extents(self, params: Mapping[str, Any]) -> list[float]:
        """Lengths (m) among the params that tell how large the mechanism is."""
        sized = with_radii(params)
        values = [sized[key] for key in self.lengths]
        return [
            value if isinstance(value, float) else max(max(x) - min(x) for x in list(zip(*value, strict=True))[:2])
            for value in values
        ]

    @property
    def pair(self) -> str | None:
        """How its bodies move on each other; None of other joints and of drivers.

        "pin": they turn about a common point. "guide": marker j slides along the x axis of marker i, without turning.
        "slot": it slides there and turns.
        """
        return None if self.driven else _PAIRS.get(frozenset(self.constraints))

    @property
    def slides(self) -> bool:
        """True if marker j moves along the x axis of marker i."""
        return self.pair in ("guide", "slot")

    @property
    def drawn_as(self) -> str:
        """The kind whose sign it has."""
        return self.sign or self.name

    @property
    def angular(self) -> bool:
        """True if a driver of this kind imposes an angle."""
        return self.units[1] == "rad"

    @property
    def rows(self) -> int:
        """Rows in J: freedoms taken away."""
        return sum(ROWS[name] for name in self.constraints)


KINDS: dict[str, JointKind] = {}


def register_joint(kind: JointKind) -> JointKind:
    """Enter a kind; raises ValueError if its name is taken, a constraint unknown or the example missing."""
    unknown = [name for name in kind.constraints if name not in ROWS]
    if unknown or not kind.constraints:
        raise ValueError(f"{kind.name}: constraints {unknown or 'are missing'}; there are {', '.join(ROWS)}")
    if not callable(kind.example):
        raise ValueError(f"{kind.name}: an example is missing; the registry test needs one")
    if kind.touching not in TOUCHING:
        raise ValueError(
            f"{kind.name}: touching is {kind.touching!r}; it must be one of {', '.join(TOUCHING[1:])}, or empty"
        )
    check_look(kind.name, kind.look)
    if kind.name in KINDS:
        raise ValueError(f"{kind.name}: registered twice")
    KINDS[kind.name] = kind
    return kind


@dataclass(frozen=True, eq=False)
class Joint(Suggesting, WithFunctions):
    """A joint or driver between marker i (first body) and marker j (second body)."""

    kind: JointKind
    name: str
    i: Marker
    j: Marker
    params: Mapping[str, Any] = field(default_factory=dict)
    """Numbers of this joint by the names of its method's arguments, plain data (SI)."""
    motion: Motion | None = None
    derived: frozenset[str] = frozenset()
    """Params that nobody gave, found from the others; see mbsd/base/arguments.py."""

    @property
    def given(self) -> dict[str, Any]:
        """The params that are not derived."""
        return {key: value for key, value in self.params.items() if key not in self.derived}

    def __repr__(self) -> str:
        return f"<{self.kind.name} '{self.name}' between {self.i.body.name} and {self.j.body.name}>"

    @property
    def bodies(self) -> tuple[str, str]:
        """Names of the first and second body."""
        return self.i.body.name, self.j.body.name


LOOKS = ("", "band", "roller", "captive", "coil", "cylinder", "spiral", "cord")


def check_look(name: str, look: str) -> None:
    """Raise ValueError, naming the kind ``name``, unless ``look`` is one of :data:`LOOKS`."""
    if look not in LOOKS:
        raise ValueError(f"{name}: look is {look!r}; it must be one of {', '.join(LOOKS[1:])}, or empty")


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


def register_contact(kind: ContactKind) -> ContactKind:
    """Register a kind; raises ValueError if its name is taken or a constraint is not of relative pose."""
    if not kind.constraints or any(name not in SPECIALS or ROWS[name] != 1 for name in kind.constraints):
        raise ValueError(f"{kind.name}: constraints {kind.constraints}; there are {', '.join(SPECIALS)}")
    check_look(kind.name, kind.look)
    if kind.name in CONTACT_KINDS:
        raise ValueError(f"{kind.name}: registered twice")
    CONTACT_KINDS[kind.name] = kind
    return kind
