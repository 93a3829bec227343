"""Checks of requests before a motion is solved: quantities by name, functions, times of measures."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from mbsd.base.arguments import refuse_other_arguments
from mbsd.base.warning import quiet
from mbsd.derivatives.asked import reads_bodies, reads_forces
from mbsd.dynamics.measures.kinds import Measure
from mbsd.dynamics.measures.quantities import quantity_named
from mbsd.dynamics.simulate import simulate
from mbsd.kinematics.sweep import sweep
from mbsd.model.mechanism import Model
from mbsd.results.columns import columns

INSTANT = 1e-9
"""s of a simulation that tells the names of quantities."""


def refuse_unfit(m: Model, wishes: Sequence[tuple[str, Any]], grid: np.ndarray, free: bool) -> None:
    """Raise ModelError for quantities that there are not, and for what does not suit output times (T,) (s).

    ``wishes`` are quantities by name, measures and functions, each with the words that an error begins
    with. Names that may not be are looked for in the motion at its start: a simulation if it is ``free``, else a sweep.
    """
    names: list[str] = []
    for what, wish in wishes:
        if isinstance(wish, Measure):
            wish.check(what, grid)
            names += wish.quantities
        elif isinstance(wish, str):
            names.append(wish)
        elif callable(wish):
            refuse_other_arguments(what, wish, "a solution")
    doubtful = [name for name in names if reads_bodies(m, name) is None and reads_forces(m, name) is None]
    if not doubtful:
        return
    with quiet():  # the motion itself says it again
        if free:
            first = simulate(m, None, 1, grid[0] + INSTANT * np.arange(2.0), "dop853", 1e-6, None, None, {})
        else:
            first = sweep(m, None, 1, grid[:1])
    known = list(columns(first))
    for name in doubtful:
        quantity_named(m, name, known)
