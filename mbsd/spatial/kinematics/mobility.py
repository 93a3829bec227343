"""Mobility in space: freedoms by count and by rank, redundant joints, rows that fix a driven motion.

    nominal  6 n - rows of all joints
    dof      6 n - rank J of the joints

The rank at one pose may be low by accident, so it is also taken at closed poses nearby, and the largest counts.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from mbsd.base.errors import MobilityError, ModelError, SingularPoseError
from mbsd.base.quantity import counted
from mbsd.kinematics.pose.held_values import independent_rows
from mbsd.kinematics.pose.mobility import better_rows, moving_bodies, refuse_idle_drivers
from mbsd.results.views import Mobility
from mbsd.spatial.arrays.packing import Packed, moved
from mbsd.spatial.kinematics.close import CLOSED, close

MOVED = 0.05
"""Size of the change, in sizes and rad, to poses at which the rank is taken, too."""


def joint_mobility(packed: Packed, q: np.ndarray) -> Mobility:
    """Return the mobility of the joints alone at the closed pose q (3 + 7 n,)."""
    rows = packed.driver_rows
    here = packed.scaled(q)[:rows]
    kept, best = independent_rows(here), here
    start = len(kept)
    if start < rows:
        for near in _nearby(packed, q):
            jac = packed.scaled(near)[:rows]
            independent = independent_rows(jac)
            if len(independent) > len(kept):
                kept, best = independent, jac
    same_fields: Any = packed
    dropped = [row for row in range(rows) if row not in set(kept)]
    free = packed.freedoms - len(kept)
    return Mobility(
        nominal=packed.freedoms - rows,
        dof=free,
        redundant_rows=len(dropped),
        redundant=tuple(dict.fromkeys(packed.joints[packed.row_joint[row]].name for row in dropped)),
        singular=start < len(kept),
        free_bodies=moving_bodies(same_fields, best, 6) if free else (),
    )


def refuse_shared_friction(packed: Packed, joints: Mobility) -> None:
    """Raise ModelError for friction of reactions that joints share."""
    frictions = [force.name for force in packed.forces if force.kind.friction_of is not None]
    if frictions and joints.redundant_rows:
        raise ModelError(
            f"{packed.name}: force '{frictions[0]}' is friction, and joints repeat each other here "
            f"({', '.join(map(repr, joints.redundant))}), so nothing says which of them carries. Replace a joint by a "
            "spherical or cylindrical one"
        )


def choose_rows(packed: Packed, q: np.ndarray, time: float, joints: Mobility) -> np.ndarray:
    """Return independent rows (6 n,) that fix all coordinates, drivers included.

    Raises MobilityError for a missing or superfluous driver, SingularPoseError where only this pose is at fault.
    """
    jac = packed.scaled(q)
    kept, best = independent_rows(jac), jac
    here = len(kept)
    if here < min(jac.shape):
        for near in _nearby(packed, q):
            matrix = packed.scaled(near)
            independent = independent_rows(matrix)
            if len(independent) > len(kept):
                kept, best = independent, matrix
    same_fields: Any = packed
    refuse_idle_drivers(same_fields, joints, kept, time)
    if len(kept) < packed.freedoms:
        raise MobilityError(_undriven(packed, best, packed.freedoms - len(kept), joints, time))
    if here < len(kept):
        raise SingularPoseError(
            f"{packed.name}: the start pose at t = {time:.6g} s is singular: {_singular_joints(packed, jac)} do not "
            "fix the motion here. Start a little before or after it with start_near, or drive another joint."
        )
    chosen = better_rows(jac, kept) if len(kept) < len(jac) else None
    return np.array(kept if chosen is None else chosen)


def better_rows_at(packed: Packed, q: np.ndarray, known: np.ndarray) -> np.ndarray | None:
    """Return rows that depend less on each other at q (3 + 7 n,); None if those known are good."""
    return better_rows(packed.scaled(q), known)


def _singular_joints(packed: Packed, jac: np.ndarray) -> str:
    """Return the joints and drivers whose rows depend on each other most, in words."""
    left = np.linalg.svd(jac)[0][:, min(jac.shape) - 1]
    weights = [float(np.abs(left[packed.row_joint == k]).max(initial=0.0)) for k in range(len(packed.joints))]
    strongest = np.argsort(weights)[::-1][:3]
    return ", ".join(f"'{packed.joints[k].name}'" for k in strongest if weights[k] > 0.1)


def _undriven(packed: Packed, jac: np.ndarray, missing: int, joints: Mobility, time: float) -> str:
    """Return the error text for freedoms that nothing drives."""
    floating = floating_bodies(packed)
    if floating:
        names = ", ".join(f"'{name}'" for name in floating)
        said = "it floats" if len(floating) == 1 else "they float"
        return (
            f"{packed.name}: no joint leads from ground to {names}: {said}, and no driver moves what floats. "
            "Add a joint, or leave it out."
        )
    same_fields: Any = packed
    moving = ", ".join(moving_bodies(same_fields, jac, 6))
    return (
        f"{packed.name}: at t = {time:.6g} s {missing} of {counted(joints.dof, 'degree')} of freedom "
        f"{'is' if missing == 1 else 'are'} not driven: {moving} can still move. "
        f"Add {'a driver' if missing == 1 else f'{missing} drivers'}, for example m.drive_turn(...)."
    )


def floating_bodies(packed: Packed) -> list[str]:
    """Return the names of bodies that no chain of joints connects with ground."""
    names = packed.body_names
    held, before = {"ground"}, 0
    while len(held) > before:
        before = len(held)
        held.update(name for joint in packed.joints if held.intersection(joint.bodies) for name in joint.bodies)
    return [name for name in names if name not in held]


def _nearby(packed: Packed, q: np.ndarray, tries: int = 3) -> list[np.ndarray]:
    """Return closed poses near q, with the drivers released."""
    random = np.random.default_rng(1)
    rows, poses = np.arange(packed.driver_rows), []
    none = np.zeros((len(packed.motions) + 1, 3))
    for _ in range(tries):
        change = MOVED * packed.column_scale * random.standard_normal(packed.freedoms)
        packed.ws.guess[:] = packed.ws.turn
        pose, worst = close(packed, moved(q, change), none, rows)
        if worst <= CLOSED:
            poses.append(pose)
    packed.measured(q)
    return poses
