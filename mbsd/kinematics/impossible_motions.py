"""Errors of impossible motions: a toggle, a jump to the other assembly, a joint that opens."""

from __future__ import annotations

import math

import numpy as np

from mbsd.arrays.packing import Packed
from mbsd.base.errors import AssemblyError, BranchError, SingularPoseError
from mbsd.base.quantity import written
from mbsd.equations.assembly import residual_and_jacobian
from mbsd.kinematics import newton as kinematics

RUNAWAY = 30.0
"""Turning this many times faster than usual is the mark of a toggle; at a change point rates stay as they are."""
REDUNDANT_GAP = 1e-7
"""Largest gap, in sizes, by which redundant joints may disagree."""


def out_of_reach(packed: Packed, time: float) -> Exception:
    """The error for a motion on whose way a group cannot close, whatever Newton-Raphson made of it."""
    return SingularPoseError(
        f"{packed.name}: the links cannot follow the drivers beyond t = {time:.9g} s "
        f"({driver_values(packed, packed.drives(np.array([time]))[0])}): a toggle, beyond which they do not "
        "reach each other. Drive within the reachable range, change the lengths, or drive another body."
    )


def refuse_disagreeing(
    packed: Packed, grid: np.ndarray, residual: np.ndarray, q: np.ndarray, drives: np.ndarray
) -> None:
    """Rows left out as redundant must hold too."""
    k = int(np.argmax(residual))
    if residual[k] <= REDUNDANT_GAP * max(packed.size, 1.0):
        return
    residual_and_jacobian(packed.system, q[k], drives[k], packed.ws)
    joint = packed.joint_of_row(int(np.argmax(np.abs(packed.ws.phi))))
    raise AssemblyError(
        f"{packed.name}: at t = {grid[k]:.6g} s redundant joint {joint.name} is open by "
        f"{residual[k]:.3g} (m or rad) while all others close: the lengths do not agree. "
        "Correct them, or leave the joint out."
    )


def refused(
    packed: Packed, status: int, grid: np.ndarray, index: int, drives: np.ndarray, q: np.ndarray, v: np.ndarray
) -> Exception:
    """The error for a step that halving does not cure."""
    last = max(index - 1, 0)
    rates = np.abs(v[last].reshape(-1, 3)[1:, 2])
    where = f"t = {grid[last]:.6g} s ({driver_values(packed, drives[last])})"
    if index == 0:
        return SingularPoseError(
            f"{packed.name}: the start pose at {where} is singular (a toggle or change point): "
            "the drivers do not fix the motion here. Start a little before or after it, or drive another body."
        )
    bodies = packed.body_names[1:]
    fastest = ", ".join(bodies[b] for b in np.argsort(-rates)[:2])
    usual = float(np.median(np.abs(v[: last + 1].reshape(last + 1, -1, 3)[:, 1:, 2]).max(axis=1)))
    if rates.max() > RUNAWAY * usual:
        return SingularPoseError(
            f"{packed.name}: the links cannot follow the drivers beyond {where}: a toggle, where {fastest} "
            f"run away ({written(rates.max(), 'rad/s')}, {written(usual, 'rad/s')} before). Drive within the "
            "reachable range, change the lengths, or drive another body."
        )
    if status == kinematics.BRANCH_DOUBT:
        return BranchError(
            f"{packed.name}: after {where} the motion would jump to the other assembly, and steps down to "
            f"{grid[index] - grid[last]:.1e} s do not cure it. A law jumps there, or the drivers rest where two "
            "assemblies meet; end the motion before it."
        )
    return SingularPoseError(
        f"{packed.name}: the pose at {where} is singular, and no smooth motion through it was found: the drivers do "
        "not decide how the links go on. End the motion before it, or add a link that decides."
    )


def driver_values(packed: Packed, drive: np.ndarray) -> str:
    """Return the values of the drivers in words."""
    parts = []
    for k, driver in enumerate(packed.drivers):
        value = float(drive[k + 1, 0])
        at = f"{math.degrees(value):.4g} degrees" if driver.kind.angular else f"{value:.4g} m"
        parts.append(f"{driver.name} at {at}")
    return ", ".join(parts)
