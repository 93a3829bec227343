"""Bodies, joints and forces of a mechanism as Modelica components."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence, Set
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mbsd.model.teeth import with_radii
from mechanisms.stages.export.modelica.document import Document, law, number, signed, vector
from mechanisms.stages.export.tree import GROUND

# Bodies and the frames on them: Body at the centre of mass, FixedTranslation to each place, Fixed on ground.

SMALL = 1e-12
"""m: two places nearer than this are one; a FixedTranslation has to have a length."""


class Places:
    """The frames of a model, made when they are asked for."""

    def __init__(self, document: Document, bodies: Mapping[str, Any]) -> None:
        self._document, self._bodies = document, bodies
        self.name = {body: document.names.new(body) for body in bodies}
        """Name of the component of each body."""
        self._origins: dict[str, str] = {}
        self._frames: dict[tuple[str, float, float], str] = {}

    def frame_at(self, marker: Any, user: str) -> str:
        """Return the frame at a marker, in the body's axes; it may be called after its ``user``."""
        body, x, y = marker.body.name, float(marker.x), float(marker.y)
        near = (key for key in self._frames if key[0] == body and max(abs(key[1] - x), abs(key[2] - y)) < SMALL)
        key = next(near, (body, x, y))
        if key not in self._frames:
            self._frames[key] = self._make_frame(body, x, y, user)
        return self._frames[key]

    def _make_frame(self, body: str, x: float, y: float, user: str) -> str:
        if body == GROUND:
            name = self._document.names.new(GROUND, user)
            made = self._document.add("Parts.Fixed", name, {"r": vector(x, y)}, f"place of '{user}'")
            return f"{made}.frame"
        origin = self._origin(body)
        return origin if max(abs(x), abs(y)) < SMALL else self._moved(origin, body, x, y, user)

    def _origin(self, body: str) -> str:
        """Return the frame that the author drew the body in."""
        if body not in self._origins:
            own, com = f"{self.name[body]}.frame_a", self._bodies[body].com
            if max(map(abs, com)) >= SMALL:
                name = self._document.names.new(body, "com")
                words = f"centre of mass of '{body}'"
                self._document.add("Parts.FixedTranslation", name, {"r": vector(*com)}, words)
                self._document.connect(f"{name}.frame_b", own)
                own = f"{name}.frame_a"
            self._origins[body] = own
        return self._origins[body]

    def _moved(self, origin: str, body: str, x: float, y: float, user: str) -> str:
        name = self._document.names.new(body, user)
        self._document.add("Parts.FixedTranslation", name, {"r": vector(x, y)}, f"place of '{user}' on '{body}'")
        self._document.connect(origin, f"{name}.frame_a")
        return f"{name}.frame_b"

    def add_body(self, body: str, start: Mapping[str, str]) -> None:
        """Declare a body with its mass; ``start`` are modifiers of its r, v, phi and w."""
        thing = self._bodies[body]
        mass = {"m": number(thing.mass), "I": number(thing.inertia)}
        self._document.add("Parts.Body", self.name[body], {**mass, **start}, f"body '{body}'")


# Where everything is at the first output, and how fast.

Array = NDArray[np.float64]
IMAGINARY_STEP = 1e-30
"""Imaginary step (s) of derivatives: they are exact but for rounding (Squire and Trapp 1998)."""


@dataclass(frozen=True)
class Start:
    """Poses and rates of all bodies, ground too: x, y (m), theta (rad), and per second."""

    poses: Mapping[str, Array]
    rates: Mapping[str, Array]

    @classmethod
    def from_solution(cls, solution: Any) -> Start:
        """Return the start at a solution's first output."""
        poses, rates = {GROUND: np.zeros(3)}, {GROUND: np.zeros(3)}
        for name in solution.mechanism.bodies:
            if name != GROUND:
                view = solution.body(name)
                poses[name] = np.array([view.x[0], view.y[0], view.theta[0]], float)
                rates[name] = np.array([view.vx[0], view.vy[0], view.omega[0]], float)
        return cls(poses, rates)

    def rate(self, value: Any) -> float:
        """Return how fast an analytic function of the poses changes."""
        return float(
            value({name: pose + 1j * IMAGINARY_STEP * self.rates[name] for name, pose in self.poses.items()}).imag
            / IMAGINARY_STEP
        )


def place(poses: Mapping[str, Array], marker: Any) -> Array:
    """Return (2,) the place of a marker."""
    x, y, theta = poses[marker.body.name]
    c, s = np.cos(theta), np.sin(theta)
    return np.array([x + c * marker.x - s * marker.y, y + s * marker.x + c * marker.y])


def angle(poses: Mapping[str, Array], joint: Any) -> Any:
    """Return the angle of the second body against the first."""
    return poses[joint.j.body.name][2] - poses[joint.i.body.name][2]


