"""Efforts at and near a pose where J is singular, from those at poses beside it.

With J^T lam = Q - M a the multipliers are  lam = y / D,  D the determinant of J and y smooth functions of the time, by
Cramer's rule. Where D has a root t_c,

    y(t_c) = 0     lam has a limit, and is smooth itself
    y(t_c) != 0    lam grows without bound as 1 / (t - t_c), and there is none at t_c

Both are told from poses at which D is not small, on both sides of t_c, or on one side where the motion begins, ends or
switches to the other assembly; polynomials through these give what is between. Reactions go with the multipliers.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from mbsd.arrays.packing import Packed
from mbsd.kinematics.change_points import APART, lagrange
from mbsd.kinematics.passages import Passage

NEAR = 0.02
"""Distance from the change point, in sizes and rad, within which efforts are those of poses beside."""
ONE_SIDE = 0.0325 + 0.0275 * np.cos(np.pi * (np.arange(8)[::-1] + 0.5) / 8)
"""Distances of the poses where there are some on one side alone, in sizes and rad: Chebyshev's."""
VANISHES = 1e-6
"""Part of its largest value below which the determinant of a block vanishes at the change point."""
FINITE = 1e-7
"""Part of its largest value below which y vanishes, too."""
NOISE = 1e-8
"""The same as a part of the largest of all y."""
TOLD, LEAST = 1e-5, 1e-2
"""Error, as a part of the largest value beside or of that part of the largest of all, beyond which none is told."""
AT_ROOT = 1e-8
"""Part of the largest D beside below which lam = y / D is not a number."""


@dataclass
class Side:
    """Poses beside a change point from which efforts of others follow."""

    time: float
    """Of the change point (s)."""
    nodes: np.ndarray
    """(N,) rising times (s)."""
    rows: np.ndarray
    """(R,) times whose efforts follow (s)."""

    def efforts(self, factor: np.ndarray, beside: np.ndarray, arms: np.ndarray) -> np.ndarray:
        """(R, k) values at the rows from those ``beside`` (N, k) at the nodes; NaN where there are none.

        ``factor`` (N + R,): D at the nodes, then at the rows. ``arms`` (k,): what makes forces of all values (1 or 1/m).
        """
        count = len(self.nodes)
        scaled = factor / np.abs(factor[:count]).max()
        y = scaled[:count, None] * beside
        every = np.append(self.rows, self.time)
        weights = lagrange(self.nodes, every)
        inner = np.ones(count, bool)
        inner[np.argmax(np.abs(self.nodes - self.time))] = False
        fewer = lagrange(self.nodes[inner], every)
        at_root, doubt = weights[-1] @ y, np.abs(weights[-1] @ y - fewer[-1] @ y[inner])
        largest = np.abs(y).max(axis=0)
        rounding = np.maximum(FINITE * largest, NOISE * float((largest * arms).max(initial=0.0)) / arms)
        is_finite = np.abs(at_root) <= rounding + 10.0 * doubt
        limit, wrong = weights[:-1] @ beside, np.abs(weights[:-1] @ beside - fewer[:-1] @ beside[inner])
        most = np.abs(beside).max(axis=0)
        limit[wrong > TOLD * np.maximum(most, LEAST * float((most * arms).max(initial=0.0)) / arms)] = np.nan
        root = scaled[count:, None]
        with np.errstate(divide="ignore", invalid="ignore"):
            unbounded = np.where(np.abs(root) > AT_ROOT, (weights[:-1] @ y) / root, np.nan)
        return np.where(is_finite, limit, unbounded)


def sides_of(passage: Passage, times: np.ndarray) -> list[Side]:
    """Poses beside a change point for the efforts at rising ``times`` (T,) (s) of a motion, and which these are."""
    rows = times[passage.covers(times)]
    rows = rows[np.abs(passage.way.at(rows)[:, 0]) < NEAR]
    if not len(rows):
        return []
    _, rate, second = passage.way.at(np.array([passage.time]))[0]
    pace = max(abs(rate), np.sqrt(0.5 * NEAR * abs(second)))
    if not pace > 0.0:
        return [Side(passage.time, np.zeros(0), rows)]
    apart, ends = passage.is_switched, (float(times[0]), float(times[-1]))
    there = passage.is_at(rows) if apart else np.zeros(len(rows), bool)
    sides = sides_beside(passage.time, rows[~there], 1.0 / pace, *ends, apart)
    return [*sides, Side(passage.time, np.zeros(0), rows[there])] if there.any() else sides


def sides_beside(
    time: float, rows: np.ndarray, pace: float, start: float, end: float, is_switched: bool = False
) -> list[Side]:
    """The same for a change point at ``time`` (s) by the time in which the motion goes on by 1 size or rad, ``pace`` (s).

    ``rows`` (R,): times of the efforts (s); ``start``, ``end``: times of the whole motion (s).
    """
    away = pace * NEAR * APART
    reach = float(away[-1])
    is_open = start <= time - reach and time + reach <= end
    early, late = start <= time - reach, time + reach <= end
    if not is_switched and (is_open or not (early or late)):
        return [Side(time, time + np.concatenate([-away[::-1], away]), rows)]
    alone = pace * ONE_SIDE
    sides = [Side(time, time - alone[::-1], rows[rows < time]), Side(time, time + alone, rows[rows > time])]
    if is_switched:
        return [side for side in sides if len(side.rows)]
    side = sides[0] if early else sides[1]
    return [Side(time, side.nodes, rows)]


def determinant_of(passage: Passage, times: np.ndarray) -> np.ndarray:
    """(T,) the product of the determinants that vanish at a change point, at ``times`` (s) on one side of it."""
    assembly = passage.after if passage.is_switched and times[0] > passage.time else passage.before
    weights = lagrange(assembly.nodes, np.append(passage.way.at(times)[:, 0], 0.0))
    values = weights @ assembly.determinant
    vanishing = np.abs(values[-1]) < VANISHES * np.abs(assembly.determinant).max(axis=0)
    return np.prod(values[:-1, vanishing], axis=1)


def fill_beside(
    packed: Packed,
    side: Side,
    factor: np.ndarray,
    lam: np.ndarray,
    wrench: np.ndarray,
    nodes: np.ndarray,
    rows: np.ndarray,
) -> None:
    """Fill lam (T, m) and wrench (T, joints, 3) at ``rows`` (R,) from those at ``nodes`` (N,); NaN without nodes.

    ``factor`` (N + R,): D at these.
    """
    arms = 1.0 / np.concatenate(
        [1.0 / (packed.row_scale() * packed.size), np.tile([1.0, 1.0, packed.size], wrench.shape[1])]
    )
    flat = wrench.reshape(len(wrench), -1)
    values = np.full((len(rows), lam.shape[1] + flat.shape[1]), np.nan)
    if len(nodes):
        values = side.efforts(factor, np.hstack([lam[nodes], flat[nodes]]), arms)
    lam[rows], wrench[rows] = values[:, : lam.shape[1]], values[:, lam.shape[1] :].reshape(len(rows), *wrench.shape[1:])
