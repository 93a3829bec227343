"""March along a driven motion, pose by pose, closed forms first; failed steps are divided.

Motions that cannot go on end in errors that name the time and the drivers: a toggle, a jump to the other assembly, a
redundant joint that opens.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence

import numpy as np

from mbsd.arrays.packing import Packed
from mbsd.base.errors import AssemblyError, BranchError, MechanismError, SingularPoseError
from mbsd.base.quantity import written
from mbsd.equations.assembly import residual_and_jacobian, tabulate
from mbsd.kinematics import newton
from mbsd.kinematics.change_points.assemblies import Solver
from mbsd.kinematics.change_points.passages import NEAR_END, Passage
from mbsd.kinematics.groups.carried import COS, DOUBTED, OPEN, SOLVED
from mbsd.kinematics.groups.groups import Groups
from mbsd.kinematics.groups.solve import SOLVED_CLOSE, Poses, solve_groups
from mbsd.kinematics.newton_march import NewtonMarch
from mbsd.kinematics.prepared import Prepared
from mbsd.kinematics.steps import Steps

ZERO_LENGTH = 1e-12
"""Square of a length in sizes below which it counts as zero."""


class March:
    """A motion at the times asked for, and at all steps on the way."""

    def __init__(
        self,
        q: np.ndarray,
        v: np.ndarray,
        a: np.ndarray,
        steps: Steps,
        closed: bool,
        passages: Sequence[Passage] = (),
        switch_at: Sequence[float] | np.ndarray = (),
    ) -> None:
        self.switch_at = switch_at
        """Times (s) at which it goes on to the other assembly."""
        self.steps, self.closed = steps, closed
        """``closed``: solved in closed form."""
        self.passages = passages
        """Past change points."""
        self._all = q, v, a
        every = slice(None) if steps.wanted.all() else steps.wanted
        self.q, self.v, self.a = q[every], v[every], a[every]
        """(T, 3 nb)"""
        self.drives = steps.drives[every]
        """(T, motions + 1, 3) what the laws gave."""

    def closely(self) -> tuple[np.ndarray, np.ndarray]:
        """Return times (N,) and poses (N, 3 nb) of all steps and seven times within each, by quintics."""
        from mbsd.model.laws.numbers import hermite_coefficients

        times, (q, v, a) = self.steps.times, self._all
        if len(times) < 2:
            return times, q
        h, samples = np.diff(times), np.stack([q, v, a], axis=-1)
        coefficients = hermite_coefficients(h, samples[:-1], samples[1:])
        ahead = h[:, None] * np.arange(8) / 8
        poses = np.einsum("sxp,scp->sxc", ahead[..., None] ** np.arange(6), coefficients).reshape(-1, q.shape[1])
        inner = (times[:-1, None] + ahead).ravel()
        return np.append(inner, times[-1]), np.vstack([poses, q[-1:]])


def kinematics_at(ready: Prepared, times: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return (T, nb, 3) positions, velocities and accelerations of centres of mass and angles.

    Ground is body 0.
    """
    motion = march_along(ready, times)
    shape = (len(times), -1, 3)
    return motion.q.reshape(shape), motion.v.reshape(shape), motion.a.reshape(shape)


def march_along(ready: Prepared, times: np.ndarray, switch_at: Sequence[float] | np.ndarray = ()) -> March:
    """Return the motion at rising times (T,) (s): closed forms where they serve, else Newton-Raphson.

    It passes change points on the smooth continuation, and goes on to the other assembly at those of ``switch_at`` (s).
    """
    switches = np.asarray(switch_at, float)
    steps = Steps(ready.packed, times)
    if ready.groups is not None and not len(switches):
        marched = _closed_form(ready, ready.groups, steps)
        if marched is not None:
            q, v, a, ends_close = marched
            return (_near_ends(ready, times) if ends_close else None) or March(q, v, a, steps, True)
    out_of_reach = steps.out_of_reach
    steps = Steps(ready.packed, times)  # those of the closed form may be just where branches meet
    march = _newton(ready, steps, switches)
    if out_of_reach is not None:
        raise error_out_of_reach(ready.packed, out_of_reach)
    return march


