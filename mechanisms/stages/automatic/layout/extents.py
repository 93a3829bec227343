"""What the scale of the parts follows from: how far the joints reach, and lengths that must hold a pin's width."""

from __future__ import annotations

import math
from collections.abc import Callable, Collection
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from mbsd import Mechanism, Solution
    from mbsd.model.body import Marker
    from mbsd.model.force import Force
    from mbsd.model.joint import Joint

LINK, STUD = 22.0, 18.0
"""Least distances of two pins of one body, and of a spring's stud and a pin or stud beside it (rmm)."""
ROD = "distance"
"""The kind of joint that is a rod: like a body here, though it has no mass and no pose of its own in the model."""
STRETCHING = (
    "spring", "spring_law", "curve_of_length", "actuator", "gas", "gas_cycle", "gas_strut", "hydraulic_cylinder",
)  # fmt: skip
"""Kinds of forces that act along the line of two points, or along an axis on which both may be."""
ROPE, LINEAR = "rope", "drive_distance"
"""The kinds of contact and of driver that do."""
NEAR = 0.02
"""Studs that are nearer to each other, as a part of the whole, are on one place, or do not decide the scale."""


@dataclass(frozen=True)
class Extent:
    """What a joint, contact or force says of its own: how far it reaches, and what must have room for its parts."""

    radii: tuple[tuple[Marker, float], ...] = ()
    """Markers and radii (m) round them."""
    least: tuple[tuple[float, float], ...] = ()
    """Lengths of the model (m), each with the least that it may be in rmm."""


type ExtentOf = Callable[[Any, Solution], Extent]
"""Extent of a joint, a contact or a force."""

EXTENTS: dict[str, ExtentOf] = {}


def extent(name: str) -> Callable[[ExtentOf], ExtentOf]:
    """Enter what joints, contacts or forces of a kind say of their size."""

    def enter(of: ExtentOf) -> ExtentOf:
        EXTENTS[name] = of
        return of

    return enter


@dataclass(frozen=True)
class Lengths:
    """Lengths of a mechanism (m) from which the size of its parts follows."""

    apart: list[tuple[float, str, float]]
    """Distances of two pins of a body, or what is like one, each with words for it, and the length that these mean;
    without those that are none.
    """
    overall: float
    """The longer side of all that is swept."""

    @property
    def shortest(self) -> tuple[float, str, float]:
        """The shortest distance, with its words and their length."""
        return min(self.apart, default=(self.overall, "all that moves", self.overall))


