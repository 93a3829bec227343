"""Constraints of relative pose as arrays, and what the closed start pose decides about them.

Gears, racks and belts hold how bodies roll on each other, not where they stand: the constant of such a *phased* row
is the value that F has when all other constraints are closed, unless the joint gives angles that belong together.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from mbsd.base.errors import AssemblyError
from mbsd.equations.constraints.relative import ACTIVE, ARM, AT, MARKER_I, MARKER_J, ROW
from mbsd.model.joint import Joint
from mbsd.model.joints.kind import SPECIALS

if TYPE_CHECKING:
    from mbsd.arrays.packing import Packed
    from mbsd.compiling.callback import Callback

SAME_PLACE = 1e-6
"""Pins within this part of the mechanism's size are at one place."""


@dataclass
class Specials:
    """The special constraints of a mechanism in the order of the table ``System.special``."""

    mechanism: str
    names: list[str] = field(default_factory=list)
    joints: list[Joint] = field(default_factory=list)
    places: list[tuple[int, int, int, int]] = field(default_factory=list)
    """Marker i, marker j, row, motion."""
    callbacks: list[Callback] = field(default_factory=list)
    """Functions of the user; kept alive here."""

    def add(self, constraint: str, joint: Joint, place: tuple[int, int, int, int]) -> None:
        """One more."""
        self.names.append(constraint)
        self.joints.append(joint)
        self.places.append(place)

    @property
    def angular_rows(self) -> list[int]:
        """Rows whose residual is an angle."""
        entries = zip(self.names, self.joints, self.places, strict=True)
        return [place[2] for name, joint, place in entries if joint.params.get("unit", SPECIALS[name].unit) == "rad"]

    @property
    def phased(self) -> list[int]:
        """Entries whose constant comes from the start pose."""
        return [k for k, name in enumerate(self.names) if SPECIALS[name].phased]

    def arrays(self, marker_body: np.ndarray, size: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """The table (k, 7), the addresses (k,) and all numbers, for System. ``size``: of the mechanism (m)."""
        if not self.names:
            return np.zeros((0, 7), np.int64), np.zeros(0, np.int64), np.zeros(0)
        from mbsd.equations.relative.equation import address_of

        rows, numbers, at = [], [], 0
        for joint, place in zip(self.joints, self.places, strict=True):
            own = self._own_numbers(joint, place, size)
            block = [joint.j.angle - joint.i.angle, 0.0, 0.0, 1.0, *own]
            rows.append((*place, at, marker_body[place[0]], 1))
            numbers.append(block)
            at += len(block)
        addresses = [address_of(SPECIALS[name].equation) for name in self.names]
        return np.array(rows, np.int64), np.array(addresses, np.int64), np.concatenate(numbers)

    def _own_numbers(self, joint: Joint, place: tuple[int, int, int, int], size: float) -> list[float]:
        if "function" in joint.params:
            from mbsd.arrays.user_constraint import derivatives

            self.callbacks.append(
                derivatives(joint.params["function"], f"{self.mechanism}: joint '{joint.name}'", size)
            )
            return [float(self.callbacks[-1].address)]
        nth = sum(1 for other in self.places if other[:2] == place[:2] and other[2] < place[2])
        assert joint.kind.numbers is not None
        return [float(number) for number in joint.kind.numbers(joint.params)[nth]]

    def callback(self, what: str, make: Callable[[str], Callback]) -> Callback:
        """The function of the user that errors call ``what``: made once, and kept."""
        for made in self.callbacks:
            if made.what == what:
                return made
        self.callbacks.append(make(what))
        return self.callbacks[-1]

    def check(self) -> None:
        """Raise what a user's function raised since the last check."""
        for callback in self.callbacks:
            callback.check()


def let_phases_go(packed: Packed) -> None:
    """Leave the phased rows out, so that all others can be closed."""
    packed.system.special[packed.specials.phased, ACTIVE] = 0


def active_rows(packed: Packed) -> set[int]:
    """All rows but those that are left out."""
    special = packed.system.special
    return set(range(len(packed.ws.phi))) - {int(row) for row in special[special[:, ACTIVE] == 0, ROW]}


def take_phases(packed: Packed, q: np.ndarray, drive: np.ndarray) -> bool:
    """Set the constants of the phased rows from the pose q (3 nb,), where all other rows are closed.

    Returns whether joints gave angles that belong together, so that the pose must be closed again.
    """
    from mbsd.equations.assembly import residual_and_jacobian
    from mbsd.equations.relative.equation import DIRECTION, PHASE, WRAPS

    system, given = packed.system, False
    for k in packed.specials.phased:
        i, j, at = (int(system.special[k, column]) for column in (MARKER_I, MARKER_J, AT))
        arm = _arm_of(packed, q, i, j)
        if arm is not None:
            system.special[k, ARM] = arm
            line = _place(packed, q, j) - _place(packed, q, i)
            system.numbers[at + DIRECTION] = math.atan2(line[1], line[0]) - q[3 * arm + 2]
            # relative to the arm; the equation works in the axes of marker i
            system.numbers[at + DIRECTION] -= packed.specials.joints[k].i.angle
            system.numbers[at + WRAPS] = 0.0
        system.special[k, ACTIVE] = 1
        system.numbers[at + PHASE] = 0.0
        pose, phase = q, packed.specials.joints[k].params.get("phase")
        if phase is not None:
            given, pose = True, _turned_to(packed, q, (i, j), phase)
        residual_and_jacobian(system, pose, drive, packed.ws)
        system.numbers[at + PHASE] = packed.ws.equation[k, 0]
    return given


def refuse_impossible(packed: Packed, q: np.ndarray) -> None:
    """Raise AssemblyError for a joint that cannot be with its markers as they stand in the closed pose q (3 nb,)."""
    for joint, place in zip(packed.specials.joints, packed.specials.places, strict=True):
        if joint.kind.problem is None:
            continue
        i, j = place[:2]
        dx, dy = _place(packed, q, j) - _place(packed, q, i)
        turn = q[3 * packed.system.marker_body[i] + 2] + joint.i.angle
        c, s = math.cos(turn), math.sin(turn)
        problem = joint.kind.problem(joint.params, c * dx + s * dy, c * dy - s * dx)
        if problem is not None:
            raise AssemblyError(f"{packed.name}: {joint.kind.name} '{joint.name}': {problem}")


def _place(packed: Packed, q: np.ndarray, marker: int) -> np.ndarray:
    body = packed.system.marker_body[marker]
    c, s = math.cos(q[3 * body + 2]), math.sin(q[3 * body + 2])
    x, y = packed.system.marker_arm[marker]
    return q[3 * body : 3 * body + 2] + np.array([c * x - s * y, s * x + c * y])


def _arm_of(packed: Packed, q: np.ndarray, i: int, j: int) -> int | None:
    """The body with pins at the centres i and j: it carries the line of centres, ground too. None if there is none."""
    centres = _place(packed, q, i), _place(packed, q, j)
    pins: list[set[int]] = []
    for centre, own in zip(centres, (i, j), strict=True):
        found = {int(packed.system.marker_body[own])}
        for joint, markers in zip(packed.joints, packed.markers, strict=True):
            if joint.kind.name == "revolute":
                near = np.linalg.norm(_place(packed, q, markers[0]) - centre) < SAME_PLACE * packed.size
                found |= {int(packed.system.marker_body[marker]) for marker in markers} if near else set()
        pins.append(found)
    return min(pins[0] & pins[1], default=None)


def _turned_to(packed: Packed, q: np.ndarray, markers: tuple[int, int], angles: tuple[float, float]) -> np.ndarray:
    """The pose with both bodies turned about their markers to the given angles (rad)."""
    out = q.copy()
    for marker, angle in zip(markers, angles, strict=True):
        body = int(packed.system.marker_body[marker])
        if body:
            centre = _place(packed, q, marker)
            out[3 * body + 2] = angle
            out[3 * body : 3 * body + 2] += centre - _place(packed, out, marker)
    return out
