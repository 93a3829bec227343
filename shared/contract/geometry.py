"""Geometry that follows from files: belts round two pulleys, spans of cables, rods, and reactions."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import NamedTuple

import msgspec
import numpy as np
from numpy.typing import NDArray

from shared.contract.loads import ContactMotion
from shared.contract.motion import BodyMotion, JointMotion, Motion
from shared.contract.parts import End, Parts
from shared.stage.errors import UserError

# Path of a belt or chain round two pulleys: its length, and places along it.
#
# The first pulley's centre is the origin, the second's at (distance, 0). The belt goes counter-clockwise round the
# first, on straight along the common tangent, round the second (clockwise if it is crossed), and back:
#
#     open       cos(beta) = (r1 - r2) / d      arcs 2 pi - 2 beta and 2 beta
#     crossed    cos(beta) = (r1 + r2) / d      arcs 2 pi - 2 beta, both
#
# beta is the angle between the line of centres and the radius to a tangent's end. Lengths in any one unit.


Array = NDArray[np.float64]


@dataclass(frozen=True)
class BeltPath:
    """A belt on pitch radii ``first`` and ``second``, whose centres are ``distance`` apart."""

    first: float
    second: float
    distance: float
    crossed: bool = False

    @property
    def has_room(self) -> bool:
        """True if the pulleys lie so far apart that there are tangents."""
        return abs(self._difference) < self.distance

    @property
    def _difference(self) -> float:
        return self.first + self.second if self.crossed else self.first - self.second

    @property
    def beta(self) -> float:
        """Angle beta of the file's formulas (rad)."""
        return math.acos(self._difference / self.distance)

    @property
    def strand(self) -> float:
        """Length of a straight part."""
        return math.sqrt(self.distance**2 - self._difference**2)

    @property
    def parts(self) -> tuple[float, float, float, float]:
        """Lengths of the arc on the first, the strand to the second, the arc on that, and the strand back."""
        wrap = 2 * math.pi - 2 * self.beta
        return self.first * wrap, self.strand, self.second * (wrap if self.crossed else 2 * self.beta), self.strand

    @property
    def length(self) -> float:
        """Length of the whole belt."""
        return sum(self.parts)

    def places(self, along: Array) -> tuple[Array, Array]:
        """Return (n, 2) places along the belt, and their (n,) positions on its strands.

        ``along`` (n,) are lengths from where the belt meets the first pulley. Positions are 0 .. 1, below zero on the
        strand back, 0 on pulleys.
        """
        s = np.mod(along, self.length)
        off_first, onto_second, off_second, _ = np.cumsum(self.parts)
        beta, sense = self.beta, -1.0 if self.crossed else 1.0
        start = math.pi - beta if self.crossed else -beta
        out, centre = np.empty((len(s), 2)), np.array([self.distance, 0.0])
        rest = np.zeros(len(s))
        on_first, on_second = s < off_first, (s >= onto_second) & (s < off_second)
        out[on_first] = self.first * _ray(beta + s[on_first] / self.first)
        out[on_second] = centre + self.second * _ray(start + sense * (s[on_second] - onto_second) / self.second)
        for begins, inside, ends, sign in (
            (
                off_first,
                (s >= off_first) & (s < onto_second),
                (self.first * _ray(-beta), centre + self.second * _ray(start)),
                1.0,
            ),
            (off_second, s >= off_second, (centre + self.second * _ray(-start), self.first * _ray(beta)), -1.0),
        ):
            part = ((s[inside] - begins) / self.strand)[:, None]
            out[inside] = (1 - part) * ends[0] + part * ends[1]
            rest[inside] = sign * part[:, 0]
        return out, rest

    def on_second(self, along: float) -> float:
        """Return the angle (rad) of a place on the arc of the second pulley, from the line of centres."""
        arc, strand, _, _ = self.parts
        start, sense = (math.pi - self.beta, -1.0) if self.crossed else (-self.beta, 1.0)
        return start + sense * (along - arc - strand) / self.second


