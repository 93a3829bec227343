"""Where laws of time jump: f of a force, f'' of a driver, by the pieces that kernels evaluate."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from mbsd.base.codes import PIECES
from mbsd.equations.laws import Laws
from mbsd.model.laws.fitting.leaves import finest

if TYPE_CHECKING:
    from mbsd.arrays.packing import Packed

LAW_STEP = 1e-6
"""Part of its size by which a law's pieces disagree where it jumps."""
BESIDE = 1e-12
"""How far (of the span) a driven motion is evaluated from a jump, so that its author's functions are clear of it."""


def disagreeing(own: np.ndarray, order: int, part: float, over: float = 0.0) -> list[float]:
    """Return times at which pieces of a law disagree in a derivative by more than ``part`` of its size.

    The law has the numbers ``own``.

    Within ``over`` (s) if that is given: where the next derivative does.
    """
    rows = own[3:].reshape(-1, 7)
    h = np.diff(rows[:, 0])
    coefficients = rows[:, 1:]
    for _ in range(order):
        coefficients = coefficients[:, 1:] * np.arange(1, coefficients.shape[1])
    size = float(np.abs(coefficients[:, 0]).max())
    if over:
        coefficients, size = coefficients[:, 1:] * np.arange(1, coefficients.shape[1]), size / over
    ends = (coefficients[:-1] * h[:, None] ** np.arange(coefficients.shape[1])).sum(axis=1)
    return rows[1:, 0][np.abs(coefficients[1:, 0] - ends) > part * size].tolist()


def jump_times(packed: Packed, laws: Laws, start: float, end: float) -> dict[float, tuple[str, ...]]:
    """Return times (s) between ``start`` and ``end`` of possible jumps, with their drivers and forces.

    For functions of the user, the breaks that were given count.
    """
    jumping: dict[float, dict[str, None]] = {}
    names = [(name, 2) for name in packed.driver_names]
    names += [(force.name, 0) for force in packed.forces for _ in force.laws]
    given = [(float(t), force.name) for force in packed.forces for t in force.params.get("breaks", ())]
    for k, (name, order) in enumerate(names, start=1):
        if laws.kind[k] == PIECES:
            own = laws.numbers[laws.first[k] : laws.first[k + 1]]
            given += [(t, name) for t in disagreeing(own, order, LAW_STEP)]
    for t, name in given:
        if start < t < end:
            jumping.setdefault(t, {})[name] = None
    return {t: tuple(jumping[t]) for t in sorted(jumping)}


def reach_beside(start: float, end: float) -> float:
    """How far (s) from a jump a driven motion from ``start`` to ``end`` (s) is evaluated."""
    return BESIDE * (end - start) + finest(start, end)
