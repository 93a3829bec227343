"""Reactions along a motion, of least norm where joints repeat each other, and its residuals.

    J^T lam = Q - M a
    J^T = Q R   =>   lam = R^-1 Q^T (Q - M a)         rows are independent
    J = Q R     =>   lam = Q R^-T (Q - M a)           rows fix all bodies, and some repeat others
    J = U s V^T =>   lam = U s^-1 V^T (Q - M a)       else, the largest s that count

Rows of J are dimensionless: a force counts as its moment at one size of the mechanism, whatever the unit of length.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

from mbsd.arrays.efforts_beside import Side, efforts_beside
from mbsd.equations.laws import Laws
from mbsd.spatial.arrays.along import loads_along, tabulated
from mbsd.spatial.arrays.packing import Packed
from mbsd.spatial.equations.evaluation import wrenches_along

JACOBIAN_NUMBERS = 2_000_000
"""Numbers of Jacobians held at once."""


class Beside(NamedTuple):
    """A motion at poses beside a change point, from which efforts near it follow."""

    side: Side
    factor: np.ndarray
    """(N + R,) the determinant of J there, then at the steps near the change point."""
    motion: Any
    """DrivenMotion of N rows."""


def with_reactions(packed: Packed, laws: Laws, motion: Any, redundant: int, beside: Sequence[Beside] = ()) -> Any:
    """Return a DrivenMotion with multipliers and wrenches; ``redundant`` rows of joints repeat others."""
    if not beside:
        return _with_reactions(packed, laws, motion, redundant)
    lam, wrench = (np.full((len(motion.q), *part.shape[1:]), np.nan) for part in (motion.lam, motion.wrench))
    clear = ~np.isin(motion.times, np.concatenate([known.side.rows for known in beside]))
    apart = {name: part[clear] for name, part in motion._asdict().items() if name != "stride" and len(part)}
    solved = _with_reactions(packed, laws, motion._replace(**apart), redundant)
    lam[clear], wrench[clear] = solved.lam, solved.wrench
    scale = np.ones(lam.shape[1])
    scale[: packed.system.held] = packed.row_scale
    for side, factor, nodes in beside:
        there = _with_reactions(packed, laws, nodes, redundant)
        rows = np.searchsorted(motion.times, side.rows)
        lam[rows], wrench[rows] = efforts_beside(side, factor, there.lam, there.wrench, scale, packed.size)
    return motion._replace(lam=lam, wrench=wrench)


def _with_reactions(packed: Packed, laws: Laws, motion: Any, redundant: int) -> Any:
    if len(motion.lam) == len(motion.q):
        return motion
    motion = motion._replace(lam=_multipliers(packed, laws, motion, redundant))
    wrench = np.zeros((len(motion.q), len(packed.passive_joints), 6))
    wrenches_along(packed.system, motion.drives, np.ascontiguousarray(motion.q), packed.ws, motion.lam, wrench)
    return motion._replace(wrench=wrench)


def _multipliers(packed: Packed, laws: Laws, motion: Any, redundant: int) -> np.ndarray:
    drives, q, v, turns = motion.drives, motion.q, motion.v, motion.turn
    count, rows = len(q), len(packed.row_joint)
    loads, lam = loads_along(packed, laws, motion)
    each = max(1, JACOBIAN_NUMBERS // max(1, rows * packed.freedoms))
    for first in range(0, count, each):
        part = slice(first, first + each)
        _, jac, _ = tabulated(packed, drives[part], q[part], v[part], turns[part])
        jac = jac * packed.row_scale[:, None]
        lam[part, :rows] = _least_norm(jac, loads[part, 3:, None], rows - redundant)[..., 0] * packed.row_scale
    return lam


def _least_norm(jac: np.ndarray, load: np.ndarray, rank: int) -> np.ndarray:
    """Return x (T, m, 1) of least norm with J^T x = load, J (T, m, n)."""
    rows, columns = jac.shape[1:]
    if rank == rows:
        orthogonal, upper = np.linalg.qr(np.swapaxes(jac, 1, 2))
        return np.linalg.solve(upper, np.swapaxes(orthogonal, 1, 2) @ load)
    if rank == columns:
        orthogonal, upper = np.linalg.qr(jac)
        return orthogonal @ np.linalg.solve(np.swapaxes(upper, 1, 2), load)
    left, size, right = np.linalg.svd(jac, full_matrices=False)
    return left[..., :rank] @ ((right[:, :rank] @ load) / size[:, :rank, None])


def residuals(packed: Packed, laws: Laws, motion: Any) -> tuple[float, float, float, float]:
    """Return the largest |Phi|, |J v - nu|, |J a - gamma| and missing power of a motion (SI)."""
    phi, jac, gamma = tabulated(packed, motion.drives, motion.q, motion.v, motion.turn)
    nu = np.zeros(phi.shape)
    for row, law in packed.system.driven:
        nu[:, row] = motion.drives[:, law, 1]
    speed = np.einsum("trc,tc->tr", jac, motion.v[:, 3:]) - nu
    bend = np.einsum("trc,tc->tr", jac, motion.a[:, 3:]) - gamma
    loads, _ = loads_along(packed, laws, motion)
    power = (loads * motion.v).sum(axis=1) - (motion.lam[:, : nu.shape[1]] * nu).sum(axis=1)
    return (
        float(np.abs(phi).max(initial=0.0)),
        float(np.abs(speed).max(initial=0.0)),
        float(np.abs(bend).max(initial=0.0)),
        float(np.nan_to_num(np.abs(power)).max(initial=0.0)),
    )
