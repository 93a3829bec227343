"""Forces, velocities and torques as vectors of a picture, and their scales."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import NamedTuple, Protocol

import numpy as np
from numpy.typing import NDArray

from render.film.poses import local_place
from shared.contract import BodyMotion, Motion
from shared.contract.geometry import felt
from shared.contract.shot import Quantity

# Quantities of straight arrows: forces, reactions, velocities, accelerations over the motion, each where it acts.

Array = NDArray[np.float64]
SAME = 1e-6
"""Fraction of the mechanism's size: places that stay closer than this are one, and stand still."""
UNITS = {"velocities": "m/s", "accelerations": "m/s²", "forces": "N", "reactions": "N"}


@dataclass(frozen=True)
class Acting:
    """A force or torque over the times of data.json, at a place."""

    quantity: Quantity
    name: str
    bodies: tuple[str, ...]
    """Between which, or on which it acts."""
    place: Array
    """(T, 2) where an arrow begins, about which an arc is drawn (m); (T, 3) in space."""


@dataclass(frozen=True)
class Vector(Acting):
    """One vector, world axes."""

    value: Array
    """(T, 2) in the unit of its quantity; (T, 3) in space."""
    weight: bool = False
    """True if it is the weight of a body, one of the forces."""

    @property
    def size(self) -> Array:
        """(T,)"""
        return np.hypot(*self.value.T) if self.value.shape[1] == 2 else np.linalg.norm(self.value, axis=1)

    def lifted(self, z: float) -> tuple[Array, Array]:
        """Return place and value (T, 3); one in the plane lies at the height ``z`` (m)."""
        return lifted(self.place, z), lifted(self.value, 0.0)

    @property
    def unit(self) -> str:
        """Unit of its value."""
        return UNITS[self.quantity]

    @property
    def row(self) -> str:
        """Name in the legend: weights have a row and a colour of their own."""
        return "weights" if self.weight else self.quantity


class Moves(NamedTuple):
    """A place that moves, (T, 2) each, world axes (SI)."""

    place: Array
    velocity: Array
    acceleration: Array


def vectors(motion: Motion, show: Sequence[Quantity]) -> list[Vector]:
    """Return all that ``show`` asks for, in the order of the file.

    Vectors that are nothing all the time are among them.
    """
    made = {"velocities": _movements, "accelerations": _movements, "forces": _forces, "reactions": _reactions}
    return [vector for quantity in show for vector in made[quantity](motion, quantity)]


def lifted(values: Array, z: float) -> Array:
    """Return rows (T, 3); those of the plane (T, 2) get ``z``."""
    return values if values.shape[1] == 3 else np.column_stack([values, np.full(len(values), z)])


def at_time(time: Array, values: Array, t: float) -> Array:
    """Return rows of ``values`` (T, n) at ``t``, linear between rows.

    Of rows that share a time the later counts.
    """
    t = min(max(t, float(time[0])), float(time[-1]))
    starts = np.flatnonzero(np.diff(time) > 0)
    i = starts[max(int(np.searchsorted(time[starts], t, side="right")) - 1, 0)]
    part = (t - time[i]) / (time[i + 1] - time[i])
    return (1 - part) * values[i] + part * values[i + 1]


def _reactions(motion: Motion, quantity: Quantity) -> Iterator[Vector]:
    """Yield the reactions of joints and rigid contacts on the body that moves."""
    for name, joint in (*motion.joints.items(), *motion.contacts.items()):
        on = felt(joint)
        yield Vector(quantity, name, joint.bodies, on.place, on.force)


def _forces(motion: Motion, quantity: Quantity) -> Iterator[Vector]:
    """Yield forces and drivers on each moving body that feels them, and the weights."""
    for name, load in (*motion.forces.items(), *motion.drivers.items()):
        for action in load.actions:
            if action.body != "ground":
                place, value = _two(action.x, action.y), _two(action.fx, action.fy)
                yield Vector(quantity, f"{name} on {action.body}", (action.body,), place, value)
    gravity = np.array(motion.gravity)
    for name, body in motion.bodies.items():
        if body.mass > 0 and gravity.any():
            place = at_body(body, *body.com).place
            value = np.tile(body.mass * gravity, (len(place), 1))
            yield Vector(quantity, f"weight of {name}", (name,), place, value, weight=True)


