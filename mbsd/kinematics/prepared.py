"""A mechanism made ready, and the march along its driven motion: refused steps are halved, errors are worded."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from mbsd.arrays.driver_laws import refuse_bad_laws
from mbsd.arrays.packing import Packed, pack
from mbsd.base.errors import AssemblyError, BranchError, ModelError, SingularPoseError
from mbsd.base.kept import Kept
from mbsd.base.quantity import written
from mbsd.equations.assembly import residual_and_jacobian, tabulate
from mbsd.equations.constraints.relative import ACTIVE, ROW
from mbsd.kinematics import newton as kinematics
from mbsd.kinematics.elimination import Elimination, Factors, plan
from mbsd.kinematics.groups.blocks import Blocks, no_blocks
from mbsd.kinematics.groups.carrying.rates import DOUBTED, OPEN, SOLVED
from mbsd.kinematics.groups.groups import Groups
from mbsd.kinematics.groups.parts import plan_parts
from mbsd.kinematics.groups.plan import describe, plan_groups
from mbsd.kinematics.groups.solve import solve_groups
from mbsd.kinematics.pose.close import assemble
from mbsd.kinematics.pose.mobility import best_rows, choose_rows, joint_mobility, refuse_overdriven
from mbsd.kinematics.steps import Steps
from mbsd.model.mechanism import Model
from mbsd.results.mobility import Mobility

ZERO_LENGTH = 1e-12
"""Square of a length in sizes below which it counts as zero."""
RUNAWAY = 30.0
"""Turning this many times faster than usual is the mark of a toggle; at a change point rates stay as they are."""
_SAMPLES: Kept[np.ndarray] = Kept()
REDUNDANT_GAP = 1e-7
"""Largest gap, in sizes, by which redundant joints may disagree."""


class March:
    """A motion at the times asked for, and at all steps on the way."""

    def __init__(self, q: np.ndarray, v: np.ndarray, a: np.ndarray, steps: Steps, closed: bool) -> None:
        self.steps, self.closed = steps, closed
        """``closed``: solved in closed form."""
        self._all = q, v, a
        every = slice(None) if steps.wanted.all() else steps.wanted
        self.q, self.v, self.a = q[every], v[every], a[every]
        """(T, 3 nb)"""

    def closely(self) -> tuple[np.ndarray, np.ndarray]:
        """Times (N,) and poses (N, 3 nb) of all steps and of seven times within each, by quintics through its ends."""
        from mbsd.model.cams.profile import hermite

        times, (q, v, a) = self.steps.times, self._all
        if len(times) < 2:
            return times, q
        h, samples = np.diff(times), np.stack([q, v, a], axis=-1)
        coefficients = hermite(h, samples[:-1], samples[1:])
        ahead = h[:, None] * np.arange(8) / 8
        poses = np.einsum("sxp,scp->sxc", ahead[..., None] ** np.arange(6), coefficients).reshape(-1, q.shape[1])
        inner = (times[:-1, None] + ahead).ravel()
        return np.append(inner, times[-1]), np.vstack([poses, q[-1:]])


@dataclass
class Prepared:
    """A mechanism ready to be solved over and over: arrays, closed start pose, elimination sequence."""

    packed: Packed
    q0: np.ndarray
    """(3 nb,) closed start pose."""
    start_time: float
    sequence: Elimination
    factors: Factors
    mobility: Mobility
    groups: Groups | None
    """Where the mechanism falls apart into groups and blocks; else Newton-Raphson solves it as a whole."""
    blocks: Blocks
    """What of it no closed form covers."""
    proved: bool = False
    """Whether joints that repeat others are sure to hold where these do not."""

    @property
    def route(self) -> str:
        """How positions are found, as long as no two assemblies meet on the way."""
        if self.groups is None:
            return "Newton-Raphson"
        how = "by parts" if len(self.blocks.head) else "closed form"
        return f"{how}: {describe(self.groups, self.blocks, self.packed.body_names)}"

    def kinematics(self, times: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """(T, nb, 3) positions, velocities and accelerations of the centres of mass and angles; ground is body 0."""
        motion = self.march(times)
        shape = (len(times), -1, 3)
        return motion.q.reshape(shape), motion.v.reshape(shape), motion.a.reshape(shape)

    def march(self, times: np.ndarray) -> March:
        """The motion at rising times (T,) (s): closed forms where they serve, else Newton-Raphson."""
        steps = Steps(self.packed, times)
        if self.groups is not None:
            marched = self._closed_form(self.groups, steps)
            if marched is not None:
                return March(*marched, steps, True)
        out_of_reach = steps.out_of_reach
        steps = Steps(self.packed, times)  # those of the closed form may be just where branches meet
        marched = self._newton(steps)
        if out_of_reach is not None:
            raise self._out_of_reach(out_of_reach)
        return March(*marched, steps, False)

    def _closed_form(self, groups: Groups, steps: Steps) -> tuple[np.ndarray, np.ndarray, np.ndarray] | None:
        """Positions, velocities, accelerations (T, 3 nb) at all steps; None where branches meet or a group opens."""
        n3, size, blocks = len(self.q0), self.packed.size, self.blocks
        turn, point, before = np.zeros((n3 // 3, 2)), np.zeros((4, 8)), np.zeros((len(groups.kind), 2))
        turn[0, 0] = 1.0
        q, v, a = (np.zeros((len(steps.times), n3)) for _ in range(3))
        determinant = np.zeros((len(blocks.head), len(steps.times), 1))
        first = 0
        while True:
            status, index, part = solve_groups(
                groups, blocks, self.q0, steps.times, steps.drives, steps.stride, ZERO_LENGTH * size * size, first,
                q, v, a, determinant, turn, point, before,
            )  # fmt: skip
            self.packed.specials.check()
            if status == SOLVED:
                return (q, v, a) if self._all_close(steps, q) else None
            if status == OPEN:
                steps.out_of_reach = float(steps.times[index])
            if status != DOUBTED:
                return None
            if steps.follow_laws():
                q, v, a = (np.zeros((len(steps.times), n3)) for _ in range(3))
                determinant = np.zeros((len(blocks.head), len(steps.times), 1))
                first = 0
                continue
            if not steps.divide(index, part):
                return None
            q, v, a = (np.insert(array, index, 0.0, axis=0) for array in (q, v, a))
            determinant = np.insert(determinant, index, 0.0, axis=1)
            first = index - 1

    def _all_close(self, steps: Steps, q: np.ndarray) -> bool:
        """Whether joints that repeat others, which the groups leave out, hold at all poses q (T, 3 nb)."""
        packed = self.packed
        if self.proved or not self.mobility.redundant_rows:
            return True
        count, rows = len(q), len(packed.ws.phi)
        phi, gamma = np.zeros((2, count, rows))
        tabulate(packed.system, steps.drives, q, np.zeros_like(q), packed.ws, phi, np.zeros((count, rows, 6)), gamma)
        return float(np.abs(phi).max()) <= REDUNDANT_GAP * max(packed.size, 1.0)

    def _newton(self, steps: Steps) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Positions, velocities, accelerations (T, 3 nb) at all steps; those that the kernel refuses are divided."""
        packed, sequence, factors = self.packed, self.sequence, self.factors
        arrays = self._arrays(len(steps.times), sequence)
        first = chosen = 0
        while True:
            q, v, a, residual, determinant = arrays
            status, index = kinematics.sweep(
                packed.system, sequence, factors, packed.ws, packed.size, steps.times, steps.drives, steps.stride,
                q, v, a, residual, determinant, first, chosen,
            )  # fmt: skip
            packed.specials.check()
            if status == kinematics.DONE:
                break
            if index == 0:
                raise self._refused(status, steps.times, 0, steps.drives, q, v)
            if steps.follow_laws():
                arrays, first, chosen = self._arrays(len(steps.times), sequence), 0, 0
                continue
            if self.mobility.redundant_rows and index - 1 > chosen:
                residual_and_jacobian(packed.system, q[index - 1], steps.drives[index - 1], packed.ws)
                kept = best_rows(packed, sequence.rows)
                if kept is not None:
                    sequence, factors = plan(sample_jacobians(packed), kept, packed.system.row_body)
                    first = chosen = index - 1
                    arrays = *arrays[:4], np.zeros((len(steps.times), len(sequence.ends)))
                    continue
            if not steps.divide(index):
                raise self._refused(status, steps.times, index, steps.drives, q, v)
            arrays = tuple(np.insert(array, index, 0.0, axis=0) for array in arrays)
            first = index
        self._refuse_disagreeing(steps.times, residual, q, steps.drives)
        return q, v, a

    def _arrays(self, count: int, sequence: Elimination) -> tuple[np.ndarray, ...]:
        n3, blocks = len(self.q0), len(sequence.ends)
        q, v, a = (np.zeros((count, n3)) for _ in range(3))
        q[0] = self.q0
        return q, v, a, np.zeros(count), np.zeros((count, blocks))

    def _out_of_reach(self, time: float) -> Exception:
        """The error for a motion on whose way a group cannot close, whatever Newton-Raphson made of it."""
        return SingularPoseError(
            f"{self.packed.name}: the links cannot follow the drivers beyond t = {time:.9g} s "
            f"({self._driver_values(self.packed.drives(np.array([time]))[0])}): a toggle, beyond which they do not "
            "reach each other. Drive within the reachable range, change the lengths, or drive another body."
        )

    def _refuse_disagreeing(self, grid: np.ndarray, residual: np.ndarray, q: np.ndarray, drives: np.ndarray) -> None:
        """Rows left out as redundant must hold too."""
        k = int(np.argmax(residual))
        if residual[k] <= REDUNDANT_GAP * max(self.packed.size, 1.0):
            return
        residual_and_jacobian(self.packed.system, q[k], drives[k], self.packed.ws)
        joint = self.packed.joint_of_row(int(np.argmax(np.abs(self.packed.ws.phi))))
        raise AssemblyError(
            f"{self.packed.name}: at t = {grid[k]:.6g} s redundant joint {joint.name} is open by "
            f"{residual[k]:.3g} (m or rad) while all others close: the lengths do not agree. "
            "Correct them, or leave the joint out."
        )

    def _refused(
        self, status: int, grid: np.ndarray, index: int, drives: np.ndarray, q: np.ndarray, v: np.ndarray
    ) -> Exception:
        """The error for a step that halving does not cure."""
        packed = self.packed
        last = max(index - 1, 0)
        rates = np.abs(v[last].reshape(-1, 3)[1:, 2])
        where = f"t = {grid[last]:.6g} s ({self._driver_values(drives[last])})"
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
                f"{grid[index] - grid[last]:.1e} s do not cure it. A law jumps there, or the pose is a change point; "
                "end the motion before it."
            )
        return SingularPoseError(
            f"{packed.name}: the pose at {where} is a change point: the linkage can go on in two ways and the "
            "drivers do not decide which. End the motion before it, choose times that do not fall on it, or add a link "
            "that decides."
        )

    def _driver_values(self, drive: np.ndarray) -> str:
        drivers = self.packed.joints[len(self.packed.joints) - len(self.packed.motions) :]
        parts = []
        for k, driver in enumerate(drivers):
            value = float(drive[k + 1, 0])
            at = f"{math.degrees(value):.4g} degrees" if driver.kind.angular else f"{value:.4g} m"
            parts.append(f"{driver.name} at {at}")
        return ", ".join(parts)