def span_ends(first: Array, second: Array, radii: tuple[float, float]) -> Array:
    """Return (..., 2, 2) where a cable leaves one wheel and meets the next, whose centres are (..., 2).

    ``radii`` are negative where the cable turns clockwise. See mbsd/equations/relative/span.py.
    """
    gap = second - first
    offset = radii[1] - radii[0]
    lean = np.arcsin(np.clip(offset / np.hypot(gap[..., 0], gap[..., 1]), -1.0, 1.0))
    left = _ray(np.arctan2(gap[..., 1], gap[..., 0]) - lean + math.pi / 2)
    return np.stack([first - radii[0] * left, second - radii[1] * left], axis=-2)


type SpanWheel = tuple[str, float, float, float]
"""Body, place on it and signed radius of a wheel of a cable."""


def rows_of_spans(wheels: Mapping[str, tuple[SpanWheel | None, SpanWheel | None]]) -> list[list[str]]:
    """Return the names of spans by cable: each begins on the wheel on which the one before ends.

    ``wheels``: of each span the wheel on which it begins and that on which it ends; None of a point. Where a cable
    comes to a drum again, at another radius, a row of its own begins with that span: it lies beside the others.
    """
    rows: list[list[str]] = []
    for name, (first, last) in wheels.items():
        row = next((row for row in rows if first is not None and wheels[row[-1]][1] == first), None)
        if row is None or any(_stepped(last, end) for other in row for end in wheels[other]):
            rows.append([name])
        else:
            row.append(name)
    return rows


def _stepped(first: SpanWheel | None, second: SpanWheel | None) -> bool:
    """Return True for two wheels of different radii about one place of a body."""
    return first is not None and second is not None and first[:3] == second[:3] and abs(first[3]) != abs(second[3])


def _ray(angle: Array | float) -> Array:
    return np.stack([np.cos(angle), np.sin(angle)], axis=-1)


# Thickness of a belt or chain in the film and in the clearance proof, from its rim's radius.
#
# A round belt carries marks that stand out a little. A chain has rollers on pins between two rows of plates.


LONG, PROUD = 1.6, 1.06
"""Half of a mark's length, and its radius."""
ROLLER, BOLT = 0.9, 0.35
"""Radii of a chain's roller and of its pin."""
PLATES, PIN, PLATE = 1.5, 2.1, 0.42
"""Distance of a chain's plates from the middle, half a pin's length, a plate's radius."""
APART = 1.1
"""Distance by which the strands of a crossed belt pass over and under each other."""


def half_width(radius: float, chain: bool) -> float:
    """Return the extent from the middle line out, in the plane."""
    return radius * (ROLLER if chain else PROUD)


def half_height(radius: float, chain: bool, crossed: bool) -> float:
    """Return the extent from the middle line up."""
    return radius * ((PIN if chain else PROUD) + (APART if crossed else 0.0))


# Rods of parts.json, which join two places of bodies: their motion follows from these bodies.
#
#     p = second place - first place    l = |p|     u = p / l     n = u turned by a quarter, counter-clockwise
#     theta = angle of p                omega = p' . n / l        alpha = (p'' . n - 2 l' omega) / l     l' = p' . u
#
# The rod's frame is at the first place. It has no mass here: in the model it is a constraint. A rod that an event
# releases stays on the body of its first place as it is then.


def with_rods(motion: Motion, parts: Parts) -> Motion:
    """Return the motion with a body for each rod of the parts.

    Raises UserError if a rod ends on no body, or on itself.
    """
    rods = {name: body.spans for name, body in parts.bodies.items() if body.spans is not None}
    if not rods:
        return motion
    made = {name: _moved(name, ends, parts.bodies[name].z, motion) for name, ends in rods.items()}
    for name in set(rods) & set(motion.joints):
        rows = motion.joints[name].rows_held(motion.time)
        if 0 < rows < len(motion.time):
            _leave(made[name], motion.bodies.get(rods[name][0].body), rows)
    return msgspec.structs.replace(motion, bodies=motion.bodies | made)