def lengths_of(m: Mechanism, solution: Solution, left_out: Collection[str] = ()) -> Lengths:
    """Lengths of a mechanism and its motion, without bodies that are ``left_out``."""
    places: dict[str, list[tuple[float, float]]] = {}
    pinned: dict[str, list[tuple[float, float]]] = {}
    pins: dict[str, list[str]] = {}
    studs: dict[str, list[tuple[float, float]]] = {}
    least: list[tuple[float, str, float]] = []
    for joint in m.joints.values():
        for marker in (joint.i, joint.j):
            if marker.body.name in left_out:
                continue
            places.setdefault(marker.body.name, []).append((marker.x, marker.y))
            if joint.kind.pair == "pin" or joint.kind.name == ROD or (joint.kind.pair == "slot" and marker is joint.j):
                pinned.setdefault(marker.body.name, []).append((marker.x, marker.y))
                pins.setdefault(marker.body.name, []).append(joint.name)
    for force in m.forces.values():
        for marker in (force.i, force.j) if force.kind.journal is not None else ():
            if marker.body.name not in left_out:
                places.setdefault(marker.body.name, []).append((marker.x, marker.y))
                pinned.setdefault(marker.body.name, []).append((marker.x, marker.y))
                pins.setdefault(marker.body.name, []).append(force.name)
    for thing in (*m.joints.values(), *m.contacts.values(), *m.forces.values()):
        if thing.kind.name in EXTENTS and not any(body in left_out for body in thing.bodies):
            own = EXTENTS[thing.kind.name](thing, solution)
            least += [(length * LINK / wanted, f"a length of '{thing.name}'", length) for length, wanted in own.least]
            for marker, radius in own.radii:
                round_it = [(marker.x + radius * u, marker.y + radius * v) for u, v in _ROUND]
                places.setdefault(marker.body.name, []).extend(round_it)
    for element in stretching(m, left_out):
        for marker in (element.i, element.j):
            places.setdefault(marker.body.name, []).append((marker.x, marker.y))
            studs.setdefault(marker.body.name, []).append((marker.x, marker.y))
    held = [*m.joints.values(), *(force for force in m.forces.values() if force.kind.journal is not None)]
    jointed = {name for joint in held for name in joint.bodies}
    for name, body in m.bodies.items():
        if name not in (*jointed, *left_out, "ground"):
            places.setdefault(name, []).append(body.com)
        if body.length is not None and name not in left_out:
            places.setdefault(name, []).extend([(0.0, 0.0), (body.length, 0.0)])
    seen = np.concatenate([[[0.0, 0.0]], *[_swept(solution, body, np.array(at)) for body, at in places.items()]])
    overall = float(np.ptp(seen[1:], axis=0).max()) if len(seen) > 1 else 1.0
    apart = [
        (d := math.dist(at[i], at[k]), f"the distance of '{pins[body][k]}' and '{pins[body][i]}' on '{body}'", d)
        for body, at in pinned.items()
        for i in range(len(at))
        for k in range(i)
    ]
    for body, at in studs.items():
        beside = [math.dist(a, b) for i, a in enumerate(at) for b in [*at[:i], *pinned.get(body, [])]]
        words = f"the distance of pins or ends of springs on '{body}'"
        least += [(d * LINK / STUD, words, d) for d in beside if d > NEAR * overall]
    return Lengths([length for length in [*apart, *least] if length[0] > 1e-3 * overall], overall)


def stretching(m: Mechanism, left_out: Collection[str] = ()) -> list[Force | Joint]:
    """Forces, ropes and drivers between two points that have parts at both ends."""
    elements: list[Force | Joint] = [force for force in m.forces.values() if force.kind.name in STRETCHING]
    elements += [contact for contact in m.contacts.values() if contact.kind.name == ROPE]
    elements += [driver for driver in m.drivers.values() if driver.kind.name == LINEAR]
    return [element for element in elements if not any(body in left_out for body in element.bodies)]


_ROUND = [(np.cos(a), np.sin(a)) for a in np.linspace(0.0, 2 * np.pi, 16, endpoint=False)]


def _swept(solution: Solution, body: str, at: np.ndarray) -> np.ndarray:
    if body == "ground":
        return at
    view = solution.body(body)
    c, s = np.cos(view.theta)[:, None], np.sin(view.theta)[:, None]
    x = view.x[:, None] + c * at[:, 0] - s * at[:, 1]
    y = view.y[:, None] + s * at[:, 0] + c * at[:, 1]
    return np.stack([x.ravel(), y.ravel()], axis=1)


def distance(joint: Joint, solution: Solution) -> float:
    """Distance between a joint's two markers at the start (m)."""
    first, second = (_swept(solution, k.body.name, np.array([[k.x, k.y]]))[0] for k in (joint.i, joint.j))
    return float(np.hypot(*(second - first)))


def rods_of(m: Mechanism, left_out: Collection[str] = ()) -> dict[str, Joint]:
    """By name, which is that of the joint, but for joints whose name a body has; without those that lack an end."""
    rods: dict[str, Joint] = {}
    for name, joint in m.joints.items():
        rod = f"rod_{name}" if name in m.bodies else name
        if joint.kind.name == ROD and rod not in left_out and not any(body in left_out for body in joint.bodies):
            rods[rod] = joint
    return rods
