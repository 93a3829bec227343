"""Reactions and efforts of a simulation at and near change points, where J loses rank: from poses beside, as of sweeps.

    D^2 = det(J J^T)     D: the product of the singular values of the rows that hold, with a sign;
                         where rows repeat others, of as many values as there are without these

is a smooth function of the time, with a double root where the motion passes such a pose. With the root known, D changes
its sign there, and the efforts follow as mbsd/arrays/efforts_beside.py says.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from mbsd.arrays.curve_branches import tabulate_along
from mbsd.arrays.efforts_beside import Side, efforts_beside, lagrange
from mbsd.arrays.packing import Packed
from mbsd.base.errors import SimulationError
from mbsd.dynamics.prepare.prepared import PreparedDynamics
from mbsd.kinematics.change_points.assemblies import APART
from mbsd.kinematics.change_points.passages import NEAR, sides_beside
from mbsd.results.solution import Beside, Solution

SUSPECT = 0.1
"""Part of the largest margin below which an output may be near a change point."""
ODD = 30.0
"""Multiple of the usual multipliers above which it may be, too."""
CLOSE = 0.1
"""Part of the usual D below which it is looked for."""
DOUBLE = 1e-9
"""Part of the largest D^2 beside below which it vanishes."""
REACH = 0.05
"""Distance of the furthest pose from which the root is found, in sizes and rad."""
FURTHEST = 0.3
"""How far the poses beside may be from each other, in sizes and rad."""
MOST_COORDINATES = 120
"""Coordinates of the largest mechanisms whose D is looked at; multipliers of larger ones stay as they come."""
OFF = 1e-3
"""By how much an output may miss the polynomials through them, in sizes and rad."""

Motion = Callable[[np.ndarray], Solution]


def near_singular(solution: Solution) -> np.ndarray:
    """Return (T,) True for outputs that may be near a change point, by their margins and multipliers."""
    return are_suspect(solution.singularity_margin, solution.lam)


def are_suspect(margin: np.ndarray, lam: np.ndarray) -> np.ndarray:
    """Return (..., T) True for outputs that may be near a change point, by margins (..., T) and lam (..., T, m)."""
    largest = np.abs(lam).max(axis=-1, initial=0.0)
    middle = largest.shape[-1] // 2
    usual = np.partition(largest, middle, axis=-1)[..., middle, None]
    widest = np.fmax.reduce(margin, axis=-1, initial=0.0, keepdims=True)
    return ~((margin >= SUSPECT * widest) & (largest <= ODD * usual))


def can_pass(packed: Packed) -> bool:
    """Return True if reactions near change points are taken from poses beside: not in large mechanisms."""
    return packed.coordinates <= MOST_COORDINATES and not packed.states


def usual_output(margin: np.ndarray, suspects: np.ndarray) -> int:
    """Return the output whose D is the usual one: the median by margin (T,) of those that are no ``suspects``."""
    clear = np.setdiff1d(np.arange(len(margin)), suspects)
    return int(clear[np.argsort(margin[clear])][len(clear) // 2])


def with_efforts_beside(
    ready: PreparedDynamics, solution: Solution, is_near: np.ndarray, motion: Motion, span: tuple[float, float]
) -> Solution:
    """Return the solution with reactions and efforts at outputs near change points taken from poses beside.

    ``is_near`` (T,): the outputs of :func:`near_singular`. ``motion`` solves it at other times (T,) within ``span``
    (s), efforts as they come, and begins at no output near.
    """
    suspects = np.flatnonzero(is_near)
    if not len(suspects) or len(suspects) == len(is_near) or not can_pass(ready.packed):
        return solution
    margin = solution.singularity_margin.copy()
    lam, wrench = solution.lam.copy(), solution.wrench.copy()
    poses = [part.copy() for part in (solution.q, solution.v, solution.a)]
    closeness = _determinants(ready, solution, suspects)
    usual = _determinants(ready, solution, np.array([usual_output(margin, suspects)]))[0]
    filled, looked, beside = np.zeros(len(margin), bool), np.zeros(len(margin), bool), []
    for row, own in sorted(zip(suspects.tolist(), closeness.tolist(), strict=True), key=lambda pair: pair[1]):
        if looked[row] or not own < CLOSE * usual:
            continue
        looked |= np.abs(solution.t - solution.t[row]) <= NEAR * _pace(ready, solution, row)
        for known in _poses_beside(ready, solution, motion, span, row):
            side, there = known.side, known.motion
            beside.append(known)
            rows = np.searchsorted(solution.t, side.rows)
            scales = solution.packed.row_scale(), solution.packed.size
            lam[rows], wrench[rows] = efforts_beside(side, known.factor, there.lam, there.wrench, *scales)
            filled[rows] = looked[rows] = True
            margin[rows] = np.abs(
                lagrange(side.nodes, side.rows) @ (there.singularity_margin * np.sign(side.nodes - side.time))
            )
            if not solution.stats.independent:
                weights = lagrange(side.nodes, side.rows)
                for part, other in zip(poses, (there.q, there.v, there.a), strict=True):
                    part[rows] = np.einsum("rn,nbc->rbc", weights, other)
    if not filled.any():
        return solution
    q, v, a = poses
    return replace(solution, q=q, v=v, a=a, lam=lam, wrench=wrench, margin=margin, beside=tuple(beside))


def _poses_beside(
    ready: PreparedDynamics, solution: Solution, motion: Motion, span: tuple[float, float], row: int
) -> list[Beside]:
    """Poses beside the change point near output ``row``, D there and at the outputs near it, and the motion there."""
    pace, (start, end) = _pace(ready, solution, row), span
    if not pace > 0.0:
        return []
    try:
        time = _root(ready, motion, float(solution.t[row]), pace, span)
        if time is None:
            return []
        near = np.abs(solution.t - time) < NEAR * pace
        near[1:] &= np.diff(solution.t, prepend=-np.inf)[1:] > 0.0
        if not near.any():
            return []
        out = []
        for side in sides_beside(time, solution.t[near], pace, start, end):
            if side.nodes[0] < start or side.nodes[-1] > end:
                continue
            there = motion(side.nodes)
            if not _is_plain(ready, solution, side, there):
                continue
            factor = _determinants(ready, there, np.arange(len(side.nodes))) * np.sign(side.nodes - time)
            at_rows = lagrange(side.nodes, side.rows) @ factor
            out.append(Beside(side, np.append(factor, at_rows), there))
        return out
    except SimulationError:
        return []


def _root(ready: PreparedDynamics, motion: Motion, time: float, pace: float, span: tuple[float, float]) -> float | None:
    """The time near ``time`` at which D vanishes (s); None where it does not."""
    reach = REACH * pace / APART[-1]
    for _ in range(3):
        places = reach * np.concatenate([-APART[::-1], APART])
        inside = (time + places >= span[0]) & (time + places <= span[1])
        places = places[inside]
        if len(places) < len(APART):
            return None
        squares = _determinants(ready, motion(time + places), np.arange(len(places))) ** 2
        polynomial = np.polynomial.Polynomial.fit(places, squares, len(places) - 1)
        roots = polynomial.deriv().roots()
        real = roots.real[np.abs(roots.imag) < 1e-3 * reach]
        real = real[np.abs(real) <= 2.0 * REACH * pace]
        if not len(real):
            return None
        low = float(real[np.argmin(np.abs(polynomial(real)))])
        if abs(low) < 1e-4 * reach:
            return time + low if abs(polynomial(low)) <= DOUBLE * squares.max() else None
        time += low
    return None


def _pace(ready: PreparedDynamics, solution: Solution, row: int) -> float:
    """The time in which the motion goes on by 1 size or rad at an output (s); 0 where it rests."""
    speed = float(np.abs(_scaled(ready, solution.v[row])).max())
    return 1.0 / speed if speed > 0.0 else 0.0


def _scaled(ready: PreparedDynamics, change: np.ndarray) -> np.ndarray:
    """(..., n) of changes (..., nb, 3), in sizes and rad."""
    size = 3 * (change.shape[-2] - 1)
    return change[..., 1:, :].reshape(*change.shape[:-2], size) / ready.packed.column_scale()[:size]


def _is_plain(ready: PreparedDynamics, solution: Solution, side: Side, there: Solution) -> bool:
    """Return True if the poses beside are near each other, and the outputs on the polynomials through them."""
    if np.abs(_scaled(ready, np.ptp(there.q, axis=0))).max() > FURTHEST:
        return False
    rows = np.searchsorted(solution.t, side.rows)
    missed = np.einsum("rn,nbc->rbc", lagrange(side.nodes, side.rows), there.q) - solution.q[rows]
    return bool(np.abs(_scaled(ready, missed)).max(initial=0.0) <= OFF)


def _determinants(ready: PreparedDynamics, solution: Solution, rows: np.ndarray) -> np.ndarray:
    """(R,) |D| at outputs ``rows`` (R,) of a solution."""
    packed = ready.packed
    q = np.ascontiguousarray(solution.q[rows].reshape(len(rows), -1))
    v = np.ascontiguousarray(solution.v[rows].reshape(len(rows), -1))
    phi, gamma = np.zeros((2, len(rows), len(packed.ws.phi)))
    compact = np.zeros((*phi.shape, 6))
    tabulate_along(packed, solution.drives[rows], q, v, phi, compact, gamma)
    held = np.ones(len(packed.ws.phi), bool) if solution.held is None else solution.held[rows[0]].astype(bool)
    return determinants(ready, packed.spread(compact), held)


def determinants(ready: PreparedDynamics, jacobians: np.ndarray, held: np.ndarray) -> np.ndarray:
    """Return (T,) |D| of ``jacobians`` (T, m, 3 nb), of the rows that are ``held`` (m,)."""
    packed = ready.packed
    jac = jacobians[:, held] * packed.row_scale()[held, None] * packed.column_scale()
    if ready.dropped:
        rank = jac.shape[1] - len(ready.dropped)
        return np.prod(np.linalg.svd(jac, compute_uv=False)[:, :rank], axis=1)
    return np.sqrt(np.maximum(np.linalg.det(jac @ jac.transpose(0, 2, 1)), 0.0))
