"""Bodies and the markers fixed to them. SI units; angles in radians.

The motion is planar. A place ``z`` along the normal of the plane, towards the viewer (m), moves nothing; it decides the
couples Mx and My that the frame feels, and the layers of the parts.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from types import MappingProxyType
from typing import Any, ClassVar, Protocol

from mbsd.base.arguments import CHECKS, SMALLEST, finite_number, number_pair
from mbsd.base.errors import ModelError
from mbsd.base.names import Suggesting, shown
from mbsd.base.pickled import with_copied_fields

__all__ = ["Body", "Marker", "finite_number", "number_pair"]


class Owner(Protocol):
    """The mechanism of a body, as far as the body knows it."""

    name: str

    @property
    def bodies(self) -> Mapping[str, Body]:
        """By name."""
        ...

    def marker_in_world(self, body: Body, x: float, y: float, angle: float) -> Marker:
        """See :meth:`Body.at_world`."""
        ...


HIDDEN = "hidden"
"""Look of a body that has no parts and is not drawn, such as those that ratios and elastic cables add."""


@dataclass(frozen=True, eq=False)
class Marker(Suggesting):
    """A frame fixed to a body: ``x``, ``y`` (m) and ``angle`` (rad) in the body's frame."""

    body: Body
    x: float
    y: float
    angle: float = 0.0
    z: float | None = None
    """Place along the normal of the plane (m); None: that of its body."""

    def __deepcopy__(self, memo: dict[int, Any]) -> Marker:
        return with_copied_fields(self, memo)

    @property
    def plane(self) -> float | None:
        """Position along the normal of the plane (m): its own, else its body's; None if neither is given."""
        return self.body.z if self.z is None else self.z

    def __repr__(self) -> str:
        turned = f", {self.angle:g} rad" if self.angle else ""
        along = f", z {self.z:g}" if self.z is not None else ""
        return f"<Marker ({self.x:g}, {self.y:g}){turned}{along} on {self.body.name}>"


def rod_inertia(mass: float, length: float) -> float:
    """Inertia of a uniform slender rod about its middle (kg m^2)."""
    return mass * length**2 / 12


def at_end(marker: Marker, length: float | None) -> bool:
    """Return True for a marker at the end of its bar of this length (m).

    A body without a length has no end.
    """
    return length is not None and marker.x == length and marker.y == 0.0


