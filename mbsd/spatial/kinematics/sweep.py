"""A driven motion in space from start to end, as a Solution."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from mbsd.base.errors import SimulationError
from mbsd.kinematics.change_points.passages import determinant_of, sides_of
from mbsd.kinematics.steps import Steps
from mbsd.kinematics.sweep import sweep_times, switch_times
from mbsd.spatial.kinematics import newton
from mbsd.spatial.kinematics.march import SpaceMarch, refuse_disagreeing
from mbsd.spatial.kinematics.prepared import Prepared, prepare
from mbsd.spatial.model.mechanism import Model
from mbsd.spatial.results.reactions import Beside
from mbsd.spatial.results.solution import Solution


def sweep(
    m: Model,
    duration: float | None,
    steps: int,
    times: Sequence[float] | np.ndarray | None,
    switch_at: Sequence[float] | np.ndarray = (),
) -> Solution:
    """Return a sweep; see :meth:`mbsd.spatial.mechanism.Mechanism.sweep`."""
    same_fields: Any = m
    grid, switches = sweep_times(same_fields, duration, steps, times), switch_times(same_fields, switch_at)
    ready = prepare(m, float(grid[0]), float(grid[-1]))
    same_fields = ready.packed
    taken = Steps(same_fields, grid)
    march = march_along(ready, taken, not ready.mobility.redundant_rows, switches)
    motion = march.motion()
    sides = [(passage, side) for passage in march.passages.passages for side in sides_of(passage, motion.times)]
    beside = [
        Beside(side, determinant_of(passage, np.append(side.nodes, side.rows)), march.solve_beside(passage, side.nodes))
        for passage, side in sides
    ]
    if march.filled:
        march.balance(np.concatenate([np.zeros(0), *(side.rows for _, side in sides)]))
    ready.packed.check_callbacks(accepted=False)
    _refuse_jammed(ready, motion)
    return Solution(
        m, ready.packed, motion, taken.wanted, ready.mobility, ready.laws, dict(m.starts), beside,
        inserted_steps=taken.inserted,
    )  # fmt: skip


def march_along(ready: Prepared, steps: Steps, reactions: bool, switch_at: np.ndarray) -> SpaceMarch:
    """Return the motion at all steps, with or without reactions. Raises what says why it cannot go on.

    Reactions are found elsewhere where joints repeat each other. ``switch_at`` (n,): see Mechanism.sweep (s).
    """
    march = SpaceMarch(ready, steps, switch_at, reactions)
    march.follow()
    refuse_disagreeing(ready.packed, march.motion())
    march.fill()
    return march


def _refuse_jammed(ready: Prepared, motion: newton.DrivenMotion) -> None:
    """Raise SimulationError where reactions and the friction that they cause do not agree."""
    frictions = [force.name for force in ready.packed.forces if force.kind.friction_of is not None]
    jammed = np.flatnonzero(~np.isfinite(motion.lam).all(axis=1)) if frictions else []
    if len(jammed):
        raise SimulationError(
            f"{ready.packed.name}: at t = {motion.times[jammed[0]]:.6g} s reactions and friction do not agree: a joint "
            f"jams. Take less friction, or a longer guide, in {', '.join(map(repr, frictions))}"
        )
