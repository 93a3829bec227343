"""A driven motion in space from start to end, as a Solution.

The march is the planar one in short: steps that the kernel refuses are divided, rows of redundant joints are chosen
anew where those in use come near to depend on each other.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from mbsd.base.errors import AssemblyError, BranchError, SimulationError, SingularPoseError
from mbsd.base.quantity import written
from mbsd.kinematics.march import REDUNDANT_GAP, RUNAWAY, driver_values
from mbsd.kinematics.newton import BRANCH_DOUBT, DONE
from mbsd.kinematics.steps import Steps
from mbsd.kinematics.sweep import sweep_times
from mbsd.spatial.arrays.packing import Packed
from mbsd.spatial.kinematics import newton
from mbsd.spatial.kinematics.close import gap_in_words
from mbsd.spatial.kinematics.mobility import better_rows_at
from mbsd.spatial.kinematics.prepared import Prepared, planned, prepare
from mbsd.spatial.model.mechanism import Model
from mbsd.spatial.results.solution import Solution

NEARER = 0.1
"""Part of its margin at which rows of redundant joints are looked at again."""


def sweep(m: Model, duration: float | None, steps: int, times: Sequence[float] | np.ndarray | None) -> Solution:
    """Return a sweep; see :meth:`mbsd.spatial.mechanism.Mechanism.sweep`."""
    same_fields: Any = m
    grid = sweep_times(same_fields, duration, steps, times)
    ready = prepare(m, float(grid[0]), float(grid[-1]))
    same_fields = ready.packed
    taken = Steps(same_fields, grid)
    motion = march(ready, taken, not ready.mobility.redundant_rows)
    ready.packed.check_callbacks(accepted=False)
    _refuse_jammed(ready, motion)
    return Solution(
        m, ready.packed, motion, taken.wanted, ready.mobility, ready.laws, dict(m.starts), inserted_steps=taken.inserted
    )


def _refuse_jammed(ready: Prepared, motion: newton.DrivenMotion) -> None:
    """Raise SimulationError where reactions and the friction that they cause do not agree."""
    frictions = [force.name for force in ready.packed.forces if force.kind.friction_of is not None]
    jammed = np.flatnonzero(~np.isfinite(motion.lam).all(axis=1)) if frictions else []
    if len(jammed):
        raise SimulationError(
            f"{ready.packed.name}: at t = {motion.times[jammed[0]]:.6g} s reactions and friction do not agree: a joint "
            f"jams. Take less friction, or a longer guide, in {', '.join(map(repr, frictions))}"
        )


def _room(ready: Prepared, steps: Steps, reactions: bool) -> newton.DrivenMotion:
    """Return arrays for a motion at all steps, with the start in their first rows."""
    packed, count = ready.packed, len(steps.times)
    velocities, rows = packed.freedoms + 3, len(packed.ws.phi)
    q, dq, ddq = (np.zeros((count, len(ready.q0))) for _ in range(3))
    q[0] = ready.q0
    turn = np.zeros((count, len(ready.turns)))
    turn[0] = ready.turns
    balanced = count if reactions else 0
    return newton.DrivenMotion(
        times=steps.times, drives=steps.drives, stride=steps.stride, q=q, dq=dq, ddq=ddq,
        v=np.zeros((count, velocities)), a=np.zeros((count, velocities)),
        turn=turn, turn_rate=np.zeros_like(turn), residual=np.zeros(count), margin=np.zeros(count),
        determinant=np.zeros((count, len(ready.sequence.ends))),
        lam=np.zeros((balanced, rows)), wrench=np.zeros((balanced, len(packed.passive_joints), 6)),
    )  # fmt: skip


def march(ready: Prepared, steps: Steps, reactions: bool) -> newton.DrivenMotion:
    """Return the motion at all steps, with or without reactions. Raises what says why it cannot go on.

    Reactions are found elsewhere where joints repeat each other.
    """
    packed = ready.packed
    motion = _room(ready, steps, reactions)
    first, chosen, part = 0, 0, NEARER if ready.mobility.redundant_rows else 0.0
    while True:
        status, index = newton.sweep(
            packed.system, ready.laws, ready.sequence, ready.factors, packed.ws, packed.size, motion, first, chosen,
            part,
        )  # fmt: skip
        if status == DONE:
            break
        if index == 0:
            raise _refusal(packed, status, motion, 0)
        if steps.follow_laws():
            motion, first, chosen = _room(ready, steps, reactions), 0, 0
            continue
        if part and index - 1 > chosen:
            packed.ws.guess[:] = motion.turn[index - 1]
            kept = better_rows_at(packed, motion.q[index - 1], ready.sequence.rows.astype(np.int64))
            if kept is not None:
                ready.sequence, ready.factors = planned(packed, kept)
                first = chosen = index - 1
                motion = motion._replace(determinant=np.zeros((len(steps.times), len(ready.sequence.ends))))
                part = NEARER
                continue
        if status == newton.NARROW:
            first, part = index, 0.1 * part
            continue
        if not steps.divide(index):
            raise _refusal(packed, status, motion, index)
        motion = _divided(motion, steps, index)
        first = index
    _refuse_disagreeing(packed, motion)
    return motion


def _divided(motion: newton.DrivenMotion, steps: Steps, index: int) -> newton.DrivenMotion:
    """Return a motion with room for a step more before ``index``."""
    grown = {
        name: np.insert(part, index, 0.0, axis=0)
        for name, part in motion._asdict().items()
        if name not in ("times", "drives", "stride") and len(part)
    }
    return motion._replace(times=steps.times, drives=steps.drives, **grown)


def _refuse_disagreeing(packed: Packed, motion: newton.DrivenMotion) -> None:
    """Raise AssemblyError where rows that were left out as redundant do not hold."""
    k = int(np.argmax(motion.residual))
    if motion.residual[k] <= REDUNDANT_GAP * max(packed.size, 1.0):
        return
    phi, _ = packed.measured(motion.q[k], motion.drives[k])
    joint = packed.row_joint[int(np.argmax(np.abs(phi)))]
    raise AssemblyError(
        f"{packed.name}: at t = {motion.times[k]:.6g} s redundant joint '{packed.joints[joint].name}' is open by "
        f"{gap_in_words(packed, joint, phi)} while the others close: places or axes do not agree. Give axes with all "
        "their digits, or use a spherical or cylindrical joint instead."
    )


def _refusal(packed: Packed, status: int, motion: newton.DrivenMotion, index: int) -> Exception:
    """Return the error for a step that dividing does not cure."""
    last = max(index - 1, 0)
    same_fields: Any = packed
    where = f"t = {motion.times[last]:.6g} s ({driver_values(same_fields, motion.drives[last])})"
    if index == 0:
        return SingularPoseError(
            f"{packed.name}: the start pose at {where} is singular: the drivers do not fix the motion here. Start a "
            "little before or after it with start_near, or drive another joint."
        )
    rates = np.linalg.norm(motion.v[: last + 1, 3:].reshape(last + 1, -1, 6)[..., 3:], axis=-1)
    fastest = [packed.body_names[1 + b] for b in np.argsort(-rates[last])[:2]]
    usual = float(np.median(rates.max(axis=1)))
    weak = weakest_joints(packed, motion.q[last])
    if rates[last].max() > RUNAWAY * usual:
        return SingularPoseError(
            f"{packed.name}: the bodies cannot follow the drivers beyond {where}: a toggle at {weak}, where "
            f"{', '.join(fastest)} run away ({written(float(rates[last].max()), 'rad/s')}, {written(usual, 'rad/s')} "
            "before). Drive within reach, change the lengths, or drive another joint."
        )
    if status == BRANCH_DOUBT:
        return BranchError(
            f"{packed.name}: after {where} the motion would jump to another assembly at {weak}, and steps down to "
            f"{motion.times[index] - motion.times[last]:.1e} s do not cure it. A law jumps there, or two assemblies "
            "meet; end the motion before it."
        )
    return SingularPoseError(
        f"{packed.name}: the pose at {where} is singular at {weak}: the drivers do not decide how the bodies go on. "
        "End the motion before it, or add a joint that decides."
    )


def weakest_joints(packed: Packed, q: np.ndarray) -> str:
    """Return in words the joints whose rows are nearest to depend on each other at q (3 + 7 n,)."""
    jac = packed.scaled(q)
    left = np.linalg.svd(jac)[0][:, min(jac.shape) - 1]
    weights = [float(np.abs(left[packed.row_joint == k]).max(initial=0.0)) for k in range(len(packed.joints))]
    strongest = [k for k in np.argsort(weights)[::-1][:2] if weights[k] > 0.05]
    return "joint " + " and ".join(f"'{packed.joints[k].name}'" for k in strongest)