@dataclass(eq=False)
class Body(Suggesting):
    """A rigid body with the frame its author chose. Ground is body 0 and never moves.

    mass (kg), com (m, body frame), inertia about the centre of mass (kg m^2). They may be set at any time: the next
    solution has them; so may ``z`` and ``products``. ``owner`` is the mechanism's name, for errors.
    """

    other_words: ClassVar[Mapping[str, str]] = MappingProxyType(
        {"center": "com", "centre": "com", "centre_of_mass": "com", "center_of_mass": "com", "weight": "mass"}
        | {"moment_of_inertia": "inertia", "marker": "at", "point": "at"}
    )

    name: str
    owner: str = ""
    mass: float = 0.0
    com: tuple[float, float] = (0.0, 0.0)
    inertia: float = 0.0
    length: float | None = None
    """Length of a bar (m); None for other bodies."""
    mass_given: bool = False
    """True if its mass was given when it was added; one of 0 makes it massless on purpose."""
    derived: frozenset[str] = frozenset()
    """Names of a bar's ``com`` and ``inertia`` if they follow from its length and mass, as of a uniform slender rod.
    They follow every mass that is set; setting them ends that.
    """
    z: float | None = None
    """Place of its centre of mass along the normal of the plane (m); None: not given, and 0 where it counts."""
    looks: str = ""
    """Look of its automatic parts, such as "piston", which no equation knows. Empty: what its name says. HIDDEN: it has
    no parts and is not drawn."""
    products: tuple[float, float] = (0.0, 0.0)
    """Products of inertia, integrals of x z dm and y z dm about the centre of mass in the body frame (kg m^2). They are
    those of a body that reaches along the normal, such as a crankshaft; 0 of one that is alike on both sides of z."""

    def __deepcopy__(self, memo: dict[int, Any]) -> Body:
        return with_copied_fields(self, memo)

    def __setattr__(self, name: str, value: object) -> None:
        super().__setattr__(name, self._checked(name, value))
        derived = self.__dict__.get("derived", ())
        if name in derived:
            self.__dict__["derived"] = frozenset(derived) - {name}
        elif name == "mass" and "inertia" in derived and self.length is not None:
            self.__dict__["inertia"] = rod_inertia(self.mass, self.length)

    def _checked(self, name: str, value: object) -> object:
        """Return the numbers that may be set. Raises ModelError for what no body has."""
        what = f"{self.owner}: {name} of body '{self.name}'" if name in ("mass", "inertia", "com") else name
        if name == "com":
            return number_pair(f"{what} (m)", value)
        if name == "products":
            return number_pair(f"{self.owner}: products of inertia of body '{self.name}' (kg m^2)", value)
        if name == "looks" and not isinstance(value, str):
            raise ModelError(
                f"{self.owner}: looks of body '{self.name}' is {shown(value)}; write a word: looks='piston'"
            )
        if name == "z" and value is not None:
            return finite_number(f"{self.owner}: z of body '{self.name}' (m)", value)
        if name in ("mass", "inertia"):
            number, unit = finite_number(what, value), "kg" if name == "mass" else "kg m^2"
            if number < 0:
                raise ModelError(
                    f"{self.owner}: body '{self.name}' has {name} {number:g} {unit}; it cannot be negative"
                )
            if 0.0 < number < SMALLEST:
                raise ModelError(
                    f"{self.owner}: body '{self.name}' has {name} {number:g} {unit}; give 0, or {SMALLEST:g} {unit} or "
                    "more: products of smaller numbers cannot be represented"
                )
            return number
        if name in ("name", "owner", "length") and self.__dict__.get(name) not in (None, value):
            raise ModelError(f"{self.owner}: {name} of body '{self.name}' is fixed; add another body")
        return value

    def at(self, x: float, y: float, angle: float = 0.0, z: float | None = None) -> Marker:
        """The marker at (x, y) in this body's frame (m), its x axis turned by ``angle`` (rad).

        ``z``: where it lies along the normal of the plane (m), if not in the body's own place.
        """
        return Marker(self, *self._place("at", x, y, angle), z=self._along("at", z))

    def at_world(self, x: float, y: float, angle: float = 0.0, z: float | None = None) -> Marker:
        """Return the marker at (x, y) in the world at the start (m), its x axis turned by ``angle`` (rad).

        The start is that of the model as it is now, at time 0: links closed, what start_near gives held; on ground it
        is ``at``. From then on the marker is fixed to the body, whatever is changed. ``z`` is that of ``at``. Raises
        ModelError where joints, drivers and start_near do not tell where the body is, AssemblyError where the links do
        not close.
        """
        numbers, along = self._place("at_world", x, y, angle), self._along("at_world", z)
        if self.mechanism is None:
            what = f"{self.owner}: {self.name}.at_world"
            raise ModelError(f"{what}: '{self.name}' belongs to no mechanism; use m.body(...)")
        marker = self.mechanism.marker_in_world(self, *numbers)
        return marker if along is None else replace(marker, z=along)

    def _place(self, method: str, *numbers: float) -> list[float]:
        what = f"{self.owner}: {self.name}.{method}"
        return [finite_number(f"{what}: {key}", value) for key, value in zip(("x", "y", "angle"), numbers, strict=True)]

    def _along(self, method: str, z: float | None) -> float | None:
        return None if z is None else finite_number(f"{self.owner}: {self.name}.{method}: z", z)

    def copy_properties(self, other: Body) -> None:
        """Have the mass properties and the length of another body, given and derived ones, from now on."""
        for key in ("mass", "com", "inertia", "length", "mass_given", "derived", "z", "products", "looks"):
            self.__dict__[key] = getattr(other, key)

    def belong(self, mechanism: Owner) -> None:
        """Let this be a body of ``mechanism``."""
        self.__dict__["_mechanism"] = mechanism

    @property
    def mechanism(self) -> Owner | None:
        """The mechanism of this body."""
        return self.__dict__.get("_mechanism")

    @property
    def origin(self) -> Marker:
        """The body's own frame."""
        return self.at(0.0, 0.0)

    @property
    def start(self) -> Marker:
        """A bar's first end: its frame's origin."""
        self._bar_length("start")
        return self.at(0.0, 0.0)

    @property
    def end(self) -> Marker:
        """A bar's second end, at (length, 0)."""
        return self.at(self._bar_length("end"), 0.0)

    def _bar_length(self, what: str) -> float:
        if self.length is None:
            raise ModelError(f"{self.name}.{what}: '{self.name}' is no bar; use {self.name}.at(x, y)")
        return self.length

    def __repr__(self) -> str:
        return f"<Body {self.name}: {self.mass:g} kg>"


def marker_given(what: str, value: object) -> Marker:
    """``value``, which must be a marker. Raises ModelError."""
    if isinstance(value, Marker):
        return value
    if not isinstance(value, Body):
        raise ModelError(
            f"{what} is {shown(value)}; it must be a marker, a place on a body: write body.at(x, y), bar.start or "
            "bar.end"
        )
    places = f"{value.name}.at(x, y)"
    if value.length is not None:
        places += f", {value.name}.start or {value.name}.end"
    raise ModelError(f"{what} is the body '{value.name}'; it must be a marker, a place on it: write {places}")


def body_given(what: str, value: object) -> Body | str:
    """``value``, which must be a body or the name of one. Raises ModelError."""
    if isinstance(value, Body | str):
        return value
    if isinstance(value, Marker):
        raise ModelError(
            f"{what} is a marker on '{value.body.name}'; it must be a body: write {value.body.name}, without at(...), "
            "start or end"
        )
    raise ModelError(
        f"{what} is {shown(value)}; it must be a body: m.ground, what m.body(...) or m.bar(...) returned, or its name"
    )


CHECKS.update({"Marker": marker_given, "Body | str": body_given})
