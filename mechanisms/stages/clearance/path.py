"""The motion of two pieces against each other: path, scale, common axes, pieces far apart."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import combinations

import msgspec
import numpy as np

from mechanisms.stages.clearance.pieces import MeshPiece
from shared.contract import Motion, Parts
from shared.contract.loads import Shape
from shared.contract.motion import BodyMotion, JointMotion
from shared.shapes.standards import Fit
from shared.shapes.units import mm
from shared.stage.scale import Scale

# The motion of a model at a scale: that of the machine, geometrically similar; angles and times stay. And what a
# refusal of its parts adds.

LENGTHS = ("x", "y", "vx", "vy", "ax", "ay")
"""Series of a body that are lengths and their rates."""
OF_SHAPE = ("radius_first", "radius_second", "pin_radius", "length")


def at_scale(motion: Motion, ratio: float) -> Motion:
    """Return a motion as the proof of clearance reads it, ``ratio`` times as large.

    Loads, masses and energies stay those of the machine.
    """
    bodies = {name: _body(body, ratio) for name, body in motion.bodies.items()}
    joints = {name: _joint(joint, ratio) for name, joint in motion.joints.items()}
    return msgspec.structs.replace(motion, bodies=bodies, joints=joints)


def _body(body: BodyMotion, ratio: float) -> BodyMotion:
    return msgspec.structs.replace(body, **{name: _times(getattr(body, name), ratio) for name in LENGTHS})


def _joint(joint: JointMotion, ratio: float) -> JointMotion:
    shape = joint.shape and _shape(joint.shape, ratio)
    return msgspec.structs.replace(joint, x=_times(joint.x, ratio), y=_times(joint.y, ratio), shape=shape)


def _shape(shape: Shape, ratio: float) -> Shape:
    (x, y, a), (u, v, b) = shape.markers
    lengths = {name: value * ratio for name in OF_SHAPE if (value := getattr(shape, name)) is not None}
    outline = [(px * ratio, py * ratio) for px, py in shape.outline]
    markers = (x * ratio, y * ratio, a), (u * ratio, v * ratio, b)
    return msgspec.structs.replace(shape, markers=markers, outline=outline, **lengths)


def _times(values: list[float], ratio: float) -> list[float]:
    return [value * ratio for value in values]


def what_shrinks(scale: Scale) -> str:
    """Return the end of a refusal at ``scale``: why a parts.py that fits its machine may not fit here."""
    running = Fit().running
    return (
        f"millimetres in a parts.py, clearances too, shrink with the mechanism. Fit(running="
        f"{running / scale.ratio:.3g}) leaves {running:g} mm at {scale}; fit_at_scale(pin) of mechanisms.automatic "
        "chooses for any scale. Without a parts.py, pins and fits are chosen for the scale"
    )


# The motion between the samples of data.json, as the film shows it, with bounds of its rates.
#
# Positions, rates and accelerations at both ends of an interval fix one quintic in each coordinate. As Bezier curves
# they lie within the hull of their control points, and so do their derivatives: that bounds speed and acceleration in
# between. Two samples at the same time (right before and after an event) bound no interval.

DIFFERENCE = 0.625
"""Largest value of the two middle Bernstein polynomials of degree five together."""
JUMP = 3.0
"""A jump of velocity inside an interval moves the true path by at most this times the cubic's from the quintic."""


