"""A driven motion from start to end: laws sampled, the kernel run, refused steps halved, errors worded."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from mbsd import kinematics
from mbsd.assembly import residual_and_jacobian
from mbsd.dynamics import inverse_dynamics, joint_wrenches
from mbsd.elimination import Elimination, Factors, plan
from mbsd.errors import AssemblyError, BranchError, ModelError, SingularPoseError
from mbsd.mobility import Mobility, choose_rows, joint_mobility, refuse_overdriven
from mbsd.model import Mechanism
from mbsd.packing import Packed, pack
from mbsd.solution import Solution, Stats
from mbsd.start import assemble

SHORTEST_STEP = 1e-7
"""A step refused at this part of the output step is not cured by halving."""
REDUNDANT_GAP = 1e-7
"""Largest gap, in sizes, by which redundant joints may disagree."""


JACOBIAN_NUMBERS = 4_000_000
"""How many numbers of Jacobians are held at once."""


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

    def kinematics(self, times: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """(T, nb, 3) positions, velocities and accelerations of the centres of mass and angles; ground is body 0."""
        q, v, a, _ = self._march(times)
        shape = (len(times), -1, 3)
        return q.reshape(shape), v.reshape(shape), a.reshape(shape)

    def _march(self, times: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray, int]:
        """Run the kernel; halve the steps it refuses. Also returns how many steps were inserted."""
        packed = self.packed
        grid = np.ascontiguousarray(times, float)
        drives = packed.drives(grid)
        wanted = np.ones(len(grid), bool)
        first = 0
        q, v, a, residual, sign = self._arrays(len(grid))
        q[0] = self.q0
        while True:
            status, index = kinematics.sweep(
                packed.system, self.sequence, self.factors, packed.ws, packed.size, grid, drives, q, v, a, residual, sign, first
            )
            if status == kinematics.DONE:
                break
            if index == 0:
                raise self._refused(status, grid, 0, drives, q, v)
            middle = (grid[index - 1] + grid[index]) / 2
            if not middle - grid[index - 1] > SHORTEST_STEP * float(np.ptp(times)) / len(times):
                raise self._refused(status, grid, index, drives, q, v)
            grid = np.insert(grid, index, middle)
            drives = np.insert(drives, index, packed.drives(np.array([middle]))[0], axis=0)
            wanted = np.insert(wanted, index, False)
            q, v, a = (np.insert(array, index, 0.0, axis=0) for array in (q, v, a))
            residual, sign = np.insert(residual, index, 0.0), np.insert(sign, index, 0.0)
            first = index
        self._refuse_disagreeing(grid, residual, q, drives)
        if wanted.all():
            return q, v, a, 0
        return q[wanted], v[wanted], a[wanted], int((~wanted).sum())

    def _arrays(self, count: int) -> tuple[np.ndarray, ...]:
        n3 = len(self.q0)
        return np.zeros((count, n3)), np.zeros((count, n3)), np.zeros((count, n3)), np.zeros(count), np.zeros(count)

    def _refuse_disagreeing(self, grid: np.ndarray, residual: np.ndarray, q: np.ndarray, drives: np.ndarray) -> None:
        """Rows left out as redundant must hold too."""
        k = int(np.argmax(residual))
        if residual[k] <= REDUNDANT_GAP * max(self.packed.size, 1.0):
            return
        residual_and_jacobian(self.packed.system, q[k], drives[k], self.packed.ws)
        joint = self.packed.joint_of_row(int(np.argmax(np.abs(self.packed.ws.phi))))
        raise AssemblyError(
            f"{self.packed.name}: at t = {grid[k]:.6g} s redundant joint {joint.name} is open by {residual[k]:.3g} (m or rad) "
            "while all others close: the lengths do not agree. Correct them, or leave the joint out."
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
                f"{packed.name}: the start pose at {where} is singular (a toggle or change point): the drivers do not fix "
                "the motion here. Start a little before or after it, or drive another body."
            )
        bodies = packed.body_names[1:]
        fastest = ", ".join(bodies[b] for b in np.argsort(-rates)[:2])
        if status == kinematics.BRANCH_DOUBT:
            return BranchError(
                f"{packed.name}: after {where} the motion would jump to the other assembly, and steps down to "
                f"{grid[index] - grid[last]:.1e} s do not cure it ({fastest} move fastest). The pose there is a change "
                "point, or a law jumps; end the motion before it."
            )
        return SingularPoseError(
            f"{packed.name}: the links cannot follow the drivers beyond {where}: a toggle, where {fastest} run away "
            f"(up to {rates.max():.3g} rad/s). Drive within the reachable range, change the lengths, or drive another body."
        )

    def _driver_values(self, drive: np.ndarray) -> str:
        drivers = self.packed.joints[len(self.packed.joints) - len(self.packed.motions) :]
        parts = []
        for k, driver in enumerate(drivers):
            value = float(drive[k + 1, 0])
            angle = driver.kind.constraints == ("angle",)
            parts.append(f"{driver.name} at {math.degrees(value):.4g} degrees" if angle else f"{driver.name} at {value:.4g} m")
        return ", ".join(parts)


def prepare(m: Mechanism, start: float = 0.0, end: float = 1.0) -> Prepared:
    """Check mobility and close the start pose of ``m`` for a motion from ``start`` to ``end`` (s)."""
    if len(m.bodies) < 2:
        raise ModelError(f"{m.name}: there is no body beside ground; add one with m.bar(...) or m.body(...)")
    packed = pack(m)
    packed.motions = [law.over(start, end) for law in packed.motions]
    _refuse_bad_laws(packed, start, end)
    try:
        q0 = assemble(m, packed, start)
    except AssemblyError:
        refuse_overdriven(m, packed)
        raise
    kept = choose_rows(packed, q0, start)
    sequence, factors = plan(_sample_jacobians(packed), kept)
    return Prepared(packed, q0, start, sequence, factors, joint_mobility(packed, q0))


def _refuse_bad_laws(packed: Packed, start: float, end: float) -> None:
    drivers = packed.joints[len(packed.joints) - len(packed.motions) :]
    for driver, law in zip(drivers, packed.motions, strict=True):
        values = law(np.linspace(start, end, 17))
        if not np.isfinite(values).all():
            raise ModelError(f"{packed.name}: driver '{driver.name}': its law gives {values[~np.isfinite(values)][0]}")
        if driver.kind.constraints == ("distance",) and values[:, 0].min() <= 0:
            raise ModelError(
                f"{packed.name}: driver '{driver.name}' imposes a distance of {values[:, 0].min():.4g} m; it must stay positive"
            )


def _sample_jacobians(packed: Packed) -> np.ndarray:
    """(4, m, n) at unrelated poses, to see which entries are constant."""
    random = np.random.default_rng(2)
    none = np.zeros((len(packed.motions) + 1, 3))
    samples = []
    for _ in range(4):
        q = np.zeros(3 * len(packed.body_names))
        q[3:] = random.uniform(-2.0, 2.0, packed.coordinates) * packed.column_scale()
        residual_and_jacobian(packed.system, q, none, packed.ws)
        samples.append(packed.ws.jac[:, 3:].copy())
    return np.array(samples)


def sweep(
    m: Mechanism, duration: float | None, steps: int, times: Sequence[float] | np.ndarray | None
) -> Solution:
    """See :meth:`mbsd.model.Mechanism.sweep`."""
    grid = _times(m, duration, steps, times)
    ready = prepare(m, float(grid[0]), float(grid[-1]))
    q, v, a, inserted = ready._march(grid)
    packed = ready.packed
    drives = packed.drives(grid)
    efforts = _efforts(ready, drives, q, v, a)
    shape = (len(grid), -1, 3)
    return Solution(
        mechanism=m,
        packed=packed,
        t=grid,
        q=q.reshape(shape),
        v=v.reshape(shape),
        a=a.reshape(shape),
        wrench=efforts.wrench,
        lam=efforts.lam,
        drives=drives,
        singularity_margin=efforts.margin,
        stats=Stats(*(float(r) for r in efforts.residuals), steps=len(grid), inserted_steps=inserted),
        mobility=ready.mobility,
    )


@dataclass
class _Efforts:
    """Inverse dynamics of a motion, and how well the motion fulfils its equations."""

    lam: np.ndarray
    wrench: np.ndarray
    margin: np.ndarray
    residuals: np.ndarray
    """(4,) largest |Phi|, |J v - nu|, |J a - gamma| and |d(T + V)/dt - power of the drivers|."""


def _efforts(ready: Prepared, drives: np.ndarray, q: np.ndarray, v: np.ndarray, a: np.ndarray) -> _Efforts:
    packed, system = ready.packed, ready.packed.system
    count, rows = len(q), len(packed.ws.phi)
    inertia = np.stack([system.mass, system.mass, system.inertia], axis=1).ravel()
    weight = np.zeros((len(system.mass), 3))
    weight[:, :2] = system.mass[:, None] * system.gravity
    loads = weight.ravel() - inertia * a
    nu = np.zeros((count, rows))
    nu[:, packed.driver_rows :] = drives[:, 1:, 1]
    out = _Efforts(np.zeros((count, rows)), np.zeros((count, len(packed.joints), 3)), np.zeros(count), np.zeros(4))
    chunk = max(1, JACOBIAN_NUMBERS // max(1, rows * packed.coordinates))
    for k in range(0, count, chunk):
        at = slice(k, min(k + chunk, count))
        jac = np.zeros((at.stop - k, rows, packed.coordinates))
        phi, gamma = np.zeros((2, at.stop - k, rows))
        inverse_dynamics(
            system, ready.sequence, ready.factors, packed.ws, packed.first_row, packed.markers[:, 1].copy(),
            drives[at], q[at], v[at], loads[at], out.lam[at], out.wrench[at], phi, gamma, jac,
        )  # fmt: skip
        scaled = jac[:, ready.sequence.rows] * packed.row_scale()[ready.sequence.rows, None] * packed.column_scale()
        singular = np.linalg.svd(scaled, compute_uv=False)
        out.margin[at] = singular[:, -1] / singular[:, 0]
        if ready.mobility.redundant_rows:
            _least_norm(packed, jac, q[at], loads[at], out.lam[at], out.wrench[at])
        rate = np.einsum("trc,tc->tr", jac, v[at, 3:]) - nu[at]
        bend = np.einsum("trc,tc->tr", jac, a[at, 3:]) - gamma
        power = (loads[at] * v[at]).sum(axis=1) - (out.lam[at] * nu[at]).sum(axis=1)
        worst = [np.abs(error).max(initial=0.0) for error in (phi, rate, bend, power)]
        out.residuals = np.maximum(out.residuals, worst)
    return out


def _least_norm(
    packed: Packed, jacobians: np.ndarray, q: np.ndarray, loads: np.ndarray, lam: np.ndarray, wrench: np.ndarray
) -> None:
    """Redundant joints share the load in many ways; take the multipliers of least norm."""
    none = np.zeros((len(packed.motions) + 1, 3))
    for k, jac in enumerate(jacobians):
        lam[k] = np.linalg.lstsq(jac.T, loads[k, 3:], rcond=1e-9)[0]
        residual_and_jacobian(packed.system, q[k], none, packed.ws)
        joint_wrenches(packed.system, packed.ws, packed.first_row, packed.markers[:, 1].copy(), lam[k], wrench[k])


def _times(
    m: Mechanism, duration: float | None, steps: int, times: Sequence[float] | np.ndarray | None
) -> np.ndarray:
    if times is not None:
        grid = np.asarray(times, float)
        if grid.ndim != 1 or len(grid) < 2 or not np.isfinite(grid).all() or not (np.diff(grid) > 0).all():
            raise ModelError(f"{m.name}: times must be two or more rising finite numbers")
        return grid
    if isinstance(steps, bool) or not isinstance(steps, int | np.integer) or steps < 1:
        raise ModelError(f"{m.name}: steps is {steps!r}; it must be a whole number above zero")
    if duration is None:
        periods = [law.period for law in (d.motion for d in m.drivers.values()) if law is not None and law.period]
        if not periods and not m.drivers:
            duration = 1.0  # mobility will name the missing driver
        elif not periods:
            raise ModelError(f"{m.name}: no driver repeats, so there is no natural duration; say sweep(duration=...)")
        else:
            duration = float(periods[0])
    if not (math.isfinite(duration) and duration > 0):
        raise ModelError(f"{m.name}: duration is {duration} s; it must be positive")
    return np.linspace(0.0, duration, int(steps) + 1)
