"""What a force is made of, and the registry that one test walks through.

A force is one scalar element or several, and the magnitude of an element is a sum of terms. An element measures a
scalar x of two markers and acts along it, so that a positive magnitude F makes x grow:

    LINE   x = |p_j - p_i|                  F along the line, apart
    TURN   x = theta_j - theta_i            F is a torque on j, -F on i
    AXIS   x = u_i . (p_j - p_i)            F along the x axis of marker i
    PUSH   x = t                            F on body j at marker j, along the x axis of marker i; i feels nothing

    generalised force  Q = F (dx/dq)^T;     power F x'

    CONSTANT   a                            LAW_VALUE   a law(x)
    LINEAR     -a (x - b)                   LAW_RATE    a law(x')
    DAMPING    -a x'                        LAW_TIME    a law(t)
    POWER      a (x + b)^c                  DRY         -a tanh(x' / b)

What no element can say is an interaction: a function of the relative pose and velocity of two markers in a file of
mbsd/equations/interactions. A function of the user stands in the params as ``function``. A friction of a joint is none
of these.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, NamedTuple, TypeVar

from mbsd.base.codes import TURN
from mbsd.base.derived import adding
from mbsd.base.pickled import ByName, WithFunctions
from mbsd.model.body import Marker
from mbsd.model.laws import Motion
from mbsd.model.laws.curve import Curve

if TYPE_CHECKING:
    import numpy as np

    from mbsd.model.body import Marker
    from mbsd.model.chamber import Chamber
    from mbsd.model.joint import Joint

F = TypeVar("F", bound=Callable[..., Any])


@dataclass(frozen=True)
class Term:
    """One term of a magnitude; ``law`` names one of the force's laws."""

    kind: int
    a: float = 1.0
    b: float = 0.0
    c: float = 0.0
    law: str | None = None


@dataclass(frozen=True)
class Element:
    """One scalar element. ``turned`` turns the x axis of marker i by a right angle (AXIS, PUSH)."""

    kind: int
    terms: tuple[Term, ...]
    turned: bool = False


@dataclass(frozen=True)
class Interaction:
    """A function in mbsd/equations/interactions between two markers, its numbers, and the law of time it reads.

    Where it ``calls_law``, the address of the force's own ``law``, a function of the user, comes before the numbers.
    One that ``remembers`` asks for the speed at which its contact began; one with a ``crank`` reads the angle of the
    body of this name against body i.
    """

    function: str
    i: Marker
    j: Marker
    numbers: Sequence[float]
    law: str | None = None
    calls_law: bool = False
    remembers: bool = False
    crank: str | None = None


class Masses(NamedTuple):
    """Bodies and their masses, ground first, and what joins them."""

    names: Sequence[str]
    com: np.ndarray
    """(nb, 2) centres of mass in the bodies' own frames (m)."""
    mass: np.ndarray
    """(nb,) kg."""
    inertia: np.ndarray
    """(nb,) about the centres of mass (kg m^2)."""
    joints: Sequence[Joint] = ()
    model: str = ""
    """The mechanism's name, for errors."""


def _no_elements(force: Force) -> tuple[Element, ...]:
    return ()


def _no_interactions(force: Force, masses: Masses) -> Sequence[Interaction]:
    return ()


@dataclass(frozen=True)
class ForceKind(ByName):
    """A kind of force."""

    name: str
    elements: Callable[[Force], tuple[Element, ...]] = _no_elements
    """What a force of this kind is made of."""
    example: Callable[[Any, Marker, Marker], object] | None = None
    """Adds one of this kind between two markers of different bodies; must be given."""
    effort: str = ""
    """The argument that is its magnitude, a constant or a law of time: an effort may take its place."""
    interactions: Callable[[Force, Masses], Sequence[Interaction]] = _no_interactions
    """Beside its elements."""
    potential: Callable[[Force, Masses, np.ndarray], np.ndarray] | None = None
    """(T,) potential energy (J) of its interactions along poses (T, 3 nb), if it follows from these alone."""
    surface: Callable[[Force], list[float]] | None = None
    """Of a contact of a disc about marker j, of its ``radius``, with a surface of marker i: the surface's numbers, as
    mbsd/equations/interactions/surface.py reads them."""
    depth_potential: Callable[[Force, np.ndarray], np.ndarray] | None = None
    """(T,) potential energy (J) of such a contact at depths (T,) of the disc in the surface (m)."""
    along: Callable[[Force], Element] | None = None
    """The one element along which its interaction acts, without terms, if it acts along one."""
    chamber: Callable[[Force, Masses], Chamber] | None = None
    """The gas behind a piston that its effort comes from, if it does."""
    outside: bool = False
    """Whether it is a load from outside, to which nothing in the mechanism feels the opposite."""
    of_reactions: bool = False
    """Whether it is friction, which comes from the reaction of a joint; see mbsd/equations/joint_friction.py."""
    on_bodies: bool = False
    """Whether it acts on bodies as a whole, and its markers are no places."""
    sign: str = ""
    """Its sign in drawings, if not that of its first element: see mbsd/drawing/symbols/loads.py."""
    saved: bool = True
    """Whether a file can hold its params; a Python function cannot be saved."""
    also: Mapping[str, str] = field(default_factory=dict)
    """Arguments of other methods that add one, by the names they have in ``add``: change() takes them as well."""
    add: Callable[..., Any] | None = field(default=None, init=False, compare=False)
    """The function ``add(m, name, ...)`` that adds one of this kind, with its arguments checked; see :meth:`adds`."""

    def adds(self, function: F) -> F:
        """Decorator of that function: it is what change(), a saved file and the schema go by."""
        made = adding(function)
        object.__setattr__(self, "add", made)
        return made

    def places(self, force: Force) -> tuple[Marker, ...]:
        """Those of its markers that are places where it acts, and not a direction or a body alone."""
        turning = [element.kind == TURN for element in self.elements(force)]
        return (force.j,) if self.outside or (turning and all(turning)) else (force.i, force.j)


FORCE_KINDS: dict[str, ForceKind] = {}


def register(kind: ForceKind) -> ForceKind:
    """Enter a kind; raises ValueError if its name is taken or the example missing."""
    if not callable(kind.example):
        raise ValueError(f"{kind.name}: an example is missing; the registry test needs one")
    if kind.name in FORCE_KINDS:
        raise ValueError(f"{kind.name}: registered twice")
    FORCE_KINDS[kind.name] = kind
    return kind


@dataclass(frozen=True, eq=False)
class Force(WithFunctions):
    """A force between marker i (first body, or ground) and marker j (second body)."""

    kind: ForceKind
    name: str
    i: Marker
    j: Marker
    params: Mapping[str, Any] = field(default_factory=dict)
    """Numbers of this force by the names of its method's arguments, plain data (SI)."""
    laws: Mapping[str, Motion | Curve] = field(default_factory=dict)
    """Laws of time and characteristic curves by the names of its method's arguments."""
    derived: frozenset[str] = frozenset()
    """Params that nobody gave, found from the others; see mbsd/base/derived.py."""

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
