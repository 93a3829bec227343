"""Forces: their data, and the registry of kinds.

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

A chamber behind a piston as its results are asked for: pressure, volume, and what a cycle gives.

Where markers are along given poses, for potentials of forces.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, NamedTuple, TypeVar

import numpy as np

from mbsd.base.arguments import adding
from mbsd.base.codes import MOST_STATES, TURN
from mbsd.base.names import Suggesting
from mbsd.base.pickled import ByName, WithFunctions
from mbsd.model.body import Marker
from mbsd.model.joint import check_look
from mbsd.model.laws import Motion
from mbsd.model.laws.curve import Curve

if TYPE_CHECKING:
    from mbsd.model.joint import Joint
    from mbsd.model.oil_cylinder import OilCylinder


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
    """Function in mbsd/equations/interactions between two markers, its numbers, and its law of time.

    Where it ``calls_law``, the address of the force's own ``law``, a function of the user, comes before the numbers.
    One that ``remembers`` asks for the speed at which its contact began; one with a ``crank`` reads the angle of the
    body of this name against body i; one ``with_states`` reads the states of the force, and says how they change.
    """

    function: str
    i: Marker
    j: Marker
    numbers: Sequence[float]
    law: str | None = None
    calls_law: bool = False
    remembers: bool = False
    crank: str | None = None
    with_states: bool = False
    phased: bool = False
    """True if the constant of a mesh that the start pose decides is added to its first number."""


@dataclass(frozen=True)
class Mesh:
    """How two gears with play stand in each other's teeth; lengths along their line of action."""

    rolled: Callable[[Force, float, float, float], float]
    """Function of the angles of the line of centres and of both markers (rad, world): the distance rolled (m)."""
    flanks: Callable[[Force, float, np.ndarray, np.ndarray, np.ndarray], np.ndarray]
    """(2, T) depths of both flanks (m), below 0 where they do not touch, from the constant (m) of the start pose and
    x, y, angle (T,) of marker j in the axes of marker i."""
    pitch: Callable[[Force], float]
    """Position of the pitch point on the way from marker i (0) to marker j (1)."""
    period: Callable[[Mapping[str, Any]], float]
    """Function of params: the distance of rolling (m) after which teeth repeat."""


@dataclass(frozen=True)
class States:
    """States that a force carries through a motion, as a cylinder its pressures: first-order equations."""

    names: tuple[str, ...]
    """Also of the params that give them at the start, each a number or None."""
    unit: str
    one: Callable[[Force], float]
    """The value (SI) that tolerances are relative to, as they are to the mechanism's size."""
    start: Callable[[str, Force, Mapping[str, float], float, float, float], Sequence[float]]
    """The values (n,) at the start: from the mechanism's name, the values of the force's laws of time, what the force
    measures, its rate, and the effort at which what it measures would not accelerate. Raises ModelError for a start
    that cannot be."""
    check: Callable[[str, Force, np.ndarray, np.ndarray, np.ndarray], None]
    """From the mechanism's name, times (T,), what the force measures (T,) and its states (T, n). Raises ModelError for
    a motion that cannot be, SimulationError for one that long steps spoiled, and warns of one that should not be."""


class Valved(NamedTuple):
    """Two chambers whose pressures are its states, and the valve that leads gas into them."""

    volumes: Callable[[Force, np.ndarray], tuple[np.ndarray, np.ndarray]]
    """Function of what the force measures (T,): volumes of both chambers (T,) (m^3)."""
    valve: Callable[[Force, Masses], tuple[str, float, float, float]]
    """The valve's body, and its travel from its centre of mass in the axes of marker i: two factors and a sum (m)."""


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
    size: float = 1.0
    """Size of the mechanism (m): a state of a force is a speed in it, by ``States.one`` for one size a second."""


def _no_elements(force: Force) -> tuple[Element, ...]:
    return ()


def _no_interactions(force: Force, masses: Masses) -> Sequence[Interaction]:
    return ()


class Press(NamedTuple):
    """How surfaces of a play are pressed together."""

    depth: float
    """m, below 0 where there is room left."""
    force: float
    """N, that this takes."""
    room: float
    """The play to either side (m)."""


