"""Poses, vectors and springs of a mechanism in space, at any moment.

Between rows of data.json places follow quintics, as in the plane, and so do the four entries of the quaternion; the
result has length 1. So all rows are met with their rates, and the film needs no second kind of interpolation.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from render.film.poses import Moment, Quintic
from render.film.scene import Point, Pose, TubeSpec
from render.film.tubes.stretched import BROAD, COIL, Path, coil_tubes
from render.film.vectors import Torque, Vector
from shared.contract import Motion3
from shared.contract.quaternions import matrices
from shared.contract.shot import Label, Quantity
from shared.contract.space import ForceMotion3, JointMotion3, Marker3, columns

Array = NDArray[np.float64]
LABEL = 0.03
"""Height of a label over its joint, as a part of the size of the swept motion."""


class SpacePoses:
    """Poses of every body and point of a motion in space, at any moment."""

    def __init__(self, motion: Motion3) -> None:
        self.motion = motion
        self.time = np.asarray(motion.time)
        self._quintic = Quintic(self.time)
        self._rates = {name: body.changes for name, body in motion.bodies.items()}

    def over(self, name: str, times: Array) -> tuple[Array, Array]:
        """Return places (n, 3) and quaternions (n, 4) of a body at times of the first period."""
        if name not in self._rates:
            return np.zeros((len(times), 3)), np.tile([1.0, 0.0, 0.0, 0.0], (len(times), 1))
        weights = self._quintic.weights_at(times)
        place, q = (self._columns(weights, series) for series in self._rates[name])
        return place, q / np.linalg.norm(q, axis=1, keepdims=True)

    def pose(self, name: str, at: Moment) -> Pose:
        """Return x, y, z (m) and the quaternion w, x, y, z of a body's frame; what never moves is at the origin.

        It is the same in every period, as pictures are; Blender chooses signs that go on.
        """
        place, q = self.over(name, np.array([at.time]))
        x, y, z, w, i, j, k = (float(value) for value in (*place[0], *q[0]))
        return x, y, z, w, i, j, k

    def carried(self, name: str, points: Array, times: Array) -> Array:
        """Return all places (m * n, 3) of points (n, 3) of a body at times (m,)."""
        place, q = self.over(name, times)
        return (place[:, None] + np.einsum("tij,nj->tni", matrices(q), points)).reshape(-1, 3)

    def is_still(self, name: str, times: Array) -> bool:
        """Return True if a body does not move at these times."""
        place, q = self.over(name, times)
        return max(float(np.ptp(place, axis=0).max()), float(np.ptp(q, axis=0).max())) < 1e-12

    def path(self, name: str, times: Array, height: float) -> Array:
        """Return positions (n, 3) of a traced point; its trail lies where it is, not at a ``height``."""
        weights, point = self._quintic.weights_at(times), self.motion.points[name]
        names = (("x", "y", "z"), ("vx", "vy", "vz"), ("ax", "ay", "az"))
        series = [columns(point, *group) for group in names]
        return self._columns(weights, (series[0], series[1], series[2]))

    def bends(self, name: str) -> Array:
        """Return the sizes (T,) of a traced point's acceleration (m/s^2)."""
        return np.linalg.norm(columns(self.motion.points[name], "ax", "ay", "az"), axis=1)

    def joint(self, name: str, at: Moment) -> Array:
        """Return the place (3,) of a joint (m)."""
        joint = self.motion.joints[name]
        return self._marker(joint.bodies[1], joint.markers[1], np.array([at.time]))[0][0]

    def ends(self, element: JointMotion3 | ForceMotion3, times: Array) -> tuple[Array, Array]:
        """Return the places (n, 3) of both markers of a joint or force (m)."""
        first, second = (
            self._marker(body, marker, times)[0] for body, marker in zip(element.bodies, element.markers, strict=True)
        )
        return first, second

    def _marker(self, body: str, marker: Marker3, times: Array) -> tuple[Array, Array]:
        """Return the place and the axis (n, 3) of a marker."""
        place, q = self.over(body, times)
        turned = matrices(q)
        return place + turned @ np.array(marker.place), turned @ np.array(marker.axis)

    def _columns(self, weights: Quintic.Weights, series: tuple[Array, Array, Array]) -> Array:
        value, rate, bend = series
        return np.stack([weights.series(value[:, k], rate[:, k], bend[:, k]) for k in range(value.shape[1])], axis=1)


# What floats over the bodies: labels; arrows and trails lie where they act.


class SpaceHeights:
    """Places of labels; nothing lies in layers."""

    def __init__(self, poses: SpacePoses, up: Point, size: float) -> None:
        self.poses, self._up, self._size = poses, np.array(up), size

    def arrow(self, bodies: object, *place: float) -> float:
        """Return 0: an arrow stands where it acts."""
        return 0.0

    def words(self, label: Label, at: Moment) -> Point:
        """Return the place of a label of the shot, over its joint or point."""
        points = self.poses.motion.points
        place = (
            self.poses.path(label.at, np.array([at.time]), 0.0)[0]
            if label.at in points
            else self.poses.joint(label.at, at)
        )
        x, y, z = (float(value) for value in place + LABEL * self._size * self._up)
        return x, y, z


