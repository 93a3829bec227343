"""Bodies in space with their pose in the design, and the markers fixed to them. SI units."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from types import MappingProxyType

import numpy as np

from mbsd.base.arguments import CHECKS, SMALLEST, not_negative_number, number_array, several_numbers
from mbsd.base.errors import ModelError
from mbsd.base.names import Suggesting, shown
from mbsd.spatial.model.rotation import PARALLEL, angle_between, euler_parameters, frame, rotation_matrix

Place = Sequence[float] | np.ndarray
"""Three numbers (m)."""
Direction = Sequence[float] | np.ndarray
"""Three numbers of any length but 0."""
Orientation = Sequence[float] | np.ndarray
"""Euler parameters (w, x, y, z) of any length but 0, from body to world."""
SHORTEST = 1e-12
"""Length below which a direction or an orientation has none."""
UNEQUAL = 1e-9
"""Part of the largest moment of inertia by which the largest may exceed the sum of the others."""


@dataclass(frozen=True, eq=False)
class Marker(Suggesting):
    """A frame fixed to a body: a place and an axis with an x axis across it, in the body's frame."""

    body: Body
    place: tuple[float, float, float]
    """(m)"""
    axis: tuple[float, float, float]
    """Unit vector along the marker's z axis."""
    across: tuple[float, float, float]
    """Unit vector along the marker's x axis."""

    @cached_property
    def axes(self) -> np.ndarray:
        """Axes x, y, z by column (3, 3), in the body's frame."""
        x, z = np.array(self.across), np.array(self.axis)
        return np.column_stack([x, np.cross(z, x), z])

    @property
    def world_place(self) -> np.ndarray:
        """Place (3,) in the world in the design pose (m)."""
        return self.body.rotation @ np.array(self.place) + np.array(self.body.place)

    def __repr__(self) -> str:
        return f"<Marker ({', '.join(f'{x:g}' for x in self.place)}) on {self.body.name}>"


@dataclass(frozen=True)
class Shape:
    """The round solid that a body was added as: pictures and parts show it."""

    kind: str
    """rod, disc or ball."""
    radius: float
    """m; 0 of a slender rod."""
    length: float = 0.0
    """Along the x axis of the body's frame (m): from its origin on of a rod, about it of a disc."""


@dataclass(frozen=True, eq=False)
class Body(Suggesting):
    """A rigid body and the pose of its frame in the design. Ground is body 0 and never moves."""

    other_words = MappingProxyType(
        {"center": "com", "centre": "com", "centre_of_mass": "com", "position": "place", "quaternion": "orientation"}
        | {"moment_of_inertia": "inertia", "at": "marker", "point": "marker"}
    )

    name: str
    owner: str = ""
    mass: float = 0.0
    com: tuple[float, float, float] = (0.0, 0.0, 0.0)
    """Centre of mass in the body's frame (m)."""
    inertia: tuple[tuple[float, float, float], ...] = ((0.0, 0.0, 0.0),) * 3
    """(3, 3) about the centre of mass, in the axes of the body (kg m^2)."""
    place: tuple[float, float, float] = (0.0, 0.0, 0.0)
    """Origin of the frame in the world, in the design pose (m)."""
    orientation: tuple[float, float, float, float] = (1.0, 0.0, 0.0, 0.0)
    """Euler parameters (w, x, y, z) of the frame in the design pose, from body to world."""
    shape: Shape | None = None

    @cached_property
    def rotation(self) -> np.ndarray:
        """Rotation (3, 3) of the frame in the design pose, from body to world."""
        return rotation_matrix(self.orientation)

    @cached_property
    def principal(self) -> tuple[np.ndarray, np.ndarray]:
        """Principal moments (3,) about the centre of mass (kg m^2) and their axes (3, 3) by column."""
        inertia = np.array(self.inertia)
        if not (inertia - np.diag(np.diag(inertia))).any():
            return np.diag(inertia).copy(), np.eye(3)
        moments, axes = np.linalg.eigh(inertia)
        axes[:, 2] = np.cross(axes[:, 0], axes[:, 1])
        return moments, axes

    def weigh(
        self, mass: float, com: tuple[float, float, float], inertia: tuple[tuple[float, float, float], ...]
    ) -> None:
        """Set the numbers of the body's mass, which solids tell after it was added; its frame stays."""
        for name, value in (("mass", mass), ("com", com), ("inertia", inertia)):
            object.__setattr__(self, name, value)
        self.__dict__.pop("principal", None)

    def marker(self, place: Place, axis: Direction = (0.0, 0.0, 1.0), across: Direction | None = None) -> Marker:
        """Return the frame at ``place`` on this body (m), z along ``axis``, x near ``across``."""
        what = f"{self.owner}: {self.name}.marker"
        given = place_given(f"{what}: place", place)
        along = direction_given(f"{what}: axis", axis)
        x = None if across is None else direction_given(f"{what}: across", across)
        if x is not None:
            refuse_parallel(what, "axis", along, "across", x)
        axes = frame(np.array(along), None if x is None else np.array(x))
        return Marker(self, given, along, tuple(axes[:, 0].tolist()))

    def world_marker(self, place: np.ndarray, axes: np.ndarray) -> Marker:
        """Return the frame at a place (3,) of the world in the design pose (m), with axes (3, 3) of the world."""
        own = self.rotation.T @ axes
        local = self.rotation.T @ (place - np.array(self.place))
        return Marker(self, tuple(local.tolist()), tuple(own[:, 2].tolist()), tuple(own[:, 0].tolist()))

    @property
    def origin(self) -> Marker:
        """The body's own frame."""
        return self.marker((0.0, 0.0, 0.0), (0.0, 0.0, 1.0), (1.0, 0.0, 0.0))

    def __repr__(self) -> str:
        return f"<Body {self.name}: {self.mass:g} kg>"


