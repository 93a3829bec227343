"""Reactions and efforts of a simulation at and near change points, where J loses rank: from poses beside, as of sweeps.

    D^2 = det(J J^T)     D: the product of the singular values of the rows that hold, with a sign

is a smooth function of the time, with a double root where the motion passes such a pose. With the root known, D changes
its sign there, and the efforts follow as mbsd/arrays/efforts_beside.py says.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from mbsd.arrays.curve_branches import tabulate_along
from mbsd.arrays.efforts_beside import fill_beside, lagrange
from mbsd.base.errors import SimulationError
from mbsd.dynamics.prepare.prepared import PreparedDynamics
from mbsd.kinematics.change_points.assemblies import APART
from mbsd.kinematics.change_points.sides import NEAR, sides_beside
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

Motion = Callable[[np.ndarray], Solution]


def near_singular(solution: Solution) -> np.ndarray:
    """(T,) whether outputs may be near a change point, by their margins and multipliers."""
    margin, largest = solution.singularity_margin, np.abs(solution.lam).max(axis=1, initial=0.0)
    return ~((margin >= SUSPECT * np.nanmax(margin, initial=0.0)) & (largest <= ODD * np.median(largest)))


def with_efforts_beside(
    ready: PreparedDynamics, solution: Solution, motion: Motion, span: tuple[float, float]
) -> Solution:
    """The solution with reactions and efforts at outputs near change points taken from poses beside.

    ``motion`` solves it at other times (T,) within ``span`` (s), efforts as they come, and begins at no output near.
    """
    suspects, margin = np.flatnonzero(near_singular(solution)), solution.singularity_margin.copy()
    if not len(suspects) or len(suspects) == len(margin) or ready.packed.states:
        return solution
    lam, wrench = solution.lam.copy(), solution.wrench.copy()
    poses = [part.copy() for part in (solution.q, solution.v, solution.a)]
    closeness = _determinants(ready, solution, suspects)
    clear = np.setdiff1d(np.arange(len(margin)), suspects)
    usual = _determinants(ready, solution, clear[np.argsort(margin[clear])][len(clear) // 2 : len(clear) // 2 + 1])[0]
    filled, beside = np.zeros(len(margin), bool), []
    for row, own in sorted(zip(suspects.tolist(), closeness.tolist(), strict=True), key=lambda pair: pair[1]):
        if filled[row] or not own < CLOSE * usual:
            continue
        for known in _beside(ready, solution, motion, span, row):
            side, there = known.side, known.motion
            beside.append(known)
            rows = np.searchsorted(solution.t, side.rows)
            alone = np.arange(len(side.nodes))
            both = [np.concatenate([there.lam, lam[rows]]), np.concatenate([there.wrench, wrench[rows]])]
            fill_beside(solution.packed, side, known.factor, both[0], both[1], alone, len(alone) + np.arange(len(rows)))
            lam[rows], wrench[rows] = (part[len(alone) :] for part in both)
            filled[rows] = True
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


def _beside(
    ready: PreparedDynamics, solution: Solution, motion: Motion, span: tuple[float, float], row: int
) -> list[Beside]:
    """Poses beside the change point near output ``row``, D there and at the outputs near it, and the motion there."""
    scale = ready.packed.column_scale()[: 3 * (solution.v.shape[1] - 1)]
    speed = float(np.abs(solution.v[row, 1:].ravel() / scale).max())
    if not speed > 0.0:
        return []
    pace, (start, end) = 1.0 / speed, span
    try:
        time = _root(ready, motion, float(solution.t[row]), pace, span)
        if time is None:
            return []
        near = np.abs(solution.t - time) < NEAR * pace
        near[1:] &= np.diff(solution.t, prepend=-np.inf)[1:] > 0.0
        out = []
        for side in sides_beside(time, solution.t[near], pace, start, end):
            if side.nodes[0] < start or side.nodes[-1] > end:
                continue
            there = motion(side.nodes)
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
    return time


def _determinants(ready: PreparedDynamics, solution: Solution, rows: np.ndarray) -> np.ndarray:
    """(R,) |D| at outputs ``rows`` (R,) of a solution."""
    packed = ready.packed
    q = np.ascontiguousarray(solution.q[rows].reshape(len(rows), -1))
    v = np.ascontiguousarray(solution.v[rows].reshape(len(rows), -1))
    phi, gamma = np.zeros((2, len(rows), len(packed.ws.phi)))
    compact = np.zeros((*phi.shape, 6))
    tabulate_along(packed, solution.drives[rows], q, v, phi, compact, gamma)
    held = np.ones(len(packed.ws.phi), bool) if solution.held is None else solution.held[rows[0]].astype(bool)
    held[list(ready.dropped)] = False
    jac = packed.spread(compact)[:, held] * packed.row_scale()[held, None] * packed.column_scale()
    return np.sqrt(np.maximum(np.linalg.det(jac @ jac.transpose(0, 2, 1)), 0.0))
