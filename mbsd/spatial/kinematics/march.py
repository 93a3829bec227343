"""A driven motion in space by Newton-Raphson: its march along steps, and the errors of those that nothing cures.

The march is that of the plane (mbsd/kinematics/newton_march.py), and so are passages past change points: polynomials
through Euler parameters, from which velocities follow by w = 2 e' e^-1 and w' = 2 e'' e^-1.
"""

from __future__ import annotations

from typing import Any, ClassVar

import numpy as np

from mbsd.base.errors import AssemblyError
from mbsd.kinematics.change_points import assemblies
from mbsd.kinematics.change_points.passages import Passage
from mbsd.kinematics.elimination import Elimination, Factors
from mbsd.kinematics.march import REDUNDANT_GAP, error_of_step
from mbsd.kinematics.newton import DONE
from mbsd.kinematics.newton_march import NewtonMarch
from mbsd.kinematics.steps import Steps
from mbsd.spatial.arrays.along import tabulated
from mbsd.spatial.arrays.packing import Packed, moved
from mbsd.spatial.kinematics import newton
from mbsd.spatial.kinematics.close import gap_in_words
from mbsd.spatial.kinematics.mobility import better_rows_at
from mbsd.spatial.kinematics.prepared import Prepared, planned
from mbsd.spatial.model.rotation import product

NEARER = 0.1
"""Part of its margin at which rows of redundant joints are looked at again."""
CONJUGATE = np.array([1.0, -1.0, -1.0, -1.0])


def room(packed: Packed, count: int, blocks: int, reactions: bool) -> dict[str, np.ndarray]:
    """Return the arrays of a motion of ``count`` steps; those of reactions only where these are solved, too."""
    turns, rows = len(packed.ws.guess), len(packed.ws.phi)
    widths = dict.fromkeys(("q", "dq", "ddq"), len(packed.design)) | dict.fromkeys(("v", "a"), packed.freedoms + 3)
    widths |= {"turn": turns, "turn_rate": turns, "determinant": blocks}
    arrays = {name: np.zeros((count, width)) for name, width in widths.items()}
    arrays |= {"residual": np.zeros(count), "margin": np.zeros(count)}
    if reactions:
        arrays |= {"lam": np.zeros((count, rows)), "wrench": np.zeros((count, len(packed.passive_joints), 6))}
    return arrays


def motion_of(
    packed: Packed, times: np.ndarray, drives: np.ndarray, stride: np.ndarray, arrays: dict[str, np.ndarray]
) -> newton.DrivenMotion:
    """Return these arrays by :func:`room` as kernels read them."""
    none = {"lam": np.zeros((0, len(packed.ws.phi))), "wrench": np.zeros((0, len(packed.passive_joints), 6))}
    return newton.DrivenMotion(times=times, drives=drives, stride=stride, **(none | arrays))


