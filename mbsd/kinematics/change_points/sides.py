"""Poses beside a change point for the efforts near it, and the determinant of J at these.

mbsd/arrays/efforts_beside.py says how. There are poses on both sides of the change point, or on one side alone where
the motion begins or ends there or switches to the other assembly.
"""

from __future__ import annotations

import numpy as np

from mbsd.arrays.efforts_beside import Side, lagrange
from mbsd.kinematics.change_points.assemblies import APART
from mbsd.kinematics.change_points.passages import Passage

NEAR = 0.02
"""Distance from the change point, in sizes and rad, within which efforts are those of poses beside."""
ONE_SIDE = 0.0325 + 0.0275 * np.cos(np.pi * (np.arange(8)[::-1] + 0.5) / 8)
"""Distances of the poses where there are some on one side alone, in sizes and rad: Chebyshev's."""
VANISHES = 1e-6
"""Part of its largest value below which the determinant of a block vanishes at the change point."""


def sides_of(passage: Passage, times: np.ndarray) -> list[Side]:
    """Return poses beside a change point for efforts at rising ``times`` (T,) (s), with their indices."""
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
    """The same for a change point at ``time`` (s); in ``pace`` (s) the motion goes on by 1 size or rad.

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
    """Return (T,) products of determinants that vanish at a change point, on one side of it.

    ``times`` are in s.
    """
    assembly = passage.after if passage.is_switched and times[0] > passage.time else passage.before
    weights = lagrange(assembly.nodes, np.append(passage.way.at(times)[:, 0], 0.0))
    values = weights @ assembly.determinant
    vanishing = np.abs(values[-1]) < VANISHES * np.abs(assembly.determinant).max(axis=0)
    return np.prod(values[:-1, vanishing], axis=1)