def prepare(m: Model, start: float = 0.0, end: float = 1.0) -> Prepared:
    """Check mobility and close the start pose of ``m`` for a motion from ``start`` to ``end`` (s)."""
    if len(m.bodies) < 2:
        raise ModelError(f"{m.name}: there is no body beside ground; add one with m.bar(...) or m.body(...)")
    packed = pack(m)
    packed.settle_laws(start, end)
    refuse_bad_laws(packed, start, end)
    try:
        q0 = assemble(m, packed, start)
    except AssemblyError:
        refuse_overdriven(m, packed, start)
        raise
    mobility = joint_mobility(packed, q0)
    kept = choose_rows(packed, q0, start, mobility)
    samples = sample_jacobians(packed)
    sequence, factors = plan(samples, kept, packed.system.row_body)
    groups, blocks = plan_groups(packed, q0, mobility.redundant_rows), no_blocks()
    if groups is None:
        parts = plan_parts(packed, q0, (samples != 0.0).any(axis=0), kept)
        if parts is not None:
            return Prepared(packed, q0, start, sequence, factors, mobility, *parts)
    return Prepared(packed, q0, start, sequence, factors, mobility, groups, blocks)


def sample_jacobians(packed: Packed) -> np.ndarray:
    """(4, m, n) at unrelated poses, to see which entries are constant."""
    numbers = packed.numbers()
    return _sampled(packed) if numbers is None else _SAMPLES.get(numbers, lambda: _sampled(packed))


def _sampled(packed: Packed) -> np.ndarray:
    random = np.random.default_rng(2)
    none = np.zeros((len(packed.motions) + 1, 3))
    samples = []
    special, rows = packed.system.special.copy(), packed.system.special[:, ROW]
    special[:, ACTIVE] = 0  # their entries may be constant here and there, as in the dwell of a Geneva: none counts
    system = packed.system.changed(special=special)
    for _ in range(4):
        q = np.zeros(3 * len(packed.body_names))
        q[3:] = random.uniform(-2.0, 2.0, packed.coordinates) * packed.column_scale()
        residual_and_jacobian(system, q, none, packed.ws)
        packed.ws.jac[rows] = random.uniform(1.0, 2.0, (len(rows), 6))
        samples.append(packed.jacobian())
    return np.array(samples)