# Springs between two places.


@dataclass(frozen=True)
class Coil:
    """A coil spring between the markers of a force."""

    force: ForceMotion3
    tubes: list[tuple[TubeSpec, Path]]

    @property
    def specs(self) -> list[TubeSpec]:
        """Description of each tube."""
        return [spec for spec, _ in self.tubes]

    def paths(self, poses: SpacePoses, at: Moment) -> list[list[Point]]:
        """Return the path of each tube."""
        first, second = (end[0] for end in poses.ends(self.force, np.array([at.time])))
        return [[(float(x), float(y), float(z)) for x, y, z in path(first, second)] for _, path in self.tubes]


def coils(motion: Motion3, size: float) -> Iterator[Coil]:
    """Yield the springs of a motion in space."""
    for name, force in motion.forces.items():
        if force.look != "coil":
            continue
        least, most = min(force.rows[0].value), max(force.rows[0].value)
        if least > 0.0:
            yield Coil(force, coil_tubes(name, min(COIL * size, BROAD * least), least, most))


# Arrows and arcs, where and about which axis they act.


@dataclass(frozen=True)
class Turning(Torque):
    """A torque about an axis: ``value`` is its size, never negative."""

    about: Array
    """(T, 3) unit vectors."""

    @property
    def axes(self) -> Array:
        """(T, 3) unit vectors of the axes about which it turns."""
        return self.about


def vectors_in_space(motion: Motion3, show: Sequence[Quantity]) -> list[Vector]:
    """Return all straight arrows that ``show`` asks for, in the order of the file."""
    out: list[Vector] = []
    for quantity in show:
        if quantity in ("velocities", "accelerations"):
            names = ("vx", "vy", "vz") if quantity == "velocities" else ("ax", "ay", "az")
            for name, point in motion.points.items():
                place = columns(point, "x", "y", "z")
                out.append(Vector(quantity, f"{quantity} of {name}", (point.body,), place, columns(point, *names)))
        elif quantity == "reactions":
            for name, joint in motion.joints.items():
                sign = -1.0 if joint.bodies[1] == "ground" else 1.0
                place, force = columns(joint, "x", "y", "z"), sign * columns(joint, "fx", "fy", "fz")
                out.append(Vector(quantity, name, joint.bodies, place, force))
        elif quantity == "forces":
            out += _applied(motion)
    return out


def _applied(motion: Motion3) -> Iterator[Vector]:
    """Yield pushes of springs and actuators on both bodies, and weights."""
    poses = SpacePoses(motion)
    for name, force in motion.forces.items():
        if force.unit == "m" and len(force.rows) == 1:
            first, second = poses.ends(force, poses.time)
            along = (second - first) / np.maximum(np.linalg.norm(second - first, axis=1, keepdims=True), 1e-12)
            push = np.asarray(force.rows[0].effort)[:, None] * along
            for body, place, value in zip(force.bodies, (first, second), (-push, push), strict=True):
                if body != "ground":
                    yield Vector("forces", f"{name} on {body}", (body,), place, value)
    gravity = np.array(motion.gravity)
    for name, body in motion.bodies.items():
        if body.mass > 0 and gravity.any():
            place = poses.carried(name, np.array([body.com]), poses.time)
            value = np.tile(body.mass * gravity, (len(place), 1))
            yield Vector("forces", f"weight of {name}", (name,), place, value, weight=True)


def torques_in_space(motion: Motion3, show: Sequence[Quantity]) -> list[Torque]:
    """Return all curved arrows that ``show`` asks for: moments of joints, torques of drivers and forces."""
    out: list[Torque] = []
    for quantity in show:
        if quantity == "reactions":
            for name, joint in motion.joints.items():
                sign = -1.0 if joint.bodies[1] == "ground" else 1.0
                out.append(_turning(quantity, name, joint.bodies, joint, sign * columns(joint, "mx", "my", "mz")))
        elif quantity == "forces":
            for name, driver in motion.drivers.items():
                if driver.joint is not None and driver.unit == "rad":
                    joint = motion.joints[driver.joint]
                    moment = np.asarray(driver.effort)[:, None] * columns(joint, "ux", "uy", "uz")
                    out.append(_turning(quantity, name, driver.bodies, joint, moment))
    return out


def _turning(quantity: Quantity, name: str, bodies: tuple[str, ...], joint: JointMotion3, moment: Array) -> Torque:
    size = np.linalg.norm(moment, axis=1)
    about = moment / np.maximum(size, 1e-300)[:, None]
    about[size == 0.0] = (0.0, 0.0, 1.0)
    return Turning(quantity, name, bodies, columns(joint, "x", "y", "z"), size, about)