class SpaceSolver(assemblies.Solver):
    """Newton-Raphson along ways of the drivers past a change point."""

    def __init__(self, ready: Prepared, arrays: dict[str, np.ndarray], sequence: Elimination, factors: Factors) -> None:
        """``arrays``: those of the march, whose turns are counted on."""
        same_fields: Any = ready.packed
        super().__init__(same_fields, sequence, factors)
        self._ready, self._arrays = ready, arrays
        self._turns = ready.turns

    def start_from(self, row: int) -> None:
        """Count turns from those of a step."""
        self._turns = self._arrays["turn"][row].copy()

    def exchanged(self, q: np.ndarray, drive: np.ndarray) -> SpaceSolver | None:
        """Return a solver with rows that are further from dependent at a pose q (3 + 7 n,); None if there are none."""
        del drive
        packed: Any = self.packed
        packed.ws.guess[:] = self._turns
        kept = better_rows_at(packed, q, self.sequence.rows.astype(np.int64))
        return None if kept is None else SpaceSolver(self._ready, self._arrays, *planned(packed, kept))

    def walk(self, way: assemblies.Way, pose: np.ndarray, p: np.ndarray) -> tuple[np.ndarray, ...] | None:
        """Return q, dq/dp, d2q/dp2 (P, 3 + 7 n) and determinants (P, d); see the plane."""
        packed: Any = self.packed
        sign = 1.0 if len(p) < 2 or p[1] > p[0] else -1.0
        drives = way.drives(p, sign)
        arrays = room(packed, len(p), len(self.sequence.ends), False)
        arrays["q"][0], arrays["turn"][0] = pose, self._turns
        motion = motion_of(packed, sign * p, drives, np.full(drives.shape[1], np.inf), arrays)
        unguarded = len(p) - 1
        status, _ = newton.sweep(
            packed.system,
            self._ready.laws,
            self.sequence,
            self.factors,
            packed.ws,
            packed.size,
            motion,
            0,
            unguarded,
            0.0,
        )
        return (motion.q, sign * motion.dq, motion.ddq, motion.determinant) if status == DONE else None

    def extent(self, change: np.ndarray) -> float:
        """Return largest part of changes (..., 3 + 7 n), in sizes and rad."""
        parts = change[..., 3:].reshape(-1, 7) / ([self.packed.size] * 3 + [0.5] * 4)
        return float(np.abs(parts).max(initial=0.0))

    def rows_at(self, way: assemblies.Way, q: np.ndarray, p: float) -> tuple[np.ndarray, np.ndarray]:
        """Return dimensionless Phi (6 n,) and J (6 n, 6 n) of the rows that are solved, at a pose q (3 + 7 n,)."""
        packed: Any = self.packed
        rows = self.sequence.rows.astype(np.int64)
        packed.ws.guess[:] = self._turns
        phi, jac = packed.measured(q, way.drives(np.array([p]))[0])
        scale = packed.row_scale[rows]
        return phi[rows] * scale, jac[rows] * scale[:, None] * packed.column_scale

    def moved(self, q: np.ndarray, change: np.ndarray) -> np.ndarray:
        """Return a pose q (3 + 7 n,) moved by ``change`` (6 n,), in sizes and rad."""
        scale: Any = self.packed.column_scale
        return moved(q, change * scale)