def _near_ends(ready: Prepared, times: np.ndarray) -> March | None:
    """Return the motion by Newton-Raphson if it begins or ends near a change point, else None."""
    try:
        march = _newton(ready, Steps(ready.packed, times), np.zeros(0))
    except MechanismError:
        return None
    return march if march.passages else None


def _closed_form(
    ready: Prepared, groups: Groups, steps: Steps
) -> tuple[np.ndarray, np.ndarray, np.ndarray, bool] | None:
    """Return positions, velocities, accelerations (T, 3 nb); None if branches meet or a group opens.

    Last, whether the two poses of a group or block come close to each other at the first or the last step.
    """
    n3, size, blocks = len(ready.q0), ready.packed.size, ready.blocks
    bodies = n3 // 3
    poses = Poses(
        np.zeros((bodies, 7)), np.zeros((bodies, 6)), np.zeros((bodies, 2)), np.zeros((4, 8)),
        np.zeros((len(groups.kind), 3)),
    )  # fmt: skip
    poses.body[0, COS] = poses.turn[0, 0] = 1.0
    q, v, a = (np.zeros((len(steps.times), n3)) for _ in range(3))
    determinant = np.zeros((len(blocks.head), len(steps.times), 1))
    first = 0
    while True:
        status, index, part = solve_groups(
            groups, blocks, ready.q0, newton.DrivenMotion(steps.times, steps.drives, steps.stride, q, v, a),
            determinant, poses, ZERO_LENGTH * size * size, first,
        )  # fmt: skip
        ready.packed.specials.check()
        if status in (SOLVED, SOLVED_CLOSE):
            close = status == SOLVED_CLOSE or _ends_close(determinant)
            return (q, v, a, close) if _all_close(ready, steps, q) else None
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


def _ends_close(determinant: np.ndarray) -> bool:
    """Return True if a block is nearly singular at either end: ``determinant`` (blocks, T, 1)."""
    if not len(determinant):
        return False
    ends = np.abs(determinant[:, [0, -1], 0])
    return bool((ends < NEAR_END * np.abs(determinant).max(axis=1)).any())


def _all_close(ready: Prepared, steps: Steps, q: np.ndarray) -> bool:
    """Return True if joints that repeat others, which the groups leave out, hold at all poses q (T, 3 nb)."""
    packed = ready.packed
    if ready.proved or not ready.mobility.redundant_rows:
        return True
    count, rows = len(q), len(packed.ws.phi)
    phi, gamma = np.zeros((2, count, rows))
    tabulate(packed.system, steps.drives, q, np.zeros_like(q), packed.ws, phi, np.zeros((count, rows, 6)), gamma)
    return float(np.abs(phi).max()) <= REDUNDANT_GAP * max(packed.size, 1.0)


class _NewtonMarch(NewtonMarch):
    """Newton-Raphson along the steps of a planar mechanism."""

    def room(self) -> dict[str, np.ndarray]:
        """Return arrays for all steps, with the start in their first rows."""
        count, n3 = len(self.steps.times), len(self.ready.q0)
        arrays = {name: np.zeros((count, n3)) for name in self.poses}
        arrays["q"][0] = self.ready.q0
        return arrays | {"residual": np.zeros(count), "determinant": np.zeros((count, len(self.sequence.ends)))}

    def solver(self) -> Solver:
        """Return Newton-Raphson with the rows in use, for passages."""
        return Solver(self.ready.packed, self.sequence, self.factors)

    def solve(self, first: int, chosen: int) -> tuple[int, int]:
        """Solve the steps from ``first`` on, by rows chosen at ``chosen``; returns status and index."""
        packed, steps, arrays = self.ready.packed, self.steps, self.arrays
        out = newton.sweep(
            packed.system, self.sequence, self.factors, packed.ws, packed.size,
            newton.DrivenMotion(steps.times, steps.drives, steps.stride, arrays["q"], arrays["v"], arrays["a"]),
            arrays["residual"], arrays["determinant"], first, chosen,
        )  # fmt: skip
        packed.specials.check()
        return out

    def error_of_step(self, status: int, index: int) -> Exception:
        """Return the error for a refused step that nothing cures."""
        steps, rates = self.steps, np.abs(self.arrays["v"][:, 5::3])
        return error_of_step(self.ready.packed, status, steps.times, index, steps.drives, rates)


