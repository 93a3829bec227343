"""Model of a mechanism: named bodies, joints, drivers, traces and rough starts, with shared checks."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import partial
from types import MappingProxyType
from typing import Any

from mbsd.base.arguments import finite_number, number_pair
from mbsd.base.errors import ModelError
from mbsd.base.names import Named, Suggesting, names_in, no_such, shown
from mbsd.base.pickled import with_copied_fields
from mbsd.model.body import HIDDEN, Body, Marker, rod_inertia
from mbsd.model.event import Event
from mbsd.model.force import Force
from mbsd.model.joint import Joint

STANDARD_GRAVITY = (0.0, -9.80665)
"""m/s^2, ISO 80000-3."""


@dataclass(frozen=True)
class Start:
    """Rough pose of a body at the start: angle (rad) and, if given, place of its frame (m)."""

    angle: float
    place: tuple[float, float] | None = None


@dataclass(frozen=True)
class StartVelocity:
    """Given velocity of a body at the start: rad/s and, if given, m/s of its frame."""

    omega: float
    place: tuple[float, float] | None = None


@dataclass(eq=False)
class Model(Suggesting):
    """Model of a mechanism, and checks for all its methods. See :class:`mbsd.mechanism.Mechanism`."""

    name: str
    gravity: tuple[float, float] | None = STANDARD_GRAVITY
    bodies: dict[str, Body] = field(default_factory=partial(Named, "body"))
    joints: dict[str, Joint] = field(default_factory=partial(Named, "joint"))
    drivers: dict[str, Joint] = field(default_factory=partial(Named, "driver"))
    forces: dict[str, Force] = field(default_factory=partial(Named, "force"))
    contacts: dict[str, Joint] = field(default_factory=partial(Named, "contact"))
    events: dict[str, Event] = field(default_factory=partial(Named, "event"))
    outlines: dict[str, Any] = field(default_factory=partial(Named, "outline"))
    """Outlines of bodies by name; see mbsd/model/outlines.py."""
    traces: dict[str, Marker] = field(default_factory=partial(Named, "traced point"))
    starts: dict[str, Start] = field(default_factory=dict)
    velocities: dict[str, StartVelocity] = field(default_factory=dict)

    other_words = MappingProxyType(
        {
            "pin": "revolute",
            "hinge": "revolute",
            "pivot": "revolute",
            "slider": "prismatic",
            "slide": "prismatic",
            "link": "bar",
            "rod": "bar",
            "fix": "weld",
            "fixed": "weld",
            "gear": "gear_pair",
            "gears": "gear_pair",
            "cam": "cam_roller",
            "rack": "rack_and_pinion",
            "wheel": "rolling_disc",
            "damper": "spring",
            "pulley": "cable",
            "winch": "cable",
            "solve": "sweep",
            "plot": "draw",
        }
    )

    findings_told = False
    """True if suspicious units were reported; see mbsd/analyses/suspicious_units.py."""

    def __post_init__(self) -> None:
        new_name(self, self.name, "mechanism")
        self.bodies["ground"] = Body("ground", self.name)
        self.ground.belong(self)
        self.world_markers: tuple[tuple[Marker, tuple[float, float, float]], ...] = ()
        """Markers that at_world placed, and where in the world (m, m, rad)."""

    def __deepcopy__(self, memo: dict[int, Any]) -> Any:
        return with_copied_fields(self, memo)

    def __setattr__(self, name: str, value: object) -> None:
        if name == "name" and not isinstance(value, str):
            raise ModelError(f"a mechanism needs a name, got {shown(value)}")
        if name == "gravity":
            value = number_pair(f"{self.name}: gravity (m/s^2)", (0.0, 0.0) if value is None else value)
        super().__setattr__(name, value)

    # -- bodies -------------------------------------------------------------------------------------------------

    @property
    def ground(self) -> Body:
        """The frame that does not move."""
        return self.bodies["ground"]

    def body(
        self,
        name: str,
        mass: float | None = None,
        com: Sequence[float] = (0.0, 0.0),
        inertia: float = 0.0,
        *,
        z: float | None = None,
        products: Sequence[float] = (0.0, 0.0),
        looks: str = "",
    ) -> Body:
        """Add a body. Without a mass it has none here; in a mechanism's folder it then gets that of its parts.

        mass (kg) at ``com`` (m, in the body's frame), ``inertia`` about it (kg m^2). With inertia 0, the default, it is
        a point mass: turning it about its centre of mass takes no moment. Simulations then need joints that turn it
        only together with mass, as a pin beside its centre of mass does, or nothing that acts on its turning; a
        contact, spring or torque that turns it alone raises MobilityError. Sweeps and statics need none.

        ``z``: place of its centre of mass along the normal of the plane, towards the viewer (m). It moves nothing; the
        couples of ``sol.shaking()`` and the layers of the parts follow it. ``products``: integrals of x z dm and y z dm
        about the centre of mass, in the body frame (kg m^2), of a body that reaches along the normal. ``looks``: what
        its automatic parts look like, such as "piston" or "flywheel"; by default what its name says; "hidden": it has
        none and is not drawn. Raises ModelError on a name already used or an impossible mass.
        """
        return self._with(name, new_body, mass, com, inertia, z=z, products=products, looks=looks)

    def bar(
        self,
        name: str,
        length: float,
        mass: float | None = None,
        com: Sequence[float] | None = None,
        inertia: float | None = None,
        *,
        z: float | None = None,
        products: Sequence[float] = (0.0, 0.0),
        looks: str = "",
    ) -> Body:
        """Add a bar from ``start`` (0, 0) to ``end`` (length, 0).

        With a mass and nothing else it is a uniform slender rod: com at the middle, inertia m l^2 / 12, also after its
        mass or length changes; ``inertia=0`` makes it a point mass at ``com``. ``z``, ``products`` and
        ``looks`` are those of :meth:`body`.
        """
        return self._with(name, new_bar, length, mass, com, inertia, z=z, products=products, looks=looks)

    def _with(self, name: str, make: Callable[..., Body], *given: Any, **named: Any) -> Body:
        """A body that is made, once its name is known to be new."""
        new_name(self, name, "body", self.bodies)
        body = self.bodies[name] = make(self, name, *given, **named)
        body.belong(self)
        return body

    def set_mass(
        self,
        name: Body | str,
        mass: float,
        com: Sequence[float],
        inertia: float,
        z: float | None = None,
        products: Sequence[float] | None = None,
    ) -> None:
        """Set mass (kg), centre of mass (m, body frame) and inertia about it (kg m^2), as from CAD.

        ``z`` (m) and ``products`` (kg m^2) are those of :meth:`body`; what is None stays as it is.
        """
        body = self.known_body(name)
        checked: Any = com, body.products if products is None else products
        along = body.z if z is None else z
        wanted = Body(body.name, self.name, mass, checked[0], inertia, z=along, products=checked[1])
        body.mass, body.com, body.inertia = wanted.mass, wanted.com, wanted.inertia
        body.z, body.products = wanted.z, wanted.products

    def known_body(self, name: Body | str) -> Body:
        """The body of this name, or that one itself; raises ModelError with the known names."""
        name = name_of(name)
        if not isinstance(name, str) or name not in self.bodies:
            raise ModelError(f"{self.name}: {no_such('body', name, self.bodies)}")
        return self.bodies[name]

    def marker_in_world(self, body: Body, x: float, y: float, angle: float) -> Marker:
        """See :meth:`mbsd.model.body.Body.at_world`; it takes the equations, which a Mechanism knows."""
        raise ModelError(f"{self.name}: {body.name}.at_world needs a Mechanism")


def new_body(
    m: Model, name: str, mass: float | None = None, com: Sequence[float] = (0.0, 0.0), inertia: float = 0.0, *,
    z: float | None = None, products: Sequence[float] = (0.0, 0.0), looks: str = "",
) -> Body:  # fmt: skip
    """A body as :meth:`Model.body` adds it, which belongs to no mechanism yet; ``m`` is named in errors."""
    checked: Any = com, products  # a body turns any two numbers into a pair
    body = Body(name, m.name, 0.0 if mass is None else mass, checked[0], inertia, z=z, products=checked[1], looks=looks)
    body.mass_given = mass is not None
    return body


def new_bar(
    m: Model, name: str, length: float, mass: float | None = None, com: Sequence[float] | None = None,
    inertia: float | None = None, *, z: float | None = None, products: Sequence[float] = (0.0, 0.0),
    looks: str = "",
) -> Body:  # fmt: skip
    """A bar as :meth:`Model.bar` adds it, likewise."""
    length = length_given(m, f"bar '{name}' has length", length)
    derived = frozenset(key for key, value in (("com", com), ("inertia", inertia)) if value is None)
    com = (length / 2, 0.0) if com is None else com
    mass = None if mass is None else number_given(m, f"mass of body '{name}'", mass)
    inertia = rod_inertia(mass or 0.0, length) if inertia is None else inertia
    body = new_body(m, name, mass, com, inertia, z=z, products=products, looks=looks)
    body.length, body.derived = length, derived
    return body


SHORTEST = 1e-12
"""Distance (m) below which two places count as one; see mbsd/arrays/packing.py."""


def connections(m: Model) -> tuple[Mapping[str, object], ...]:
    """Entries that share one set of names: all that connect two bodies."""
    return m.joints, m.drivers, m.forces, m.contacts


def hidden_bodies(m: Model) -> set[str]:
    """Return the names of the bodies that have no parts and are not drawn."""
    return {body.name for body in m.bodies.values() if body.looks == HIDDEN}


def own_body(m: Model, body: Body | str, what: str) -> Body:
    """Return a body of this mechanism, given as body or name; raises ModelError.

    ``what`` uses it.
    """
    if isinstance(body, str):
        if body not in m.bodies:
            raise ModelError(f"{m.name}: {what}: {no_such('body', body, m.bodies)}")
        return m.bodies[body]
    if not isinstance(body, Body):
        raise ModelError(f"{m.name}: {what} needs a body, got {shown(body)}")
    if m.bodies.get(body.name) is not body:
        raise ModelError(f"{m.name}: {what} uses body '{body.name}' of another mechanism; take one of this one")
    return body


def own_joint(m: Model, joint: Joint | str, what: str) -> Joint:
    """Return a joint of this mechanism, given as joint or name; raises ModelError.

    ``what`` uses it.

    A joint that :meth:`Mechanism.change` has replaced since counts as the one in its place.
    """
    if not isinstance(joint, Joint | str):
        raise ModelError(f"{m.name}: {what} needs a joint, got {shown(joint)}")
    known = m.joints.get(name_of(joint))
    if known is None:
        raise ModelError(f"{m.name}: {what}: {no_such('joint', name_of(joint), m.joints)}")
    if isinstance(joint, Joint) and (known.i.body is not joint.i.body or known.j.body is not joint.j.body):
        raise ModelError(f"{m.name}: {what} uses joint '{joint.name}' of another mechanism; take one of this one")
    return known


def name_of(thing: Any) -> Any:
    """Return the name of a body, joint, driver, force or contact; what is none of them as it is."""
    return thing.name if isinstance(thing, Body | Joint | Force) else thing


def names_given(what: str, value: Any) -> list[str]:
    """Return names of bodies, joints, drivers, forces or contacts, given as objects or names.

    One or a list is taken.

    Raises ModelError, which says ``what`` they are for.
    """
    return names_in(what, [name_of(part) for part in value] if isinstance(value, list | tuple) else name_of(value))


def new_name(m: Model, name: str, what: str, *taken: Mapping[str, object]) -> None:
    """Raise ModelError for a name that is none, or is already in one of the tables ``taken``."""
    if not isinstance(name, str) or not name or name != name.strip() or not name.isprintable():
        where = "" if what == "mechanism" else f"{m.name}: "
        raise ModelError(f"{where}a {what} needs a name without spaces around it, got {shown(name)}")
    if any(name in names for names in taken):
        raise ModelError(f"{m.name}: there are two of the name '{name}'; the {what} needs another")


def length_given(m: Model, what: str, value: object) -> float:
    """A length (m) that is above zero, and no smaller than what counts as a length."""
    length = number_given(m, what, value)
    if length <= 0:
        raise ModelError(f"{m.name}: {what} {length:g} m; it must be positive")
    if length < SHORTEST:
        raise ModelError(f"{m.name}: {what} {length:g} m; it must be {SHORTEST:g} m or more: lengths are in metres")
    return length


def number_given(m: Model, what: str, value: object) -> float:
    """A finite number; raises ModelError."""
    return finite_number(f"{m.name}: {what}", value)


MOST_DEGREES = 1e9
"""Angle beyond which the last digit is more than a ten-millionth of a degree, and soon a turn."""


def start_given(m: Model, name: str, degrees: float, place: tuple[float, float] | None = None) -> Start:
    """Return a rough pose. Raises ModelError for an angle too large to resolve a position within the turn."""
    if abs(degrees) > MOST_DEGREES:
        raise ModelError(
            f"{m.name}: start of '{name}' is {degrees:g} degrees, too large to resolve a position within the turn; "
            f"give {MOST_DEGREES:g} at most: subtract whole turns"
        )
    return Start(math.radians(degrees), place)


def two_bodies(m: Model, what: str, i: Marker, j: Marker, same_body: bool = False) -> None:
    """Raise ModelError unless i and j are markers of two bodies here; ``same_body`` allows one body."""
    for marker in (i, j):
        if not isinstance(marker, Marker):
            raise ModelError(
                f"{m.name}: {what} needs two markers, got {shown(marker)}; write body.at(x, y), bar.start or bar.end"
            )
        own_body(m, marker.body, what)
    if i.body is j.body and not same_body:
        raise ModelError(f"{m.name}: {what} connects '{i.body.name}' with itself; give markers of two bodies")


def not_negative(m: Model, what: str, **values: float) -> dict[str, float]:
    """Numbers by name that may not be negative; raises ModelError."""
    out = {key: number_given(m, f"{what}: {key}", value) for key, value in values.items()}
    for key, value in out.items():
        if value < 0:
            raise ModelError(f"{m.name}: {what}: {key} is {value:g}; it cannot be negative")
    return out
