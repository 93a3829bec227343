"""Bodies and the markers fixed to them. SI units; angles in radians."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Protocol

from mbsd.base.arguments import finite_number, number_pair
from mbsd.base.errors import ModelError

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


@dataclass(frozen=True, eq=False)
class Marker:
    """A frame fixed to a body: ``x``, ``y`` (m) and ``angle`` (rad) in the body's frame."""

    body: Body
    x: float
    y: float
    angle: float = 0.0


@dataclass(eq=False)
class Body:
    """A rigid body with the frame its author chose. Ground is body 0 and never moves.

    mass (kg), com (m, body frame), inertia about the centre of mass (kg m^2). They may be set at any time: the next
    solution has them. ``owner`` is the mechanism's name, for errors.
    """

    name: str
    owner: str = ""
    mass: float = 0.0
    com: tuple[float, float] = (0.0, 0.0)
    inertia: float = 0.0
    length: float | None = None
    """Of a bar (m); None for other bodies."""
    mass_given: bool = False
    """Whether its mass was given when it was added; one of 0 makes it massless on purpose."""

    def __setattr__(self, name: str, value: object) -> None:
        super().__setattr__(name, self._checked(name, value))

    def _checked(self, name: str, value: object) -> object:
        """What may be set. Raises ModelError for what no body has."""
        what = f"{self.owner}: {name} of body '{self.name}'" if name in ("mass", "inertia", "com") else name
        if name == "com":
            return number_pair(f"{what} (m)", value)
        if name in ("mass", "inertia"):
            number, unit = finite_number(what, value), "kg" if name == "mass" else "kg m^2"
            if number < 0:
                raise ModelError(
                    f"{self.owner}: body '{self.name}' has {name} {number:g} {unit}; it cannot be negative"
                )
            return number
        if name in ("name", "owner", "length") and self.__dict__.get(name) not in (None, value):
            raise ModelError(f"{self.owner}: {name} of body '{self.name}' is fixed; add another body")
        return value

    def at(self, x: float, y: float, angle: float = 0.0) -> Marker:
        """The marker at (x, y) in this body's frame (m), its x axis turned by ``angle`` (rad)."""
        what = f"{self.owner}: {self.name}.at"
        place = (("x", x), ("y", y), ("angle", angle))
        return Marker(self, *(finite_number(f"{what}: {name}", value) for name, value in place))

    def at_world(self, x: float, y: float, angle: float = 0.0) -> Marker:
        """The marker that is at (x, y) in the world at the start (m), its x axis turned by ``angle`` there (rad).

        The start is that of the model as it is now, at time 0: links closed, what start_near gives held; on ground it
        is ``at``. From then on the marker is fixed to the body, whatever is changed. Raises ModelError where joints,
        drivers and start_near do not tell where the body is, AssemblyError where the links do not close.
        """
        what = f"{self.owner}: {self.name}.at_world"
        place = (("x", x), ("y", y), ("angle", angle))
        numbers = [finite_number(f"{what}: {name}", value) for name, value in place]
        if self.mechanism is None:
            raise ModelError(f"{what}: '{self.name}' belongs to no mechanism; use m.body(...)")
        return self.mechanism.marker_in_world(self, *numbers)

    def belong(self, mechanism: Owner) -> None:
        """Let this be a body of ``mechanism``."""
        self.__dict__["_mechanism"] = mechanism

    @property
    def mechanism(self) -> Owner | None:
        """That this body was made for."""
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