def _newton(ready: Prepared, steps: Steps, switch_at: np.ndarray) -> March:
    """Return the motion by Newton-Raphson."""
    march = _NewtonMarch(ready, steps, switch_at)
    march.follow()
    if len(steps.times):
        refuse_disagreeing(ready.packed, steps.times, march.arrays["residual"], march.arrays["q"], steps.drives)
    march.fill()
    q, v, a = (march.arrays[name] for name in march.poses)
    return March(q, v, a, steps, False, march.passages.passages, switch_at)


RUNAWAY = 30.0
"""Turning this many times faster than usual is the mark of a toggle; at a change point rates stay as they are."""
REDUNDANT_GAP = 1e-7
"""Largest gap, in sizes, by which redundant joints may disagree."""


def error_out_of_reach(packed: Packed, time: float) -> Exception:
    """Return the error for a motion on whose way a group cannot close, whatever Newton-Raphson made of it."""
    return SingularPoseError(
        f"{packed.name}: the links cannot follow the drivers beyond t = {time:.9g} s "
        f"({driver_values(packed, packed.drives(np.array([time]))[0])}): a toggle, beyond which they do not "
        "reach each other. Drive within the reachable range, change the lengths, or drive another body."
    )


def refuse_disagreeing(
    packed: Packed, grid: np.ndarray, residual: np.ndarray, q: np.ndarray, drives: np.ndarray
) -> None:
    """Raise AssemblyError where rows that were left out as redundant do not hold."""
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


def error_of_step(
    packed: Packed, status: int, times: np.ndarray, index: int, drives: np.ndarray, rates: np.ndarray,
    weak: Callable[[int], str] = lambda row: "", driven: str = "body",
) -> Exception:  # fmt: skip
    """Return the error for a step that halving does not cure.

    ``rates`` (T, bodies): how fast each turns (rad/s). ``weak``: words about the pose of a step.
    """
    last = max(index - 1, 0)
    where, at = f"t = {times[last]:.6g} s ({driver_values(packed, drives[last])})", weak(last)
    if index == 0:
        return SingularPoseError(
            f"{packed.name}: the start pose at {where} is singular (a toggle or change point){at}: the drivers do not "
            f"fix the motion here. Start a little before or after it, or drive another {driven}."
        )
    fastest = ", ".join(packed.body_names[1 + b] for b in np.argsort(-rates[last])[:2])
    usual = float(np.median(rates[: last + 1].max(axis=1)))
    if rates[last].max() > RUNAWAY * usual:
        return SingularPoseError(
            f"{packed.name}: the links cannot follow the drivers beyond {where}: a toggle{at}, where {fastest} "
            f"run away ({written(float(rates[last].max()), 'rad/s')}, {written(usual, 'rad/s')} before). Drive within "
            f"the reachable range, change the lengths, or drive another {driven}."
        )
    if status == newton.BRANCH_DOUBT:
        return BranchError(
            f"{packed.name}: after {where} the motion would jump to the other assembly{at}, and steps down to "
            f"{times[index] - times[last]:.1e} s do not cure it. A law jumps there, or the drivers rest where two "
            "assemblies meet; end the motion before it."
        )
    return SingularPoseError(
        f"{packed.name}: the pose at {where} is singular{at}, and no smooth motion through it was found: the drivers "
        "do not decide how the links go on. End the motion before it, or add a link that decides."
    )


def driver_values(packed: Packed, drive: np.ndarray) -> str:
    """Return the values of the drivers in words."""
    parts = []
    for k, driver in enumerate(packed.drivers):
        value = float(drive[k + 1, 0])
        at = f"{math.degrees(value):.4g} degrees" if driver.kind.angular else f"{value:.4g} m"
        parts.append(f"{driver.name} at {at}")
    return ", ".join(parts)