@dataclass(frozen=True)
class ForceKind(ByName):
    """A kind of force."""

    name: str
    elements: Callable[[Force], tuple[Element, ...]] = _no_elements
    """Elements of a force of this kind."""
    example: Callable[[Any, Marker, Marker], object] | None = None
    """Adds one of this kind between two markers of different bodies; must be given."""
    effort: str = ""
    """The argument that is its magnitude, a constant or a law of time: an effort may take its place."""
    interactions: Callable[[Force, Masses], Sequence[Interaction]] = _no_interactions
    """Beside its elements."""
    potential: Callable[[Force, Masses, np.ndarray], np.ndarray] | None = None
    """(T,) potential energy (J) of its interactions along poses (T, 3 nb), if it follows from these alone."""
    surface: Callable[[Force], list[float]] | None = None
    """Numbers of the surface of marker i that a disc about marker j, of its ``radius``, touches, as
    mbsd/equations/interactions/law.py reads them."""
    depth_potential: Callable[[Force, np.ndarray], np.ndarray] | None = None
    """(T,) potential energy (J) of such a contact at depths (T,) of the disc in the surface (m)."""
    journal: Callable[[Force], tuple[float, float]] | None = None
    """Radius (m) of a journal about marker j in a bearing about marker i, and its radial clearance (m)."""
    mesh: Mesh | None = None
    """Position in their teeth of gears with play."""
    counts_turn: bool = False
    """True if the angle of marker j against marker i counts from the start pose."""
    restarted: Callable[[Force, float], Mapping[str, Any]] | None = None
    """Function of how far its angle has turned since (rad): params with which it goes on from there."""
    ideal: Callable[[Force], Joint | None] | None = None
    """The joint whose place it takes, which holds at the start alone; None of a force that starts as bodies do."""
    press: Callable[[Force], Press | None] | None = None
    """Function that presses its surfaces together at the start, where its ``ideal`` joint holds; else None."""
    along: Callable[[Force], Element] | None = None
    """The one element along which its interaction acts, without terms, if it acts along one."""
    chamber: Callable[[Force, Masses], Chamber] | None = None
    """The gas behind a piston that its effort comes from, if it does."""
    states: States | None = None
    """States that it carries through a motion beside coordinates and velocities; it then acts ``along`` a line."""
    valved: Valved | None = None
    """The chambers and the valve of a double-acting cylinder, if it is one."""
    oil: Callable[[Force], OilCylinder] | None = None
    """The cylinder of oil that its effort and its states come from, if they do."""
    outside: bool = False
    """True if it is a load from outside, to which nothing in the mechanism feels the opposite."""
    of_reactions: bool = False
    """True if it is friction, which comes from the reaction of a joint; see mbsd/equations/joint_friction.py."""
    of_spans: bool = False
    """True if it is friction under a cable, which comes from the pulls of the spans ``before`` and ``after``."""
    on_bodies: bool = False
    """True if it acts on bodies as a whole, and its markers are no places."""
    look: str = ""
    """Its look in pictures of solids: one of ``LOOKS`` in mbsd/model/joint.py."""
    motor: str = ""
    """The law by which it drives a mechanism as a motor does, if it has such a law."""
    sign: str = ""
    """Its sign in drawings, if not that of its first element: see mbsd/drawing/symbols/loads.py."""
    saved: bool = True
    """True if a file can hold its params; a Python function cannot be saved."""
    also: Mapping[str, str] = field(default_factory=dict)
    """Arguments of other methods that add one, by the names they have in ``add``: change() takes them as well."""
    add: Callable[..., Any] | None = field(default=None, init=False, compare=False)
    """The function ``add(m, name, ...)`` that adds one of this kind, with its arguments checked; see :meth:`adds`."""

    def adds(self, function: F) -> F:
        """Decorator of that function: it is what change(), a saved file and the schema go by."""
        made = adding(function)
        object.__setattr__(self, "add", made)
        return made

    def drives(self, force: Force) -> bool:
        """Return True if it may move a mechanism in place of drivers: a given torque or push, or a motor."""
        return bool(self.effort) or self.motor in force.laws

    def places(self, force: Force) -> tuple[Marker, ...]:
        """Its markers at which it acts, not those that give a direction or a body alone."""
        turning = [element.kind == TURN for element in self.elements(force)]
        return (force.j,) if self.outside or (turning and all(turning)) else (force.i, force.j)


FORCE_KINDS: dict[str, ForceKind] = {}


def register_force(kind: ForceKind) -> ForceKind:
    """Register a kind; raises ValueError if the name is taken, the example missing, states too many."""
    if not callable(kind.example):
        raise ValueError(f"{kind.name}: an example is missing; the registry test needs one")
    check_look(kind.name, kind.look)
    if kind.states is not None and (kind.along is None or not 0 < len(kind.states.names) <= MOST_STATES):
        raise ValueError(f"{kind.name}: a force with states acts along one element, and has {MOST_STATES} at most")
    if kind.name in FORCE_KINDS:
        raise ValueError(f"{kind.name}: registered twice")
    FORCE_KINDS[kind.name] = kind
    return kind


@dataclass(frozen=True, eq=False)
class Force(Suggesting, WithFunctions):
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


@dataclass(frozen=True)
class Chamber:
    """Volume is area (x + shift), pressure effort / area + outside; x: what the force measures."""

    area: float
    """m^2"""
    shift: float
    """m"""
    outside: float
    """Pa"""
    cycle: CrankCycle | None = None


@dataclass(frozen=True)
class CrankCycle:
    """How the pressure repeats with a crank."""

    crank: str
    """Name of the body."""
    fires_at: float
    """Its angle against the cylinder's body (rad)."""
    sense: float
    """-1: it turns clockwise."""
    period: float
    """rad"""
    displaced: float
    """m^3"""
    changes: tuple[float, ...]
    """Angles after the firing at which one phase follows another (rad)."""
    height: Callable[[np.ndarray], np.ndarray] | None
    """Height of the gas (m) at angles after the firing, by crank and rod; None where the pressure needs none."""
    burns: bool
    """True if heat is released at these heights."""


def marker_place(marker: Marker, masses: Masses, q: np.ndarray) -> np.ndarray:
    """(T, 2) of a marker (m) at poses q (T, 3 nb)."""
    b = list(masses.names).index(marker.body.name)
    x, y = marker.x - masses.com[b, 0], marker.y - masses.com[b, 1]
    c, s = np.cos(q[:, 3 * b + 2]), np.sin(q[:, 3 * b + 2])
    return q[:, 3 * b : 3 * b + 2] + np.stack([c * x - s * y, s * x + c * y], axis=1)