def _movements(motion: Motion, quantity: Quantity) -> Iterator[Vector]:
    """Yield arrows of traced points, of moving joints, and of centres of bodies that have neither."""
    fast = quantity == "velocities"
    slack = SAME * _extent(motion)
    shown: list[Array] = []
    marked: set[str] = set()
    for name, on, (place, velocity, acceleration) in _marked(motion):
        if np.ptp(place, axis=0).max() <= slack:
            continue
        marked |= {on}
        if not any(np.abs(place - other).max() <= slack for other in shown):
            shown.append(place)
            yield Vector(quantity, f"{quantity} of {name}", (on,), place, velocity if fast else acceleration)
    for name, body in motion.bodies.items():
        if name not in marked:
            place, velocity, acceleration = at_body(body, *body.com)
            yield Vector(quantity, f"{quantity} of {name}", (name,), place, velocity if fast else acceleration)


def _marked(motion: Motion) -> Iterator[tuple[str, str, Moves]]:
    """Yield traced points, then the second markers of joints: name, body, and how each moves."""
    for name, point in motion.points.items():
        yield name, point.body, Moves(_two(point.x, point.y), _two(point.vx, point.vy), _two(point.ax, point.ay))
    for name, joint in motion.joints.items():
        for on in joint.bodies[::-1]:
            if joint.pair != "pin" and on == joint.bodies[0]:
                continue  # what slides is at another place of its first body each time
            if body := motion.bodies.get(on):
                yield name, on, at_body(body, *local_place(body, joint.x[0], joint.y[0]))


def at_body(body: BodyMotion, x: float, y: float) -> Moves:
    """Return how the place (x, y) of a body's frame moves."""
    theta, omega, alpha = (np.asarray(s)[:, None] for s in (body.theta, body.omega, body.alpha))
    arm = np.hstack([np.cos(theta) * x - np.sin(theta) * y, np.sin(theta) * x + np.cos(theta) * y])
    across = np.stack([-arm[:, 1], arm[:, 0]], axis=1)
    return Moves(
        _two(body.x, body.y) + arm,
        _two(body.vx, body.vy) + omega * across,
        _two(body.ax, body.ay) + alpha * across - omega**2 * arm,
    )


def _extent(motion: Motion) -> float:
    """Return the larger side (m) of what joints, points and frames sweep."""
    things = [*motion.bodies.values(), *motion.joints.values(), *motion.points.values()]
    return max((float(max(np.ptp(thing.x), np.ptp(thing.y))) for thing in things), default=0.0) or 1.0


def _two(x: Sequence[float], y: Sequence[float]) -> Array:
    return np.stack([np.asarray(x, float), np.asarray(y, float)], axis=1)


# Quantities of curved arrows: torques of joints, drivers, springs and loads over the motion, each where it acts.

UNIT = "N m"
NOTHING = 1e-9
"""Torques below this part of the largest force at the length of the mechanism are rounding."""


@dataclass(frozen=True)
class Torque(Acting):
    """One torque."""

    value: Array
    """(T,) N m, positive counter-clockwise."""

    @property
    def axes(self) -> Array:
        """(T, 3) unit vectors of the axes about which it turns."""
        return np.tile([0.0, 0.0, 1.0], (len(self.value), 1))

    @property
    def size(self) -> Array:
        """(T,)"""
        return np.abs(self.value)

    @property
    def unit(self) -> str:
        """Unit of its value."""
        return UNIT