class SpaceMarch(NewtonMarch):
    """Newton-Raphson along the steps of a mechanism in space."""

    poses: ClassVar[tuple[str, str, str]] = ("q", "dq", "ddq")

    def __init__(self, ready: Prepared, steps: Steps, switch_at: np.ndarray, reactions: bool) -> None:
        self.packed, self.reactions = ready.packed, reactions
        self._part = NEARER if ready.mobility.redundant_rows else 0.0
        super().__init__(ready, steps, switch_at)

    def room(self) -> dict[str, np.ndarray]:
        """Return arrays for all steps, with the start in their first rows."""
        arrays = room(self.packed, len(self.steps.times), len(self.sequence.ends), self.reactions)
        arrays["q"][0], arrays["turn"][0] = self.ready.q0, self.ready.turns
        return arrays

    def solver(self) -> SpaceSolver:
        """Return Newton-Raphson with the rows in use, for passages."""
        return SpaceSolver(self.ready, self.arrays, self.sequence, self.factors)

    def motion(self) -> newton.DrivenMotion:
        """Return the motion as kernels read it."""
        return motion_of(self.packed, self.steps.times, self.steps.drives, self.steps.stride, self.arrays)

    def solve(self, first: int, chosen: int) -> tuple[int, int]:
        """Solve the steps from ``first`` on, by rows chosen at ``chosen``; returns status and index."""
        return self._swept(self.motion(), first, chosen, self._part)

    def _swept(self, motion: newton.DrivenMotion, first: int, chosen: int, part: float) -> tuple[int, int]:
        packed = self.packed
        return newton.sweep(
            packed.system, self.ready.laws, self.sequence, self.factors, packed.ws, packed.size, motion, first, chosen,
            part,
        )  # fmt: skip

    def exchange(self, solver: assemblies.Solver) -> None:
        """Go on with the rows of a solver, which depend less on each other than those in use."""
        super().exchange(solver)
        self._part = NEARER

    def is_solved(self, status: int) -> bool:
        """Return True if a step was refused because its rows come near to depend on each other."""
        if status == newton.NARROW:
            self._part *= 0.1
        return status == newton.NARROW

    def error_of_step(self, status: int, index: int) -> Exception:
        """Return the error for a refused step that nothing cures."""
        steps, v = self.steps, self.arrays["v"]
        rates = np.linalg.norm(v[:, 3:].reshape(len(v), -1, 6)[..., 3:], axis=-1)
        same_fields: Any = self.packed

        def weak(row: int) -> str:
            return f" at {weakest_joints(self.packed, self.arrays['q'][row])}"

        return error_of_step(same_fields, status, steps.times, index, steps.drives, rates, weak, "joint")

    def complete(self, rows: np.ndarray) -> None:
        """Fill velocities, accelerations and turns at ``rows`` (R,), whose coordinates are those of a passage."""
        self._complete(self.arrays, self.steps.times, self.steps.drives, rows)

    def beside(self, passage: Passage, times: np.ndarray) -> newton.DrivenMotion:
        """Return the motion at ``times`` (N,) near a change point, each pose solved by itself."""
        packed, drives, every = self.packed, self.packed.drives(times), np.arange(len(times))
        arrays = room(packed, len(times), len(self.sequence.ends), self.reactions)
        for name, part in zip(self.poses, passage.motion(times), strict=True):
            arrays[name][:] = part
        row = int(np.searchsorted(self.steps.times, times[0])) if len(times) else 0
        arrays["turn"][:1] = self.arrays["turn"][min(row, len(self.steps.times) - 1)]
        self._complete(arrays, times, drives, every)
        self._solve_alone(arrays, times, drives, every)
        return motion_of(packed, times, drives, self.steps.stride, arrays)

    def balance(self, passed: np.ndarray) -> None:
        """Find reactions at steps whose poses are those of a passage, but for the times ``passed`` (s)."""
        rows = np.unique(np.concatenate(self.filled))
        rows = rows[~np.isin(self.steps.times[rows], passed)]
        self._solve_alone(self.arrays, self.steps.times, self.steps.drives, rows)

    def _solve_alone(
        self, arrays: dict[str, np.ndarray], times: np.ndarray, drives: np.ndarray, rows: np.ndarray
    ) -> None:
        """Solve poses and reactions at ``rows`` (R,), each by itself from what the arrays hold there."""
        for k in rows if self.reactions else ():
            one = {name: array[k : k + 1] for name, array in arrays.items()}
            alone = motion_of(self.packed, times[k : k + 1], drives[k : k + 1], self.steps.stride, one)
            if self._swept(alone, 0, 0, 0.0)[0] != DONE:
                alone.lam[:] = alone.wrench[:] = np.nan

    def _complete(self, arrays: dict[str, np.ndarray], times: np.ndarray, drives: np.ndarray, rows: np.ndarray) -> None:
        """Fill velocities, accelerations and turns at rising ``rows`` (R,) from coordinates."""
        poses = [arrays[name][rows, 3:].reshape(len(rows), len(self.packed.bodies) - 1, 7) for name in self.poses]
        poses[0][..., 3:] /= np.linalg.norm(poses[0][..., 3:], axis=-1, keepdims=True)
        arrays["q"][rows, 3:] = poses[0].reshape(len(rows), len(self.packed.design) - 3)
        inverse = poses[0][..., 3:] * CONJUGATE
        for name, part in zip(("v", "a"), poses[1:], strict=True):
            turning = 2.0 * product(part[..., 3:], inverse)[..., 1:]
            arrays[name][rows, 3:] = np.concatenate([part[..., :3], turning], axis=-1).reshape(
                len(rows), self.packed.freedoms
            )
        ws, q, v, turn, rate = self.packed.ws, *(arrays[name] for name in ("q", "v", "turn", "turn_rate"))
        for k in rows if turn.shape[1] else ():
            guess = turn[k - 1] + (times[k] - times[k - 1]) * rate[k - 1] if k else turn[0]
            one = slice(k, k + 1)
            tabulated(self.packed, drives[one], q[one], v[one], guess[None])
            turn[k], rate[k] = ws.turn, ws.turn_rate


def refuse_disagreeing(packed: Packed, motion: newton.DrivenMotion) -> None:
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


def weakest_joints(packed: Packed, q: np.ndarray) -> str:
    """Return in words the joints whose rows are nearest to depend on each other at q (3 + 7 n,)."""
    jac = packed.scaled(q)
    left = np.linalg.svd(jac)[0][:, min(jac.shape) - 1]
    weights = [float(np.abs(left[packed.row_joint == k]).max(initial=0.0)) for k in range(len(packed.joints))]
    strongest = [k for k in np.argsort(weights)[::-1][:2] if weights[k] > 0.05]
    return "joint " + " and ".join(f"'{packed.joints[k].name}'" for k in strongest)
