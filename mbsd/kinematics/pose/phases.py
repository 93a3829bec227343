"""Phases of constraints of relative pose, which the closed start pose decides.

Gears, racks and belts hold how bodies roll on each other, not where they stand: the constant of such a *phased* row
is the value that F has when all other constraints are closed, unless the joint gives angles that belong together.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from mbsd.base.errors import AssemblyError
from mbsd.equations.relative.equation import ACTIVE, ARM, AT, MARKER_I, MARKER_J, ROW

if TYPE_CHECKING:
    from mbsd.arrays.packing import Packed


SAME_PLACE = 1e-6
"""Pins within this part of the mechanism's size are at one place."""


def let_phases_go(packed: Packed) -> None:
    """Leave the phased rows out, so that all others can be closed."""
    if packed.specials.phased:
        special = packed.system.special.copy()
        special[packed.specials.phased, ACTIVE] = 0
        packed.system = packed.system.changed(special=special)


def active_rows(packed: Packed) -> set[int]:
    """Return all rows but those that are left out."""
    special = packed.system.special
    return set(range(len(packed.ws.phi))) - {int(row) for row in special[special[:, ACTIVE] == 0, ROW]}


def take_phases(packed: Packed, q: np.ndarray, drive: np.ndarray, entries: Sequence[int] | None = None) -> bool:
    """Set the constants of the phased rows from the pose q (3 nb,), where all other rows are closed.

    ``entries`` of the table of special constraints: by default all that are phased. Returns True if joints gave angles
    that belong together, so that the pose must be closed again.
    """
    from mbsd.equations.assembly import residual_and_jacobian
    from mbsd.equations.relative.equation import DIRECTION, PHASE, WRAPS

    given, phased = False, packed.specials.phased if entries is None else entries
    if not phased:
        return given
    special, numbers = packed.system.special.copy(), packed.system.numbers.copy()
    system = packed.system.changed(special=special.view(), numbers=numbers.view())  # sees what is written here
    pins = _pins_of(packed, q)
    for k in phased:
        i, j, at = (int(system.special[k, column]) for column in (MARKER_I, MARKER_J, AT))
        joint = packed.specials.joints[k]
        arm = _arm_of(packed, q, pins, i, j)
        if arm is None and packed.specials.names[k] == "span":
            arm = 0  # a cable between two carriers does not turn round in the world
        if arm is not None:
            special[k, ARM] = arm
            line = _place(packed, q, j) - _place(packed, q, i)
            numbers[at + DIRECTION] = math.atan2(line[1], line[0]) - q[3 * arm + 2]
            # relative to the arm; the equation works in the axes of marker i
            numbers[at + DIRECTION] -= joint.i.angle
            numbers[at + WRAPS] = 0.0
        special[k, ACTIVE] = 1
        numbers[at + PHASE] = 0.0
        pose, phase = q, joint.params.get("phase")
        together, total = joint.params.get("together"), joint.params.get("total")
        if together is not None and arm is not None:
            phase = (together[0] + q[3 * arm + 2], together[1] + q[3 * arm + 2])
        if phase is not None:
            given, pose = True, _turned_to(packed, q, (i, j), phase)
        residual_and_jacobian(system, pose, drive, packed.ws)
        numbers[at + PHASE] = packed.ws.equation[k, 0] - joint.params.get("slack", 0.0)
        if total is not None:
            given, numbers[at + PHASE] = True, total
    packed.system = system
    return given


def take_decided(packed: Packed, closed: Packed) -> None:
    """Copy phases and turns from a closed packing; either may have more joints after the common ones."""
    arrays = {}
    for name in ("special", "numbers", "angle_offset"):
        array, decided = getattr(packed.system, name).copy(), getattr(closed.system, name)
        common = min(len(array), len(decided))
        array[:common] = decided[:common]
        arrays[name] = array
    packed.system = packed.system.changed(**arrays)
    packed.phases |= closed.phases


def refuse_impossible(packed: Packed, q: np.ndarray) -> None:
    """Raise AssemblyError for a joint that is impossible at the markers of the closed pose q (3 nb,)."""
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


class _Pins(NamedTuple):
    """All pins in a pose."""

    places: np.ndarray
    """(k, 2) m."""
    bodies: np.ndarray
    """(k, 2) numbers of the bodies that each joins."""


def _pins_of(packed: Packed, q: np.ndarray) -> _Pins:
    markers = [pair for joint, pair in zip(packed.joints, packed.markers, strict=True) if joint.kind.pair == "pin"]
    both = np.array(markers, dtype=np.int64).reshape(-1, 2)
    places = np.array([_place(packed, q, i) for i in both[:, 0]]).reshape(-1, 2)
    return _Pins(places, packed.system.marker_body[both])


def _arm_of(packed: Packed, q: np.ndarray, pins: _Pins, i: int, j: int) -> int | None:
    """Return the body with pins at the centres i and j, also ground; None if there is none.

    It carries the line of centres.
    """
    sharing: list[set[int]] = []
    for marker in (i, j):
        near = np.hypot(*(pins.places - _place(packed, q, marker)).T) < SAME_PLACE * packed.size
        sharing.append({int(packed.system.marker_body[marker]), *pins.bodies[near].ravel().tolist()})
    return min(sharing[0] & sharing[1], default=None)


def _turned_to(packed: Packed, q: np.ndarray, markers: tuple[int, int], angles: tuple[float, float]) -> np.ndarray:
    """Return the pose with both bodies turned about their markers to the given angles (rad)."""
    out = q.copy()
    for marker, angle in zip(markers, angles, strict=True):
        body = int(packed.system.marker_body[marker])
        if body:
            centre = _place(packed, q, marker)
            out[3 * body + 2] = angle
            out[3 * body : 3 * body + 2] += centre - _place(packed, out, marker)
    return out