def along(poses: Mapping[str, Array], joint: Any) -> Array:
    """Return (2,) the second marker in the axes of the first."""
    dx, dy = place(poses, joint.j) - place(poses, joint.i)
    turn = poses[joint.i.body.name][2] + joint.i.angle
    c, s = np.cos(turn), np.sin(turn)
    return np.array([c * dx + s * dy, c * dy - s * dx])


# Coordinates that a model starts from: as many as it has freedoms, and independent of each other.
#
# J     rows of its joints and drivers by the bodies' coordinates, at the start, by differences; N: J N = 0
# C     the same of coordinates of joints; rows of C N that are independent, by QR with pivots

Poses = Mapping[str, Array]
Key = tuple[str, str]
"""Name of a joint or body, and of its variable: phi, s; x, y, theta."""
ZERO = 1e-7
"""Singular values below this part of the largest are none."""
STEP = 1e-6


def rows(joint: Any, poses: Poses, size: float) -> list[float]:
    """Return the residuals of a joint or driver, free of dimension."""
    turn, (x, y) = angle(poses, joint), along(poses, joint) / size
    match joint.kind.name:
        case "revolute":
            return [x, y]
        case "prismatic":
            return [y, turn]
        case "weld":
            return [x, y, turn]
        case "pin_in_slot":
            return [y]
        case "distance" | "drive_distance":
            return [math.hypot(x, y)]
        case "drive_coordinate":
            return [x]
        case "angle_lock" | "drive_angle" | "drive_relative_angle":
            return [turn]
        case "rack_and_pinion":
            return [x + joint.kind.numbers(joint.params)[0][2] / size * turn]
        case "gear_pair" | "belt":
            [(a, b)] = joint.kind.numbers(joint.params)
            dx, dy = place(poses, joint.j) - place(poses, joint.i)
            first, second = (poses[marker.body.name][2] for marker in (joint.i, joint.j))
            return [(a * first + b * second - (a + b) * math.atan2(dy, dx)) / size]
    raise ValueError(joint.kind.name)


@dataclass(frozen=True)
class Function:
    """Something that depends on the poses of some bodies alone."""

    bodies: tuple[str, ...]
    value: Callable[[Poses], Sequence[float]]


def coordinates(joints: Sequence[Any], loose: Sequence[str], size: float) -> dict[Key, Function]:
    """Return coordinates of joints, and of bodies that no joint with a coordinate holds.

    Free of dimension.
    """
    out: dict[Key, Function] = {}
    for joint in joints:
        if joint.kind.name in ("revolute", "pin_in_slot"):
            out[joint.name, "phi"] = Function(joint.bodies, lambda poses, joint=joint: [angle(poses, joint)])
        if joint.kind.name in ("prismatic", "pin_in_slot"):
            out[joint.name, "s"] = Function(joint.bodies, lambda poses, joint=joint: [along(poses, joint)[0] / size])
    for body in loose:
        for k, (axis, scale) in enumerate((("x", size), ("y", size), ("theta", 1.0))):
            out[body, axis] = Function((body,), lambda poses, body=body, k=k, scale=scale: [poses[body][k] / scale])
    return out


def chosen(start: Start, held: Sequence[Any], loose: Sequence[str], size: float) -> set[Key]:
    """Return the coordinates to start from, of a model that these joints and drivers hold."""
    wanted = coordinates(held, loose, size)
    joints = [Function(joint.bodies, lambda poses, joint=joint: rows(joint, poses, size)) for joint in held]
    free = _null(_jacobian(start, joints, size))
    if not free.shape[1] or not wanted:
        return set()
    moved = _jacobian(start, list(wanted.values()), size) @ free
    return {list(wanted)[k] for k in _independent(moved)}


def _jacobian(start: Start, functions: Sequence[Function], size: float) -> Array:
    """Return (m, 3 bodies) all values by the bodies' coordinates, by differences."""
    names = [name for name in start.poses if name != GROUND]
    columns = {name: 3 * k for k, name in enumerate(names)}
    blocks: list[Array] = [np.zeros((0, 3 * len(names)))]
    for function in functions:
        block = np.zeros((len(function.value(start.poses)), 3 * len(names)))
        for name in set(function.bodies) - {GROUND}:
            for k, scale in enumerate((size, size, 1.0)):
                step = np.eye(3)[k] * STEP * scale
                ahead, back = (function.value({**start.poses, name: start.poses[name] + s * step}) for s in (1, -1))
                block[:, columns[name] + k] = (np.array(ahead) - np.array(back)) / (2 * STEP)
        blocks.append(block)
    return np.concatenate(blocks)


