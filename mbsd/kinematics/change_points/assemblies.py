"""Change points of a driven motion, where two assemblies meet, passed on the smooth continuation.

There J is singular although the motion is smooth. Near such a pose, at a distance p of it, rounding e costs positions
e / p, velocities e / p^2 and accelerations e / p^3. So the pose is passed on a straight way of the drivers,

    f(p) = f_0 + p df/dp,     |dq/dp| = 1 in sizes and rad at the pose from which it is looked at,

on which q is an analytic function of p whatever the laws do in time. Newton-Raphson solves twelve poses on both sides,

    p_i = -/+ x_i A,    x = 1, 1.3, 1.6, 1.9, 2.2, 2.5,     A = 0.2 .. 0.025

and steps from one side to the other where the predicted pose is far nearer to the smooth continuation than to the other
assembly. Polynomials of degree 11 through q, dq/dp, d2q/dp2 give what lies between, and the motion in time:

    q' = dq/dp p',    q'' = d2q/dp2 p'^2 + dq/dp p''

The proof that two assemblies do meet there: these poses, between the twelve, meet the constraints to ``CLOSES``, and
det J has a root. Lengths that nearly agree keep the assemblies apart, and leave gaps as large as what they miss.

The other assembly. With w^T J u = sigma the smallest singular value at the smooth pose at p,

    w^T Phi(q + b u) = b (sigma + c b) = 0,     c = w^T (dJ/db) u / 2

has the second root b = -sigma / c, from which Newton-Raphson finds it.

Where several drivers move at once, p is the time since the change point.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from mbsd.arrays.efforts_beside import lagrange
from mbsd.arrays.packing import Packed
from mbsd.equations.assembly import residual_and_jacobian
from mbsd.kinematics import newton
from mbsd.kinematics.elimination import Elimination, Factors, plan
from mbsd.kinematics.pose.mobility import best_rows
from mbsd.kinematics.prepared import sample_jacobians

APART = np.array([1.0, 1.3, 1.6, 1.9, 2.2, 2.5])
"""Distances of the poses beside a change point, in ``WAYS``."""
WAYS = (0.2, 0.1, 0.05, 0.025)
"""A, in sizes and rad of the body that moves furthest; the first at which the polynomials are exact is taken."""
GAP = 0.01
"""Distance on both sides within which no pose is solved."""
IN_SIGHT = 0.05
"""Distance from which a change point ahead is looked for."""
NEAREST = 1e-7
"""Distance below which a pose does not tell its assembly from the other."""
LADDER = 1.5
"""Ratio of neighbouring distances at which poses are solved on the way to the twelve."""
CLOSES = 3e-12
"""Residual, in sizes and rad, of a pose between the twelve where two assemblies meet."""
EXACT = 1e-9
"""Error of d2q/dp2 with which the polynomials are taken as they are."""
ROUGH = 1e-5
"""Error of d2q/dp2 beyond which they do not describe the motion."""


@dataclass
class Way:
    """A straight way of the drivers, measured by p."""

    packed: Packed
    driver: int | None
    """The one that moves, its number among the motions; None where several do."""
    origin: float
    """Its value (rad or m) where p = 0; else the time (s)."""
    scale: float
    """dp / df (1/rad or 1/m), or dp/dt (1/s)."""
    resting: np.ndarray
    """(motions + 1, 3) of the drivers that do not move."""

    def drives(self, p: np.ndarray, sign: float = 1.0) -> np.ndarray:
        """Return (P, motions + 1, 3) values of the drivers at p (P,), with their derivatives by ``sign`` p."""
        rate = sign / self.scale
        if self.driver is None:
            return self.packed.drives(self.origin + p / self.scale) * np.array([1.0, rate, rate * rate])
        out = np.repeat(self.resting[None], len(p), axis=0)
        out[:, self.driver, 0] = self.origin + p / self.scale
        out[:, self.driver, 1] = rate
        return out

    def evaluate(self, times: np.ndarray) -> np.ndarray:
        """Return (T, 3) p and its derivatives in time at ``times`` (T,) (s)."""
        if self.driver is None:
            ones = np.ones(len(times))
            return np.stack([(times - self.origin) * self.scale, self.scale * ones, 0.0 * ones], axis=1)
        out = self.packed.drives(times)[:, self.driver].copy()
        out[:, 0] -= self.origin
        return out * self.scale


@dataclass
class Solver:
    """Newton-Raphson along ways of the drivers, without the guard against other assemblies."""

    packed: Packed
    sequence: Elimination
    factors: Factors

    def walk(self, way: Way, pose: np.ndarray, p: np.ndarray) -> tuple[np.ndarray, ...] | None:
        """Return q, dq/dp, d2q/dp2 (P, 3 nb) and determinants (P, d) at p (P,), from a pose near p[0].

        p rises or falls.

        None where Newton-Raphson does not get on.
        """
        packed, count = self.packed, len(p)
        sign = 1.0 if count < 2 or p[1] > p[0] else -1.0
        q, v, a = (np.zeros((count, len(pose))) for _ in range(3))
        q[0] = pose
        determinant = np.zeros((count, len(self.sequence.ends)))
        drives = way.drives(p, sign)
        status, _ = newton.sweep(
            packed.system, self.sequence, self.factors, packed.ws, packed.size,
            newton.DrivenMotion(sign * p, drives, np.full(drives.shape[1], np.inf), q, v, a),
            np.zeros(count), determinant, 0, count,
        )  # fmt: skip
        packed.specials.check()
        return (q, sign * v, a, determinant) if status == newton.DONE else None

    def exchanged(self, q: np.ndarray, drive: np.ndarray) -> Solver | None:
        """Return a solver with rows that are further from dependent at a pose q (3 nb,); None if there are none."""
        residual_and_jacobian(self.packed.system, q, drive, self.packed.ws)
        kept = best_rows(self.packed, self.sequence.rows)
        if kept is None:
            return None
        return Solver(self.packed, *plan(sample_jacobians(self.packed), kept, self.packed.system.row_body))

    def extent(self, change: np.ndarray) -> float:
        """Return largest part of changes (..., 3 nb) of poses, lengths in sizes."""
        return float(np.abs(change[..., 3:] / self.packed.column_scale()).max(initial=0.0))

    def start_from(self, row: int) -> None:
        """Get ready for ways from the pose of a step."""

    def gap(self, way: Way, q: np.ndarray, p: float) -> float:
        """Return largest residual at a pose q, in sizes and rad, of the rows that are solved."""
        return float(np.abs(self.rows_at(way, q, p)[0]).max())

    def rows_at(self, way: Way, q: np.ndarray, p: float) -> tuple[np.ndarray, np.ndarray]:
        """Return dimensionless Phi (n,) and J (n, n) of the rows that are solved, at a pose q (3 nb,)."""
        packed, rows = self.packed, self.sequence.rows.astype(np.int64)
        residual_and_jacobian(packed.system, q, way.drives(np.array([p]))[0], packed.ws)
        scale = packed.row_scale()[rows]
        return packed.ws.phi[rows] * scale, packed.jacobian()[rows] * scale[:, None] * packed.column_scale()

    def moved(self, q: np.ndarray, change: np.ndarray) -> np.ndarray:
        """Return a pose q (3 nb,) moved by ``change`` (n,), in sizes and rad."""
        return q + np.append(np.zeros(3), change * self.packed.column_scale())


@dataclass
class Assembly:
    """Poses of one of the two assemblies beside a change point."""

    nodes: np.ndarray
    """(12,) p."""
    parts: np.ndarray
    """(3, 12, 3 nb) q, dq/dp, d2q/dp2 there."""
    determinant: np.ndarray
    """(12, d) of the blocks of J."""

    def evaluate(self, p: np.ndarray) -> np.ndarray:
        """Return (3, P, 3 nb) q, dq/dp and d2q/dp2 at p (P,)."""
        return np.einsum("pn,knc->kpc", lagrange(self.nodes, p), self.parts)

    def errors(self, solver: Solver) -> tuple[float, float]:
        """Return errors of q and of d2q/dp2: what the outermost two poses change near the change point."""
        inner = np.abs(self.nodes) < np.abs(self.nodes).max() * 0.99
        probes = 0.5 * np.array([-1.0, 0.0, 1.0]) * np.abs(self.nodes).min()
        fewer = np.einsum("pn,knc->kpc", lagrange(self.nodes[inner], probes), self.parts[:, inner])
        wrong = self.evaluate(probes) - fewer
        return solver.extent(wrong[0]), solver.extent(wrong[2])

    def root(self) -> float | None:
        """Return the p nearest to 0 at which the determinant of a block vanishes; None if none does."""
        coefficients = np.polynomial.polynomial.polyfit(self.nodes, self.determinant, len(self.nodes) - 1)
        reach, meeting = 0.5 * np.abs(self.nodes).min(), []
        for column in coefficients.T:
            roots = np.polynomial.polynomial.polyroots(column)
            real = roots.real[np.abs(roots.imag) < 1e-6 * reach]
            meeting += [float(root) for root in real if abs(root) < reach]
        return min(meeting, key=abs) if meeting else None


def way_from(
    packed: Packed, drives: np.ndarray, drive: np.ndarray, time: float, v: np.ndarray, solver: Solver, pose: np.ndarray
) -> Way | None:
    """Return the way past a change point near a pose (3 nb,), p = 0 there; None if nothing moves.

    ``drives`` (T, motions + 1, 3) of the whole motion, ``drive`` (motions + 1, 3) and ``v`` (3 nb,) those of the pose.
    """
    moving = np.flatnonzero((drives[:, :, 1:] != 0.0).any(axis=(0, 2)))
    if not len(moving):
        return None
    resting = drive * np.array([1.0, 0.0, 0.0])
    if len(moving) > 1:
        speed = solver.extent(v)
        return Way(packed, None, time, speed, resting) if speed > 0.0 else None
    way = Way(packed, int(moving[0]), float(drive[moving[0], 0]), 1.0, resting)
    there = solver.walk(way, pose, np.zeros(1))
    if there is None:
        return None
    way.scale = solver.extent(there[1])
    return way if np.isfinite(way.scale) and way.scale > 0.0 else None


def find_ahead(solver: Solver, way: Way, pose: np.ndarray) -> float | None:
    """Return the p at which a determinant vanishes if it goes on as at ``pose``; None if far away.

    The pose (3 nb,) has p = 0.
    """
    step = 0.2 * IN_SIGHT
    for sign in (-1.0, 1.0):
        rows = solver.walk(way, pose, sign * np.array([0.0, 0.1 * step]))
        if rows is None:
            continue
        here, there = rows[3]
        slope = (there - here) / (sign * 0.1 * step)
        with np.errstate(divide="ignore", invalid="ignore"):
            roots = -here / slope
        roots = roots[np.isfinite(roots) & (np.abs(roots) <= IN_SIGHT)]
        if len(roots):
            return float(roots[np.argmin(np.abs(roots))])
    return None


def assembly_around(solver: Solver, way: Way, pose: np.ndarray, p: float) -> Assembly | None:
    """Return the smooth motion around p = 0 through a pose (3 nb,) at p; None if Newton-Raphson fails."""
    if abs(p) < NEAREST:
        return None
    side = -1.0 if p <= 0.0 else 1.0
    best: tuple[float, Assembly] | None = None
    for reach in WAYS:
        assembly = _around(solver, way, pose, abs(p), side, reach)
        if assembly is None:
            continue
        wrong, bend = assembly.errors(solver)
        if not (wrong <= ROUGH and bend <= ROUGH):
            continue
        if best is None or bend < best[0]:
            best = bend, assembly
        if bend <= EXACT:
            break
    return None if best is None else best[1]


def meets(solver: Solver, way: Way, assembly: Assembly) -> bool:
    """Return True if the motion between the poses of an assembly meets the constraints."""
    probes = GAP * np.array([-1.0, -0.3, 0.0, 0.3, 1.0])
    poses = assembly.evaluate(probes)[0]
    return max(solver.gap(way, pose, float(p)) for pose, p in zip(poses, probes, strict=True)) <= CLOSES


def _around(solver: Solver, way: Way, pose: np.ndarray, p: float, side: float, reach: float) -> Assembly | None:
    furthest = APART[-1] * reach
    distances = _ladder(GAP, furthest, APART * reach)
    if p < furthest:
        out = _ladder(p, furthest, np.zeros(0))
        rows = solver.walk(way, pose, side * out)
        if rows is None:
            return None
        pose = rows[0][-1]
    line = side * np.concatenate([distances[::-1], -distances])
    rows = solver.walk(way, pose, line)
    if rows is None:
        return None
    order = np.argsort(line)
    taken = order[np.isin(np.abs(line[order]), APART * reach)]
    return Assembly(line[taken], np.stack(rows[:3])[:, taken], rows[3][taken])


def _ladder(first: float, last: float, more: np.ndarray) -> np.ndarray:
    """Return rising distances from ``first`` to ``last``, with ``more``; ratios are at most ``LADDER``."""
    steps = max(1, int(np.ceil(np.log(last / first) / np.log(LADDER))))
    inner = np.geomspace(first, last, steps + 1)
    inner[-1] = last
    if first == GAP:
        inner = np.insert(inner, 1, 2.0 * GAP)
    every = np.unique(np.concatenate([inner, more]))
    return every[np.append(True, (np.diff(every) > 1e-9) | np.isin(every[1:], more))]


def other_assembly(solver: Solver, way: Way, smooth: Assembly) -> Assembly | None:
    """Return the motion on the assembly that meets ``smooth`` at p = 0; None unless there is just one."""
    p = 2.0 * GAP
    pose = smooth.evaluate(np.array([p]))[0, 0]
    left, values, right = np.linalg.svd(solver.rows_at(way, pose, p)[1])
    if len(values) > 1 and values[-2] < 4.0 * values[-1]:
        return None
    w, u = left[:, -1], right[-1]
    step = 1e-4
    ahead, back = (solver.rows_at(way, solver.moved(pose, sign * step * u), p)[1] for sign in (1.0, -1.0))
    bend = 0.25 * float(w @ (ahead - back) @ u) / step
    if not abs(bend) * IN_SIGHT > 1e-3 * values[-1]:
        return None
    started = solver.moved(pose, -values[-1] / bend * u)
    meeting = solver.walk(way, started, np.array([p]))
    if meeting is None or solver.extent(meeting[0][0] - pose) < 0.3 * abs(values[-1] / bend):
        return None
    return assembly_around(solver, way, meeting[0][0], p)