def place_given(what: str, value: object) -> tuple[float, float, float]:
    """Return three finite numbers; raises ModelError."""
    x, y, z = several_numbers(what, value, 3, "it must be three numbers (x, y, z)")
    return x, y, z


def direction_given(what: str, value: object) -> tuple[float, float, float]:
    """Return a unit vector; raises ModelError for what has no length."""
    x, y, z = place_given(what, value)
    length = math.sqrt(x * x + y * y + z * z)
    if length < SHORTEST:
        raise ModelError(f"{what} is ({x:g}, {y:g}, {z:g}); a direction needs a length above zero, such as (0, 0, 1)")
    return x / length, y / length, z / length


def orientation_given(what: str, value: object) -> tuple[float, float, float, float]:
    """Return unit Euler parameters; raises ModelError for what has no length."""
    e = several_numbers(what, value, 4, "it must be four numbers (w, x, y, z)")
    length = math.sqrt(sum(part * part for part in e))
    if length < SHORTEST:
        raise ModelError(f"{what} is a quaternion of length 0; give (w, x, y, z), such as (1, 0, 0, 0) for no rotation")
    w, x, y, z = (part / length for part in e)
    return w, x, y, z


def refuse_parallel(what: str, first: str, a: Direction, second: str, b: Direction) -> None:
    """Raise ModelError where two directions are parallel."""
    angle = angle_between(np.array(a), np.array(b))
    if math.sin(angle) < PARALLEL:
        raise ModelError(f"{what}: {first} and {second} are parallel; give {second} across {first}")


def refuse_not_perpendicular(what: str, first: str, a: Direction, second: str, b: Direction, remedy: str) -> None:
    """Raise ModelError with the angle where two directions are not perpendicular."""
    angle = math.degrees(angle_between(np.array(a), np.array(b)))
    if abs(angle - 90.0) > 1e-6:
        raise ModelError(f"{what}: {first} and {second} are at {angle:.6g} degrees; they must be at 90. {remedy}")


def inertia_given(what: str, value: object) -> tuple[tuple[float, float, float], ...]:
    """Return inertia (3, 3) from three or six numbers or a matrix. Raises ModelError."""
    given = number_array(what, value)
    if given.shape == (3,):
        matrix = np.diag(given)
    elif given.shape == (6,):
        xx, yy, zz, xy, xz, yz = given.tolist()
        matrix = np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
    elif given.shape == (3, 3) and np.allclose(given, given.T, rtol=1e-9, atol=0.0):
        matrix = 0.5 * (given + given.T)
    else:
        raise ModelError(
            f"{what} is {shown(value)}; give (Ixx, Iyy, Izz), these with (Ixy, Ixz, Iyz), or a symmetric 3 x 3 matrix"
        )
    moments = np.linalg.eigvalsh(matrix)
    largest = float(np.abs(moments).max())
    if moments[0] < -UNEQUAL * largest:
        raise ModelError(f"{what} has a principal moment of {moments[0]:.6g} kg m^2; none can be negative")
    if 0.0 < largest < SMALLEST:
        raise ModelError(f"{what} has moments up to {largest:g} kg m^2; give 0, or {SMALLEST:g} kg m^2 or more")
    if moments[2] > (moments[0] + moments[1]) + UNEQUAL * largest:
        raise ModelError(
            f"{what} has principal moments {moments[0]:.6g}, {moments[1]:.6g} and {moments[2]:.6g} kg m^2; of a rigid "
            "body none exceeds the sum of the others. Look at units, and at signs of products"
        )
    return tuple((float(a), float(b), float(c)) for a, b, c in matrix)


def mass_given(what: str, value: object) -> float:
    """Return a mass of 0 or more (kg); raises ModelError."""
    mass = not_negative_number(what, value, "kg")
    if 0.0 < mass < SMALLEST:
        raise ModelError(f"{what} is {mass:g} kg; give 0, or {SMALLEST:g} kg or more")
    return mass


Fixing = Body | Marker | str
"""A body, its name, or a marker on it."""

CHECKS.update({"Place": place_given, "Direction": direction_given, "Orientation": orientation_given})


def cylinder(mass: float, radius: float, length: float) -> tuple[float, float, float]:
    """Return the moments of a solid cylinder: a rod at radius 0, a thin disc at length 0."""
    cross = mass * (3.0 * radius**2 + length**2) / 12.0
    return 0.5 * mass * radius**2, cross, cross


def cylinder_mass(density: float, radius: float, length: float) -> float:
    """Return the mass of a solid cylinder (kg)."""
    return density * math.pi * radius**2 * length


def ball(mass: float, radius: float) -> tuple[float, float, float]:
    """Return the moments of a solid ball."""
    moment = 0.4 * mass * radius**2
    return moment, moment, moment


def along_x(axis: np.ndarray) -> tuple[float, ...]:
    """Return Euler parameters of a frame whose x axis is the unit ``axis`` (3,)."""
    axes = frame(axis)
    return tuple(euler_parameters(np.column_stack([axis, axes[:, 0], axes[:, 1]])).tolist())