def _null(matrix: Array) -> Array:
    """Return (n, k) all that a matrix (m, n) takes to zero."""
    if not len(matrix):
        return np.eye(matrix.shape[1])
    _, values, rows = np.linalg.svd(matrix)
    return rows[int((values > ZERO * max(1.0, values.max(initial=0.0))).sum()) :].T


def _independent(matrix: Array) -> list[int]:
    """Return numbers of rows that are independent, as many as there are."""
    from scipy.linalg import qr

    r, pivots = qr(matrix.T, mode="r", pivoting=True)  # pyright: ignore[reportAssignmentType]
    sizes = np.abs(np.diag(r))
    return [int(k) for k in pivots[: int((sizes > ZERO * max(1.0, sizes.max(initial=0.0))).sum())]]


# Joints, drivers and forces as components of PlanarMechanics, or of the classes beside.

REVOLUTE, PRISMATIC = "Joints.Revolute", "Joints.Prismatic"


class Parts:
    """Adds them to a document; ``chosen`` are the coordinates that the model starts from."""

    def __init__(self, document: Document, places: Places, start: Start, chosen: Set[Key]) -> None:
        self._document, self._places, self._start, self._chosen = document, places, start, chosen

    def joint(self, joint: Any) -> None:
        """Add a joint of a kind of JOINTS."""
        JOINTS[joint.kind.name](self, joint, f"joint '{joint.name}' ({joint.kind.name})")

    def driver(self, driver: Any, time: float) -> None:
        """Add a driver whose law has a formula; ``time`` (s) is that of the start."""
        formula, turn = str(law(driver.motion)), 0.0
        if driver.kind.angular:  # bodies may have made whole turns more than the law
            value = float(driver.motion(np.array([time]))[0, 0])
            turn = math.tau * round((angle(self._start.poses, driver) - value) / math.tau)
        full = f"{formula} + {signed(turn)}" if turn else formula
        DRIVERS[driver.kind.name](self, driver, full, f"driver '{driver.name}' ({driver.kind.name})")

    def force(self, force: Any) -> None:
        """Add a force of a kind of FORCES, its amounts constant or by a formula."""
        FORCES[force.kind.name](self, force, f"force '{force.name}' ({force.kind.name})")

    def between(self, kind: str, thing: Any, words: str, **modifiers: str) -> None:
        """A component between the markers of a thing."""
        self._document.between(kind, thing.name, self.ends(thing), modifiers, words)

    def ends(self, thing: Any) -> tuple[str, str]:
        """Return frames of its markers."""
        return self._places.frame_at(thing.i, thing.name), self._places.frame_at(thing.j, thing.name)

    def revolute(self, joint: Any, words: str) -> None:
        """A pin."""
        self.between(REVOLUTE, joint, words, **self._turning(joint))

    def prismatic(self, joint: Any, words: str) -> None:
        """A guide, and a fixed angle where one body stands at an angle to the other."""
        first, second = self.ends(joint)
        ends = first, self._turned(joint, second)
        self._document.between(PRISMATIC, joint.name, ends, self._sliding(joint), words)

    def pin_in_slot(self, joint: Any, words: str) -> None:
        """A guide, and a pin on what slides there."""
        first, second = self.ends(joint)
        pin = self._document.add(REVOLUTE, self._document.names.new(joint.name, "pin"), self._turning(joint), words)
        self._document.connect(f"{pin}.frame_b", second)
        self._document.between(PRISMATIC, joint.name, (first, f"{pin}.frame_a"), self._sliding(joint), words)

    def weld(self, joint: Any, _: str) -> None:
        """A fixed angle, or nothing but a connection."""
        first, second = self.ends(joint)
        self._document.connect(first, self._turned(joint, second))

    def distance(self, joint: Any, words: str) -> None:
        """A rod."""
        self.between("MasslessRod", joint, words, l=number(joint.params["length"]))

    def angle_lock(self, joint: Any, words: str) -> None:
        """An angle that stays."""
        self.between("ImposedAngle", joint, words, phi=number(angle(self._start.poses, joint)))

    def wheels(self, joint: Any, words: str) -> None:
        """Gears or a belt, as they stand at the start."""
        [(a, b)] = joint.kind.numbers(joint.params)
        dx, dy = place(self._start.poses, joint.j) - place(self._start.poses, joint.i)
        first, second = (float(self._start.poses[marker.body.name][2]) for marker in (joint.i, joint.j))
        gamma = math.atan2(dy, dx)
        self.between(
            "RollingWheels", joint, words, a=number(a), b=number(b),
            c=number(a * (first - gamma) + b * (second - gamma)), gamma=f"(start={number(gamma)})",
            d=f"(start={number(math.hypot(dx, dy))})",
        )  # fmt: skip

    def rack(self, joint: Any, words: str) -> None:
        """A rack and its pinion, as they stand at the start."""
        radius = with_radii(joint.params)["radius"]
        meshing = along(self._start.poses, joint)[0] + radius * angle(self._start.poses, joint)
        self.between("RackAndPinion", joint, words, **_way(joint), radius=number(radius), c=number(meshing))

    def spring(self, force: Any, words: str) -> None:
        """A spring between two points."""
        length = float(np.hypot(*(place(self._start.poses, force.j) - place(self._start.poses, force.i))))
        amounts = _amounts(force, k="stiffness", c="damping", l0="free_length")
        self.between("LineSpring", force, words, **amounts, l=f"(start={number(length)})")

    def torsion_spring(self, force: Any, words: str) -> None:
        """A spring between two angles."""
        amounts = _amounts(force, k="stiffness", c="damping", phi0="free_angle")
        turn = angle(self._start.poses, force)
        self.between("AngleSpring", force, words, **amounts, phi=f"(start={number(turn)})")

    def push(self, force: Any, words: str) -> None:
        """A force from outside, along the x axis of its first marker."""
        self.between("AppliedForce", force, words, **_way(force), f=str(amount_of(force, "force")))

    def torque(self, force: Any, words: str) -> None:
        """A torque between two bodies."""
        self.between("AppliedTorque", force, words, tau=str(amount_of(force, "torque")))

    def _turned(self, joint: Any, second: str) -> str:
        """Return the frame of the second body, or that of a FixedRotation on it with the first body's angle."""
        alpha = angle(self._start.poses, joint)
        if abs(alpha) < SMALL:
            return second
        name = self._document.names.new(joint.name, "angle")
        words = f"angle of '{joint.j.body.name}' to '{joint.i.body.name}'"
        self._document.add("Parts.FixedRotation", name, {"alpha": number(alpha)}, words)
        self._document.connect(f"{name}.frame_b", second)
        return f"{name}.frame_a"

    def _turning(self, joint: Any) -> dict[str, str]:
        return self._variable(joint, "phi", "w", lambda poses: angle(poses, joint))

    def _sliding(self, joint: Any) -> dict[str, str]:
        return {"r": vector(math.cos(joint.i.angle), math.sin(joint.i.angle))} | self._variable(
            joint, "s", "v", lambda poses: along(poses, joint)[0]
        )

    def _variable(self, joint: Any, value: str, rate: str, of: Callable[[Any], float]) -> dict[str, str]:
        """Return start values, fixed if the model starts from them."""
        fixed = ", fixed=true" if (joint.name, value) in self._chosen else ""
        numbers = {value: of(self._start.poses), rate: self._start.rate(of)}
        return {key: f"(start={number(amount)}{fixed})" for key, amount in numbers.items()}