@dataclass(frozen=True, eq=False)
class BodyPath:
    """One body over time: (n, 3) x, y (mm), theta (rad), their rates and accelerations (per s)."""

    time: np.ndarray
    pose: np.ndarray
    rate: np.ndarray
    acceleration: np.ndarray

    def until(self, rows: int) -> BodyPath:
        """Return its first samples, which are ``rows`` at most."""
        if rows >= len(self.time):
            return self
        return BodyPath(self.time[:rows], self.pose[:rows], self.rate[:rows], self.acceleration[:rows])

    @cached_property
    def first(self) -> np.ndarray:
        """(m,): the sample at which each interval begins."""
        return np.flatnonzero(np.diff(self.time) > 0)

    @cached_property
    def start(self) -> np.ndarray:
        """(m,): when each interval begins (s)."""
        return self.time[self.first]

    @cached_property
    def width(self) -> np.ndarray:
        """(m,): how long each interval is (s)."""
        return self.time[self.first + 1] - self.start

    @cached_property
    def control(self) -> np.ndarray:
        """(m, 6, 3): the control points of each interval's quintic."""
        k, h = self.first, self.width[:, None]
        x0, v0, a0 = self.pose[k], self.rate[k] * h, self.acceleration[k] * h**2
        x1, v1, a1 = self.pose[k + 1], self.rate[k + 1] * h, self.acceleration[k + 1] * h**2
        inner = (x0 + v0 / 5, x0 + 0.4 * v0 + a0 / 20, x1 - 0.4 * v1 + a1 / 20, x1 - v1 / 5)
        return np.stack([x0, *inner, x1], axis=1)

    @cached_property
    def turning(self) -> tuple[np.ndarray, np.ndarray]:
        """Bounds (m,) of the angular velocity (rad/s) and acceleration (rad/s^2) in each interval."""
        angle = self.control[:, :, 2:]
        return largest(angle, self.width, 1), largest(angle, self.width, 2)

    def interval(self, time: np.ndarray) -> np.ndarray:
        """Return (m,) the interval in which each time lies; of two that meet there, the later."""
        return np.clip(np.searchsorted(self.start, time, side="right") - 1, 0, len(self.start) - 1)

    def within(self, k: np.ndarray, time: np.ndarray) -> np.ndarray:
        """Return (m, 3) poses at times that lie in the intervals ``k``."""
        u = ((time - self.start[k]) / self.width[k])[:, None]
        point = self.control[k]
        while point.shape[1] > 1:  # de Casteljau
            point = point[:, :-1] + u[:, :, None] * (point[:, 1:] - point[:, :-1])
        return point[:, 0]

    def poses_at(self, time: np.ndarray) -> np.ndarray:
        """Return (m, 3) poses at any times."""
        return self.within(self.interval(time), time)

    @cached_property
    def error(self) -> tuple[np.ndarray, np.ndarray]:
        """Estimates (m,) of how far the true motion may be from each quintic: places (mm), angle (rad).

        Three times the difference between the quintic and the cubic that leaves the accelerations out. Smooth motion
        is nearer by orders of magnitude; a jump of velocity inside the interval, which the samples do not show, is
        just covered.
        """
        k, h = self.first, self.width[:, None]
        x0, x1 = self.pose[k], self.pose[k + 1]
        c1, c2 = x0 + self.rate[k] * h / 3, x1 - self.rate[k + 1] * h / 3
        off = np.stack(
            [self.control[:, 2] - (x0 + 6 * c1 + 3 * c2) / 10, self.control[:, 3] - (3 * c1 + 6 * c2 + x1) / 10]
        )
        places, turns = self._sizes(off)
        return JUMP * DIFFERENCE * places.max(axis=0), JUMP * DIFFERENCE * turns.max(axis=0)

    def _sizes(self, change: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return how far (mm) and by which angle (rad) changes (..., columns) of the pose move a body."""
        return np.hypot(change[..., 0], change[..., 1]), np.abs(change[..., 2])

    def interpolation_error(self, reach: float) -> np.ndarray:
        """Return (m,) the same for a point ``reach`` mm from the origin (mm)."""
        return self.error[0] + reach * self.error[1]


def paths(motion: Motion) -> dict[str, BodyPath]:
    """Return the path of every body, ``ground`` included."""
    time = np.array(motion.time)
    still = np.zeros((len(time), 3))
    by_body = {"ground": BodyPath(time, still, still, still)}
    for name, body in motion.bodies.items():
        series = ((body.x, body.y, body.theta), (body.vx, body.vy, body.omega), (body.ax, body.ay, body.alpha))
        columns = [np.column_stack([np.array(x) * mm(1), np.array(y) * mm(1), turn]) for x, y, turn in series]
        by_body[name] = BodyPath(time, *columns)
    return by_body


def relative(pose: np.ndarray, reference: np.ndarray) -> np.ndarray:
    """Return (m, 3): poses seen from the frame of ``reference``."""
    c, s = np.cos(reference[:, 2]), np.sin(reference[:, 2])
    dx, dy = pose[:, 0] - reference[:, 0], pose[:, 1] - reference[:, 1]
    return np.column_stack([c * dx + s * dy, c * dy - s * dx, pose[:, 2] - reference[:, 2]])


def points(pose: np.ndarray, point: np.ndarray) -> np.ndarray:
    """Return (m, 2) where a point (2,) of a body is, at each pose."""
    c, s = np.cos(pose[:, 2]), np.sin(pose[:, 2])
    x, y = point
    return np.column_stack([pose[:, 0] + c * x - s * y, pose[:, 1] + s * x + c * y])


class RelativePath:
    """A body seen from another: its pose at any time, and bounds of the acceleration of its points."""

    def __init__(self, mover: BodyPath, still: BodyPath, centre: np.ndarray, error: np.ndarray) -> None:
        """``centre`` (2,): the point of the mover that it is followed by (mm, the mover's frame).

        ``error`` (m,): how far the motion may be off in each interval (mm).
        """
        self.mover, self.still, self.centre, self.error = mover, still, centre, error
        away = float(np.hypot(*centre))
        gap = mover.control - still.control
        h = mover.width
        turn = (largest(gap[:, :, 2:], h, 1), largest(gap[:, :, 2:], h, 2))
        own, frame = mover.turning, still.turning
        speed = largest(gap[:, :, :2], h, 1) + own[0] * away
        acceleration = largest(gap[:, :, :2], h, 2) + (own[1] + own[0] ** 2) * away
        ends = [np.hypot(*points(m.pose[m.first + k], centre).T - s.pose[s.first + k, :2].T) for k in (0, 1)
                for m, s in ((mover, still),)]  # fmt: skip
        distance = np.maximum(*ends) + speed * h / 2
        self.push = acceleration + 2 * frame[0] * speed + (frame[1] + frame[0] ** 2) * distance
        """(m,): the centre's acceleration in the other's frame is at most this in each interval (mm/s^2)."""
        self.spin = turn[1] + turn[0] ** 2
        """(m,): every mm between a point and the centre adds this to its acceleration (1/s^2)."""

    def place(self, k: np.ndarray, time: np.ndarray) -> np.ndarray:
        """Return (n, 3) the centre's place (mm) and the angle (rad) in the other's frame.

        The times lie in intervals ``k``.
        """
        pose = self.mover.within(k, time)
        pose[:, :2] = points(pose, self.centre)
        return relative(pose, self.still.within(k, time))

    def bend(self, radius: float) -> float:
        """Return how far (mm) points within ``radius`` of the centre stray from straight lines, in all."""
        return float((self.mover.width**2 / 8 * (self.push + radius * self.spin)).sum())


def largest(control: np.ndarray, width: np.ndarray, order: int) -> np.ndarray:
    """Return (m,) a bound of a derivative's norm in each interval, from control points (m, degree + 1, d)."""
    factor = math.perm(control.shape[1] - 1, order) / width**order
    return factor * np.linalg.norm(np.diff(control, n=order, axis=1), axis=2).max(axis=1)


# Axes about which two bodies turn against each other, however they move.

type Axes = dict[frozenset[str], dict[str, np.ndarray]]
"""Axes by pair of bodies: the axis of their joint, as a point (mm) in the frame of either."""


def axes_of(motion: Motion, parts: Parts, where: Mapping[str, BodyPath]) -> Axes:
    """Return axes of bodies that a revolute joint or rod's end connects, and of those on a common pin."""
    axes: Axes = {}
    for joint in motion.joints.values():
        if joint.kind != "revolute":
            continue
        at = np.column_stack([np.array(joint.x) * mm(1), np.array(joint.y) * mm(1), np.zeros(len(joint.x))])
        seen = {body: relative(at, where[body].pose)[:, :2] for body in joint.bodies}
        if all(np.ptp(point, axis=0).max() < 1e-4 for point in seen.values()):
            axes[frozenset(joint.bodies)] = {body: point.mean(axis=0) for body, point in seen.items()}
    for rod, described in parts.bodies.items():
        for end in described.spans or ():
            own = np.array([end.x, end.y]) * mm(1)
            at = points(where[end.body].pose, own)
            point = relative(np.column_stack([at, np.zeros(len(at))]), where[rod].pose)[:, :2]
            if np.ptp(point, axis=0).max() < 1e-4:
                axes[frozenset((rod, end.body))] = {rod: point.mean(axis=0), end.body: own}
    return _with_common_pins(axes)


def _with_common_pins(axes: Axes) -> Axes:
    """Also bodies that turn on a common pin without a joint between the two of them."""
    waiting = list(axes.items())
    while waiting:
        pair, at = waiting.pop()
        for other, there in list(axes.items()):
            for body in pair & other:
                ends = pair ^ other
                if len(ends) == 2 and ends not in axes and np.abs(at[body] - there[body]).max() < 1e-4:
                    axes[ends] = {end: (at | there)[end] for end in ends}
                    waiting.append((ends, axes[ends]))
    return axes


# Finds bodies that stay far apart, such as links of a chain that are no neighbours: their pieces need no comparison.
#
# Between two outputs a body's origin lies within the box round the control points of its quintic, and its pieces lie
# within a circle about the origin. Boxes that are apart by the radii and more settle all pieces of two bodies at once.


def far_bodies(pieces: Sequence[MeshPiece], where: Mapping[str, BodyPath], reach: float) -> set[frozenset[str]]:
    """Return pairs of bodies whose pieces are ``reach`` (mm) apart or more as long as there are both.

    Pieces and paths are those in the plane, or those in space.
    """
    radius: dict[str, float] = {}
    for piece in pieces:
        radius[piece.body] = max(radius.get(piece.body, 0.0), piece.reach)
    axes = max((len(piece.centre) for piece in pieces), default=2)
    places = {body: where[body].control[:, :, :axes] for body in radius}
    boxes = {body: (place.min(axis=1), place.max(axis=1)) for body, place in places.items()}
    room = {body: r + where[body].interpolation_error(r) for body, r in radius.items()}
    pairs = set()
    for a, b in combinations(radius, 2):
        both = slice(min(len(room[a]), len(room[b])))
        (low_a, high_a), (low_b, high_b) = ([side[both] for side in boxes[body]] for body in (a, b))
        gap = np.maximum(np.maximum(low_b - high_a, low_a - high_b), 0.0)
        if (np.linalg.norm(gap, axis=1) - room[a][both] - room[b][both] >= reach).all():
            pairs.add(frozenset((a, b)))
    return pairs


def common(first: BodyPath, second: BodyPath) -> tuple[BodyPath, BodyPath]:
    """Return two paths as far as both go: that of a belt ends where an event releases it."""
    rows = min(len(first.time), len(second.time))
    return first.until(rows), second.until(rows)


def error_of(first: MeshPiece, second: MeshPiece, where: Mapping[str, BodyPath]) -> float:
    """Return how far two pieces may at most be from where they are taken to be (mm)."""
    pieces = zip((first, second), common(where[first.body], where[second.body]), strict=True)
    ends = [path.interpolation_error(piece.reach) for piece, path in pieces]
    return float((ends[0] + ends[1]).max(initial=0.0))
