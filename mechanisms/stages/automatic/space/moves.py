"""The motion that parts in space have room for (mm), and the size that they follow."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import combinations

import numpy as np
from numpy.typing import NDArray

from mbsd.spatial.mechanism import Mechanism
from mbsd.spatial.model.body import Marker
from mbsd.spatial.model.joint import Joint
from mbsd.spatial.results.solution import Solution
from shared.stage.errors import UserError

Array = NDArray[np.float64]
POSES = 72
"""Poses of the motion at which is looked whether parts meet."""
OF_LINK, OF_SHORTEST, OF_WHOLE, THICKEST = 0.085, 1.0 / 6.0, 0.020, 0.032
"""Radius of a rod: between two parts of the shortest link, so that it is within two parts of the whole mechanism."""
MM = 1000.0


@dataclass(frozen=True)
class Sizes:
    """Sizes of all parts (mm), from one: the radius of a rod."""

    rod: float

    @property
    def pin(self) -> float:
        """Radius of pins."""
        return 0.8 * self.rod

    @property
    def play(self) -> float:
        """Radial play of what turns, and axial play between faces."""
        return max(0.1, 0.06 * self.rod)

    @property
    def eye(self) -> tuple[float, float]:
        """Radius and half width of an eye."""
        return 1.9 * self.rod, 1.15 * self.rod

    @property
    def lap(self) -> float:
        """How far the middle of an eye stands beside its joint along the pin."""
        return self.eye[1] + self.play

    @property
    def ball(self) -> float:
        """Radius of the ball of a joint."""
        return 1.75 * self.rod

    @property
    def ring(self) -> tuple[float, float, float, float]:
        """Radius of a ball on a stud, outer radius and half width of the ring round it, and radius of the stud."""
        return 2.15 * self.rod, 3.0 * self.rod, 1.0 * self.rod, 0.7 * self.rod

    @property
    def cup(self) -> float:
        """Outer radius of the cup round it."""
        return 2.6 * self.rod

    @property
    def block(self) -> float:
        """Half width of a bearing along its shaft."""
        return 1.6 * self.rod

    @property
    def wall(self) -> float:
        """Wall round a bore."""
        return 1.25 * self.rod


@dataclass(frozen=True)
class Rolling:
    """A round body on a plane: by a joint that rolls, or by the force of a tyre or contact."""

    name: str
    plane: Marker
    wheel: Marker
    ring: float
    """Radius of the ring in which its rim has its middle (mm)."""
    rim: float
    """Radius of the rim's section (mm), 0 of a sharp edge."""
    leans: bool
    """True if its edge must be sharp or round: it rolls exactly, at any lean."""


class Moves:
    """Poses of all bodies over the motion."""

    def __init__(self, m: Mechanism, solution: Solution) -> None:
        self.m, self.solution = m, solution
        rows = self.rows = np.unique(np.linspace(0, len(solution.t) - 1, POSES).round().astype(int))
        rest = np.tile(np.eye(3), (len(rows), 1, 1))
        self.poses: dict[str, tuple[Array, Array]] = {"ground": (np.zeros((len(rows), 3)), rest)}
        for name in m.bodies:
            if name != "ground":
                view = solution.body(name)
                self.poses[name] = MM * view.place[rows], view.rotation[rows]
        self.sizes = Sizes(self._rod())

    def place(self, marker: Marker) -> Array:
        """Return the place (3,) of a marker in its body's frame (mm)."""
        return MM * np.array(marker.place)

    def world(self, body: str, points: Array) -> Array:
        """Return points (n, 3) of a body's frame over the motion, (T, n, 3) in the world (mm)."""
        place, turned = self.poses[body]
        return place[:, None] + np.einsum("tij,nj->tni", turned, np.atleast_2d(points))

    def seen(self, body: str, points: Array) -> Array:
        """Return places (T, 3) of the world as seen from a body's frame (mm)."""
        place, turned = self.poses[body]
        return np.einsum("tji,tj->ti", turned, points - place)

    def turned(self, body: str, direction: Array) -> Array:
        """Return a direction (3,) of a body's frame over the motion, (T, 3) in the world."""
        return self.poses[body][1] @ direction

    def joints(self) -> list[Joint]:
        """Return the joints that hold bodies; couplings of other joints have no parts."""
        return [joint for joint in self.m.joints.values() if not joint.coupled]

    def rolling(self) -> list[Rolling]:
        """Return what rolls on planes, by joints and by forces."""
        exact = [joint for joint in self.m.joints.values() if joint.kind.name == "rolling"]
        forces = [force for force in self.m.forces.values() if force.kind.name in ("tyre", "contact")]
        return [
            Rolling(pair.name, pair.i, pair.j, MM * pair.params["ring"], MM * pair.params["radius"], pair in exact)
            for pair in [*exact, *(force for force in forces if force.params["heights"] is None)]
        ]

    def _rod(self) -> float:
        """Return the radius of rods (mm)."""
        places: dict[str, list[Array]] = {name: [] for name in self.m.bodies}
        for joint in self.joints():
            for marker in (joint.i, joint.j) if joint.kind.name != "rolling" else ():
                places[marker.body.name].append(self.place(marker))
            if "length" in joint.params:
                places[joint.name + " (rod)"] = [np.zeros(3), np.array([MM * joint.params["length"], 0, 0])]
        for name, body in self.m.bodies.items():
            if body.shape is not None and body.shape.kind == "rod":
                places[name] += [np.zeros(3), np.array([MM * body.shape.length, 0.0, 0.0])]
            elif name != "ground" and (body.mass > 0.0 or any(body.place) or len(places[name]) < 2):
                places[name].append(MM * np.array(body.com))
            if body.shape is not None and body.shape.kind == "disc":
                places[name] += [MM * body.shape.radius * y for y in (np.eye(3)[1], -np.eye(3)[1])]
        everything = np.concatenate(
            [self.world(name, np.array(own)) for name, own in places.items() if own and name in self.poses], axis=1
        )
        poses = everything[:, None] if self.rolling() else everything.reshape(1, 1, -1, 3)
        whole = max(float(np.linalg.norm(np.ptp(pose[0], axis=0))) for pose in poses)
        links = [
            float(np.linalg.norm(a - b))
            for name, own in places.items()
            if name != "ground"
            for a, b in combinations(own, 2)
        ]
        links = [length for length in links if length > 0.02 * whole]
        if whole == 0.0:
            raise UserError(
                f"{self.m.name}: all joints and centres of mass are on one place, so there is nothing to shape"
            )
        least = min(links, default=whole)
        return min(max(OF_LINK * least, min(OF_WHOLE * whole, OF_SHORTEST * least)), THICKEST * whole)