def _moved(name: str, ends: tuple[End, End], z: float, motion: Motion) -> BodyMotion:
    if name in motion.bodies:
        raise UserError(
            f"{motion.mechanism}: parts.json has a rod '{name}', and data.json a body of that name; rename the joint"
        )
    (place, rate, change), second = (_place(name, end, motion) for end in ends)
    way, way_rate, way_change = (b - a for a, b in zip((place, rate, change), second, strict=True))
    length = np.hypot(*way.T)
    joint = motion.joints.get(name)
    rows = len(length) if joint is None else joint.rows_held(motion.time)
    if length[:rows].min() < 1e-9:
        at = motion.time[int(length[:rows].argmin())]
        raise UserError(
            f"{motion.mechanism}: both ends of the rod '{name}' are on one place at t={at:.4g} s; join others"
        )
    length = np.maximum(length, 1e-9)  # after a release the ends may meet
    along = way / length[:, None]
    across = np.stack([-along[:, 1], along[:, 0]], axis=1)
    omega = (way_rate * across).sum(axis=1) / length
    alpha = ((way_change * across).sum(axis=1) - 2 * (way_rate * along).sum(axis=1) * omega) / length
    theta = np.unwrap(np.arctan2(way[:, 1], way[:, 0]))
    if motion.period is not None:  # what repeats but for whole turns does so to the last digit
        theta += (theta[0] + np.round((theta[-1] - theta[0]) / np.pi / 2) * 2 * np.pi - theta[-1]) * (
            np.arange(len(theta)) == len(theta) - 1
        )
    series = (*place.T, theta, *rate.T, omega, *change.T, alpha)
    names = ("x", "y", "theta", "vx", "vy", "omega", "ax", "ay", "alpha")
    values = {key: column.tolist() for key, column in zip(names, series, strict=True)}
    return BodyMotion(**values, z=z, mass=0.0, com=(0.0, 0.0), inertia=0.0)


def _leave(rod: BodyMotion, body: BodyMotion | None, rows: int) -> None:
    """Turn a rod with ``body``, which is ground if None, from the row after ``rows`` on."""
    at = rod.theta[rows - 1]
    count = len(rod.theta) - rows
    if body is None:
        rod.theta[rows:], rod.omega[rows:], rod.alpha[rows:] = [at] * count, [0.0] * count, [0.0] * count
        return
    rod.theta[rows:] = [at + angle - body.theta[rows - 1] for angle in body.theta[rows:]]
    rod.omega[rows:], rod.alpha[rows:] = body.omega[rows:], body.alpha[rows:]


def _place(name: str, end: End, motion: Motion) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return the place of an end, its velocity and its acceleration, (T, 2) each."""
    if end.body == "ground":
        still = np.zeros((len(motion.time), 2))
        return still + np.array([end.x, end.y]), still, still
    if end.body not in motion.bodies:
        raise UserError(
            f"{motion.mechanism}: the rod '{name}' of parts.json ends on '{end.body}', which data.json does not move; "
            f"there is: ground, {', '.join(motion.bodies)}"
        )
    body = motion.bodies[end.body]
    theta, omega, alpha = (np.asarray(column)[:, None] for column in (body.theta, body.omega, body.alpha))
    arm = np.hstack([np.cos(theta) * end.x - np.sin(theta) * end.y, np.sin(theta) * end.x + np.cos(theta) * end.y])
    side = np.stack([-arm[:, 1], arm[:, 0]], axis=1)
    place = np.column_stack([body.x, body.y]) + arm
    rate = np.column_stack([body.vx, body.vy]) + omega * side
    return place, rate, np.column_stack([body.ax, body.ay]) + alpha * side - omega**2 * arm


# Reaction on the body that moves: the second one, or the first if the second is ground.


class Felt(NamedTuple):
    """Reaction over time."""

    place: Array
    """(T, 2) where it acts (m)."""
    force: Array
    """(T, 2) world axes (N)."""
    torque: Array
    """(T,) about that place (N m), positive counter-clockwise."""


def felt(connection: JointMotion | ContactMotion) -> Felt:
    """Return the reaction with the sign for that body.

    The file data.json has it as the second body feels it.
    """
    at = connection.acts or connection
    sign = -1.0 if connection.bodies[1] == "ground" else 1.0
    place = np.array([at.x, at.y], float).T
    force = np.array([connection.fx, connection.fy], float).T
    return Felt(place, sign * force, sign * np.asarray(at.torque, float))
