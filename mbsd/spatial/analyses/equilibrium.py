"""Static equilibrium in space: the pose at which loads do no work in any motion that the joints allow.

    g = Z^T Q = 0        Z: motions that joints and drivers allow, J Z = 0;  Q: weight and forces at rest
    K = -Z^T d(Q - J^T lam) Z        lam: multipliers of the pose, kept;  d: by central differences

Each step solves with |K|, the matrix of the sizes of K's eigenvalues, so that it leads downhill also where K is not
definite, and is halved where it went past the next balance (Dauphin and others 2014, NeurIPS: saddle-free Newton).
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np

from mbsd.arrays.laws import compiled_laws
from mbsd.base.errors import AssemblyError, ModelError, SimulationError
from mbsd.base.names import Suggesting
from mbsd.kinematics.pose.held_values import RANK_TOLERANCE
from mbsd.results.views import DriverView
from mbsd.spatial.arrays.along import loads_along
from mbsd.spatial.arrays.packing import Packed, moved
from mbsd.spatial.equations.evaluation import wrenches_along
from mbsd.spatial.kinematics.close import CLOSED, assemble, close
from mbsd.spatial.kinematics.mobility import joint_mobility
from mbsd.spatial.kinematics.newton import DrivenMotion
from mbsd.spatial.kinematics.prepared import packed_checked
from mbsd.spatial.model.mechanism import Model
from mbsd.spatial.results.forces import ForceView, WrenchView
from mbsd.spatial.results.solution import Solution
from mbsd.spatial.results.views import FrameView, JointView

LONGEST = 0.3
"""Longest step, in sizes and rad."""
MOST_STEPS = 500
BESIDE = 1e-5
"""Change of a pose for differences, in sizes and rad."""
BALANCED = 1e-11
"""Part of the largest load that may be left."""
INDIFFERENT = 1e-9
"""Part of the largest stiffness below which one is zero."""


@dataclass(frozen=True, eq=False)
class Equilibrium(Suggesting):
    """A pose at which all loads balance; views have one row."""

    time: float
    """s, at which laws have their values."""
    stable: bool
    """True if every small motion is pulled back; False if one runs away or nothing resists it."""
    stiffness: np.ndarray
    """(f,) eigenvalues of K, rising, for motions of one size of the mechanism (m) or 1 rad (J)."""
    solution: Solution = field(repr=False)
    """The pose as a motion of one output, at rest."""

    def body(self, name: str) -> FrameView:
        """Return the frame of a body."""
        return self.solution.body(name)

    def joint(self, name: str) -> JointView:
        """Return place, reaction, turn and slide of a joint."""
        return self.solution.joint(name)

    def driver(self, name: str) -> DriverView:
        """Return value and effort of a driver."""
        return self.solution.driver(name)

    def force(self, name: str) -> ForceView | WrenchView:
        """Return what a force measures and pushes."""
        return self.solution.force(name)


class _Pose:
    """A mechanism at rest, its loads, and the motions that joints and drivers allow."""

    def __init__(self, m: Model, time: float) -> None:
        packed = self.packed = packed_checked(m)
        packed.settle_laws(time, time + 1.0)
        same_fields: Any = packed
        self.laws = compiled_laws(same_fields, time, time + 1.0)
        self.drives = packed.drives(np.array([time]))
        self.q, turns = assemble(m, packed, time)
        self.mobility = joint_mobility(packed, self.q)
        self.drives[:, :, 1:] = 0.0
        packed.ws.guess[:] = turns
        self.times = np.array([time])

    def motion(self, q: np.ndarray, turns: np.ndarray) -> DrivenMotion:
        """Return rest at q as a motion of one row."""
        packed, none = self.packed, np.zeros(1)
        rest = np.zeros((1, packed.freedoms + 3))
        return DrivenMotion(
            times=self.times, drives=self.drives, stride=none, q=q[None], dq=q[None], ddq=q[None], v=rest, a=rest,
            turn=turns[None], turn_rate=turns[None], residual=none, margin=none, determinant=none[:, None],
            lam=np.zeros((1, len(packed.ws.phi))), wrench=np.zeros((1, len(packed.passive_joints), 6)),
        )  # fmt: skip

    def loads(self, q: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Return loads (6 n,) in sizes and rad, dimensionless J (h, 6 n), and multipliers of rows of forces."""
        self.packed.measured(q, self.drives[0])
        turns = self.packed.ws.turn.copy()
        load, lam = loads_along(self.packed, self.laws, self.motion(q, turns))
        return load[0, 3:] * self.packed.column_scale, self.packed.scaled(q), lam[0]

    def balance(self, q: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
        """Return Z (6 n, f), g (f,), multipliers (h,) of rows in sizes, and the loads."""
        load, jac, _ = self.loads(q)
        if not np.isfinite(load).all():
            raise ModelError(f"{self.packed.name}: forces are not finite at rest in the pose that was tried")
        _, singular, v = np.linalg.svd(jac, full_matrices=True)
        free = v[int((singular > RANK_TOLERANCE * max(1.0, singular.max(initial=0.0))).sum()) :].T
        lam = np.linalg.lstsq(jac.T, load, rcond=1e-12)[0]
        return free, free.T @ load, lam, load

    def stiffness(self, q: np.ndarray, free: np.ndarray, lam: np.ndarray) -> np.ndarray:
        """Return K (f, f) at q."""
        columns = []
        for way in free.T:
            sides = []
            for sign in (1.0, -1.0):
                load, jac, _ = self.loads(moved(q, sign * BESIDE * way * self.packed.column_scale))
                sides.append(load - jac.T @ lam)
            columns.append(-free.T @ (sides[0] - sides[1]) / (2.0 * BESIDE))
        return np.array(columns).T.reshape(free.shape[1], free.shape[1])

    def moved(self, q: np.ndarray, way: np.ndarray) -> tuple[np.ndarray, float]:
        """Return the closed pose at a way (6 n,) from q, in sizes and rad, and what is open."""
        self.packed.ws.guess[:] = self.packed.ws.turn
        return close(self.packed, moved(q, way * self.packed.column_scale), self.drives[0])


def equilibrium(m: Model, time: float, nearest: bool) -> Equilibrium:
    """Return the equilibrium; see :meth:`mbsd.spatial.mechanism.Mechanism.equilibrium`."""
    pose = _Pose(m, time)
    q, packed = pose.q, pose.packed
    for _ in range(MOST_STEPS):
        free, g, lam, load = pose.balance(q)
        scale = float(np.abs(load).max(initial=0.0)) + float(np.abs(packed.system.mass).sum()) * pose_weight(packed)
        matrix = pose.stiffness(q, free, lam)
        values, ways = np.linalg.eigh(0.5 * (matrix + matrix.T)) if len(g) else (np.zeros(0), np.zeros((0, 0)))
        floor = INDIFFERENT * float(np.abs(values).max(initial=0.0))
        unstable = len(values) > 0 and values[0] < -max(floor, BALANCED * scale)
        if np.abs(g).max(initial=0.0) <= BALANCED * max(scale, 1e-300):
            if nearest or not unstable:
                return _found(m, pose, q, time, values, floor)
            step = free @ (0.1 * LONGEST * ways[:, 0])  # off the top, to either side
        elif nearest:
            step = free @ np.linalg.lstsq(matrix, g, rcond=1e-12)[0]
        else:
            step = free @ (ways @ ((ways.T @ g) / np.maximum(np.abs(values), max(floor, 1e-12 * scale))))
        q = _stepped(pose, q, step, free, g, nearest)
    raise SimulationError(
        f"{packed.name}: no pose balances near the start: after {MOST_STEPS} steps a load of "
        f"{float(np.abs(g).max()):.3g} J by size or rad is left. Something may fall or turn without end: hold it by a "
        "joint or a spring, or start nearer with start_near"
    )


def pose_weight(packed: Packed) -> float:
    """Return gravity times the size of a mechanism (m^2/s^2)."""
    return float(np.linalg.norm(packed.system.gravity)) * packed.size


def _stepped(
    pose: _Pose, q: np.ndarray, step: np.ndarray, free: np.ndarray, g: np.ndarray, nearest: bool
) -> np.ndarray:
    """Return the pose after a step of limited length, halved until it does not go past a balance."""
    step = step * min(1.0, LONGEST / max(float(np.abs(step).max(initial=0.0)), 1e-300))
    ahead = float((free @ g) @ step)
    for _ in range(40):
        trial, open_by = pose.moved(q, step)
        if open_by <= CLOSED:
            _, new, _, load = pose.balance(trial)
            smaller = float(np.linalg.norm(new)) < float(np.linalg.norm(g))
            if smaller if nearest else float(load @ step) >= -0.9 * abs(ahead) - 1e-300:
                return trial
        step = 0.5 * step
        ahead *= 0.5
    if open_by > CLOSED:
        raise AssemblyError(
            f"{pose.packed.name}: joints do not close on the way to the equilibrium; start nearer to it"
        )
    return trial


def _found(m: Model, pose: _Pose, q: np.ndarray, time: float, values: np.ndarray, floor: float) -> Equilibrium:
    packed = pose.packed
    load, jac, lam = pose.loads(q)
    motion = pose.motion(q, packed.ws.turn.copy())
    held = np.linalg.lstsq(jac.T, load, rcond=1e-12)[0] * packed.row_scale
    motion.lam[0] = lam
    motion.lam[0, : len(held)] = held
    wrenches_along(packed.system, pose.drives, motion.q, packed.ws, motion.lam, motion.wrench)
    solution = Solution(m, packed, motion, np.ones(1, bool), pose.mobility, pose.laws, dict(m.starts), steps=1)
    return Equilibrium(time, bool((values > floor).all()), values, solution)
