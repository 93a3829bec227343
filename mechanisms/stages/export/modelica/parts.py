"""Joints, drivers and forces as components of PlanarMechanics, or of the classes beside."""

from __future__ import annotations

import math
from collections.abc import Callable, Set
from typing import Any

import numpy as np

from mbsd.model.teeth import with_radii
from mechanisms.stages.export.modelica.document import Document
from mechanisms.stages.export.modelica.expressions import law, number, signed, vector
from mechanisms.stages.export.modelica.freedoms import Key
from mechanisms.stages.export.modelica.places import SMALL, Places
from mechanisms.stages.export.modelica.start import Start, along, angle, place

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
        """Frames of its markers."""
        return self._places.at(thing.i, thing.name), self._places.at(thing.j, thing.name)

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
        """The frame of the second body, or that of a FixedRotation on it which has the angle of the first body."""
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
        """Start values, fixed if the model starts from them."""
        fixed = ", fixed=true" if (joint.name, value) in self._chosen else ""
        numbers = {value: of(self._start.poses), rate: self._start.rate(of)}
        return {key: f"(start={number(amount)}{fixed})" for key, amount in numbers.items()}


def _way(thing: Any) -> dict[str, str]:
    """The x axis of its first marker, in the axes of that body."""
    return {"ux": number(math.cos(thing.i.angle)), "uy": number(math.sin(thing.i.angle))}


def _amounts(force: Any, **names: str) -> dict[str, str]:
    """Numbers of a force by the names of parameters."""
    return {name: number(force.params.get(amount, 0.0)) for name, amount in names.items()}


def amount_of(force: Any, name: str) -> str | None:
    """An amount of a force: a number, or the formula of its law; None of a law without one."""
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
