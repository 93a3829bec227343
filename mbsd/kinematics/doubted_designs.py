"""Designs that a batch gives up near other assemblies: swept in finer steps, then one by one.

A batch looks at no pose between its steps, so it cannot tell a change point from a near miss. The march of a single
sweep can (march.py): it passes change points on the smooth continuation, and refuses what does not close.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace

import numpy as np

from mbsd.base.errors import MechanismError
from mbsd.equations.system import workspace
from mbsd.kinematics.design_sweeps import Batch, DesignSweeps
from mbsd.kinematics.groups.blocks import no_blocks
from mbsd.kinematics.groups.plan import plan_groups
from mbsd.kinematics.groups.registry import BRANCH
from mbsd.kinematics.march import march_along
from mbsd.kinematics.pose.close import assemble
from mbsd.kinematics.prepared import Prepared

FINER = 8
"""Times more steps with which designs are swept again."""


def settle(
    sweeps: DesignSweeps, finer: Callable[[], DesignSweeps], batch: Batch, values: np.ndarray, threads: int | None
) -> None:
    """Give designs of a ``batch`` that are doubted the results of sweeps that look closer.

    ``values`` (n, moved): their numbers against the mechanism's own (m). ``finer``: sweeps of the same with ``FINER``
    times more steps. A design whose sweep is refused does not close; one that starts on another branch stays doubted.
    """
    if not batch.doubted.any():
        return
    rows = batch.doubted.copy()
    _put(batch, rows, finer()(values[rows], threads))
    for row in np.flatnonzero(batch.doubted).tolist():
        try:
            q = _swept(sweeps, values[row])
        except MechanismError:
            batch.doubted[row] = False
            continue
        if q is not None:
            _put_alone(sweeps, batch, row, values[row], q)


def _put(batch: Batch, rows: np.ndarray, others: Batch) -> None:
    """Give some rows the results of ``others``."""
    for name, points in batch.points.items():
        points[rows] = others.points[name]
    for name, angles in batch.angles.items():
        angles[rows] = others.angles[name]
    batch.closes[rows], batch.doubted[rows] = others.closes, others.doubted


def _put_alone(sweeps: DesignSweeps, batch: Batch, row: int, values: np.ndarray, q: np.ndarray) -> None:
    """Give a row the traced points and angles of poses q (T, 3 nb)."""
    arms = sweeps.arms_of(values[None])[0]
    for points, body, (x, y) in zip(batch.points.values(), sweeps.bodies.tolist(), arms, strict=True):
        c, s = np.cos(q[:, 3 * body + 2]), np.sin(q[:, 3 * body + 2])
        points[row, :, 0] = q[:, 3 * body] + c * x - s * y
        points[row, :, 1] = q[:, 3 * body + 1] + s * x + c * y
    for angles, body in zip(batch.angles.values(), sweeps.turned.tolist(), strict=True):
        theta = q[:, 3 * body + 2]
        turns = round((sweeps.q0[3 * body + 2] - theta[0]) / math.tau)
        angles[row] = theta + math.tau * turns
    batch.closes[row], batch.doubted[row] = True, False


def _swept(sweeps: DesignSweeps, values: np.ndarray) -> np.ndarray | None:
    """Return the poses (T, 3 nb) of one design; None if it starts on another branch.

    Raises MechanismError.
    """
    ready, grid = sweeps.ready, sweeps.grid
    system = sweeps.system_of(values)
    scratch = workspace(system, len(ready.packed.ws.phi))
    packed = replace(ready.packed, system=system, ws=scratch, constant=None)
    q0 = assemble(sweeps.m, packed, float(grid[0]))
    groups = plan_groups(packed, q0, 0)
    if groups is None or (groups.kind != sweeps.groups.kind).any():
        return None
    for own, base, kind in zip(groups.number, sweeps.groups.number, groups.kind.tolist(), strict=True):
        if kind in BRANCH and own[BRANCH[kind]] * base[BRANCH[kind]] < 0.0:
            return None
    own = Prepared(packed, q0, ready.start_time, ready.sequence, ready.factors, ready.mobility, groups, no_blocks())
    return march_along(own, grid).q