def torques(motion: Motion, show: Sequence[Quantity]) -> list[Torque]:
    """Return all that ``show`` asks for, in the order of the file.

    Torques that are nothing all the time are among them. A torque between two bodies is there once: as the second one
    feels it, or the first where the second is ground.
    """
    made = {"forces": _applied, "reactions": _reaction_torques}
    return [torque for quantity in show if quantity in made for torque in made[quantity](motion, quantity)]


def rounding(vectors: Sequence[Vector], size: float) -> float:
    """Return the rounding (N m) in torques beside these forces in a mechanism that is ``size`` (m) large."""
    forces = [float(vector.size.max()) for vector in vectors if vector.unit == "N"]
    return NOTHING * max(forces, default=0.0) * size


def _reaction_torques(motion: Motion, quantity: Quantity) -> Iterator[Torque]:
    """Yield torques of joints and contacts, about where they act."""
    for name, joint in (*motion.joints.items(), *motion.contacts.items()):
        on = felt(joint)
        yield Torque(quantity, name, joint.bodies, on.place, on.torque)


def _applied(motion: Motion, quantity: Quantity) -> Iterator[Torque]:
    """Yield torques of forces and drivers."""
    for name, load in (*motion.forces.items(), *motion.drivers.items()):
        several = getattr(load, "several", False)
        moving = [action for action in load.actions if action.body != "ground"]
        for action in moving if several else moving[-1:]:
            bodies = (action.body,) if several else tuple(other.body for other in load.actions)
            value = np.asarray(action.torque, float)
            yield Torque(quantity, f"{name} on {action.body}", bodies, _two(action.x, action.y), value)


# How long arrows are and how far arcs reach: one scale for the whole clip and for each unit, and its round number.

USUAL, PEAK, LONGEST = 97.0, 1.7, 1.35
"""Peaks up to PEAK times this percentile of the largest at each time set the scale themselves; higher ones are cut at
so many full lengths."""
MOSTLY, BLOW = 90.0, 4.0
"""This percentile counts instead where it is so many times smaller: blows that return would leave nothing of the rest.
"""
NEVER = 0.02
"""Fraction of the largest: what is smaller than this at nearly all times is a motion at rest."""
TINY = 0.025
"""Fraction of the full length: shorter arrows are left out."""


@dataclass(frozen=True)
class Scale:
    """Scale of one unit: the value at full length, a round number below it, and if longer ones are cut."""

    unit: str
    largest: float
    reference: float
    cut: bool


class Sized(Protocol):
    """Something with a size over time (T,) in a unit."""

    @property
    def size(self) -> Array:
        """(T,)"""
        ...

    @property
    def unit(self) -> str:
        """Unit of the size."""
        ...


def scales_of(things: Sequence[Sized], least: Mapping[str, float] | None = None) -> dict[str, Scale]:
    """Return scales by unit, for those that are more than ``least`` of their unit, or than nothing."""
    by_unit: dict[str, list[Array]] = {}
    for thing in things:
        by_unit.setdefault(thing.unit, []).append(thing.size)
    out = {}
    for unit, sizes in by_unit.items():
        peaks = np.max(sizes, axis=0)
        top = float(peaks.max())
        mostly, usual = (float(part) for part in np.percentile(peaks, (MOSTLY, USUAL)))
        if not math.isfinite(top) or top <= (least or {}).get(unit, 0.0):
            continue
        if BLOW * mostly < usual and mostly > NEVER * top:
            usual = mostly
        usual = usual if usual > NEVER * top else 0.5 * top  # a short pulse in a motion that is else at rest
        largest = top if top <= PEAK * usual else usual
        out[unit] = Scale(unit, largest, round_below(0.9 * largest), top > LONGEST * largest * (1 + 1e-9))
    return out


def round_below(value: float) -> float:
    """Return the largest of ..., 0.1, 0.2, 0.5, 1, 2, 5, 10, ... that is not above ``value`` > 0."""
    power = 10.0 ** math.floor(math.log10(value) + 1e-9)
    return next(step for step in (5.0, 2.0, 1.0, 0.5) if step * power <= value * (1 + 1e-9)) * power