def _way(thing: Any) -> dict[str, str]:
    """Return the x axis of its first marker, in the axes of that body."""
    return {"ux": number(math.cos(thing.i.angle)), "uy": number(math.sin(thing.i.angle))}


def _amounts(force: Any, **names: str) -> dict[str, str]:
    """Return numbers of a force by the names of parameters."""
    return {name: number(force.params.get(amount, 0.0)) for name, amount in names.items()}


def amount_of(force: Any, name: str) -> str | None:
    """Return an amount of a force: a number, or the formula of its law; None for a law without one."""
    return law(force.laws[name]) if name in force.laws else number(force.params[name])


JOINTS: dict[str, Callable[[Parts, Any, str], None]] = {
    "revolute": Parts.revolute,
    "prismatic": Parts.prismatic,
    "pin_in_slot": Parts.pin_in_slot,
    "weld": Parts.weld,
    "distance": Parts.distance,
    "angle_lock": Parts.angle_lock,
    "gear_pair": Parts.wheels,
    "belt": Parts.wheels,
    "rack_and_pinion": Parts.rack,
}
DRIVERS: dict[str, Callable[[Parts, Any, str, str], None]] = {
    "drive_angle": lambda parts, driver, formula, words: parts.between("ImposedAngle", driver, words, phi=formula),
    "drive_relative_angle": lambda parts, driver, formula, words: parts.between(
        "ImposedAngle", driver, words, phi=formula
    ),
    "drive_distance": lambda parts, driver, formula, words: parts.between("MasslessRod", driver, words, l=formula),
    "drive_coordinate": lambda parts, driver, formula, words: parts.between(
        "ImposedCoordinate", driver, words, **_way(driver), s=formula
    ),
}
FORCES: dict[str, Callable[[Parts, Any, str], None]] = {
    "spring": Parts.spring,
    "torsion_spring": Parts.torsion_spring,
    "force": Parts.push,
    "torque": Parts.torque,
}
