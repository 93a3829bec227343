"""Twins: other ways to close the links that are as near to start_near as the one that is taken.

Near is, in radians, the root of the sum of squares of how far bodies turn from their rough angles, and of how far they
move, in sizes, from places that were given. Bodies without a rough angle count from zero, as they start there. The
other way is looked for on the other side of the rough angles: of all bodies, and of one after the other.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from mbsd.arrays.packing import Packed, pack
from mbsd.base.errors import MechanismError
from mbsd.kinematics.pose.close import CLOSED, assemble, close_with_phases, placed_pose, rough_pose, unwind_angles
from mbsd.model.mechanism import Model

AS_NEAR = 1.05
"""Another way up to so many times as far off is as near."""
APART = math.radians(30)
"""A body turned by less is in the same assembly, moved a little."""
MOST_BODIES = 40
"""In larger mechanisms nobody looks."""


@dataclass(frozen=True)
class Twin:
    """Two ways to close."""

    body: str
    """Body that differs most."""
    taken: float
    """Its angle (rad)."""
    other: float
    """And in the other way (rad)."""


def twin(m: Model) -> Twin | None:
    """Return the start pose's twin at time 0, if it has one; None also where nothing closes."""
    if not 2 <= len(m.bodies) <= MOST_BODIES or any(not joint.kind.saved for joint in m.joints.values()):
        return None
    try:
        packed = pack(m)
        drive = packed.drives(np.zeros(1))[0]
        q = assemble(m, packed, 0.0)
    except MechanismError:
        return None  # whoever solves it says why
    rough = rough_pose(m, packed, drive, 0)
    away = _turns(q, rough)
    own = _distance(m, packed, q, rough)
    if own < APART / 2:
        return None
    turned = np.flatnonzero(np.abs(away) > APART / 4)
    for flipped in [turned, *turned[:, None]]:
        angle = q[2::3].copy()
        angle[flipped] = rough[2::3][flipped] - away[flipped]
        guess = placed_pose(m, packed, angle)
        unwind_angles(packed, guess)
        other, worst = close_with_phases(m, packed, guess, drive)
        if worst > CLOSED or _distance(m, packed, other, rough) > AS_NEAR * own:
            continue
        apart = np.abs(_turns(other, q))
        apart[_alike(m, packed, apart)] = 0.0
        b = int(np.argmax(apart))
        if apart[b] > APART:
            return Twin(packed.body_names[b], *(math.remainder(float(k[3 * b + 2]), math.tau) for k in (q, other)))
    return None


def _alike(m: Model, packed: Packed, apart: np.ndarray) -> list[int]:
    """Return bodies with a rotational symmetry (:attr:`JointKind.symmetry`), turned by whole steps of it."""
    out = []
    for joint in m.joints.values():
        if joint.kind.symmetry is not None:
            b = packed.body_names.index(joint.j.body.name)
            steps = apart[b] * joint.kind.symmetry(joint.params) / math.tau
            if abs(steps - round(steps)) < 1e-6:
                out.append(b)
    return out


def _turns(q: np.ndarray, other: np.ndarray) -> np.ndarray:
    """Return (nb,) angles from one pose to another, within half a turn."""
    gap = q[2::3] - other[2::3]
    return gap - 2 * math.pi * np.round(gap / (2 * math.pi))


def _distance(m: Model, packed: Packed, q: np.ndarray, rough: np.ndarray) -> float:
    squares = [_turns(q, rough) ** 2]
    for name, start in m.starts.items():
        if start.place is not None:
            b = packed.body_names.index(name)
            squares.append(((q[3 * b : 3 * b + 2] - rough[3 * b : 3 * b + 2]) / packed.size) ** 2)
    return float(np.sqrt(np.concatenate(squares).sum()))
