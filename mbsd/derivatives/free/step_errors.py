"""Steps of tangents as short as their errors ask for: those that err too much are divided."""

from __future__ import annotations

from collections.abc import Callable
from typing import TypeVar

import numpy as np

from mbsd.base.errors import ModelWarning
from mbsd.base.warning import warn
from mbsd.derivatives.free.free_tangents import Tangents
from mbsd.derivatives.free.mesh import refined

ENOUGH = 5e-6
"""Error of tangents, as part of the largest, beyond which nodes come closer."""
AIMED = 1e-6
"""Error at which they then aim, as part of the largest tangent."""
OF_KINKS = 0.05
"""Part of these where contacts by penalty have kinks, of which the estimate knows too little."""
MOST, PATIENCE = 14, 6
"""So often at most, and so often without less error: a toggle of 1e-7 s is found by parts, a jump never."""
VAIN = 3
"""So often shorter steps may leave as much noise: then it is the motion's own."""
DOUBTFUL = 1e-3
"""Error that is warned of."""
MOST_STEPS = 20_000
"""Steps at most."""

Result = TypeVar("Result")
Way = Callable[[np.ndarray], tuple[np.ndarray, Callable[[], Result]]]
"""Gives the errors (d, 3) of steps between edges (linear_motion.py), and what finishes."""
Finish = Callable[[], Tangents | None]
"""Evaluates tangents at the outputs of which they are asked; None where that gave the slopes themselves."""


def refined_to_error(way: Way[Result], edges: np.ndarray, kinked: bool, name: str) -> tuple[Result, float]:
    """Return tangents of ``name`` by one way, beginning with steps between ``edges`` (k,) (s), and their error.

    ``kinked`` says that contacts by penalty are among the forces. The error is a part of the largest tangent.
    """
    before = error = 0.0
    least, waited = np.inf, 0
    quietest, vain = np.inf, 0
    part = OF_KINKS if kinked else 1.0
    for turn in range(MOST):
        errors, finish = way(edges)
        before, error = error, float(errors[:, 0].sum() + errors[:, 1].max())
        noise = float(np.linalg.norm(errors[:, 2]))
        vain = 0 if noise < 0.5 * quietest else vain + 1
        quietest = min(quietest, noise)
        waited = 0 if error < 0.5 * least else waited + 1
        least = min(least, error)
        is_last = turn == MOST - 1 or waited == PATIENCE - 1
        helps = noise > part * ENOUGH and vain < VAIN
        if (error <= part * ENOUGH and not helps) or len(errors) != len(edges) - 1 or is_last:
            break
        if not helps:
            errors = errors * [1.0, 1.0, 0.0]
        finer = refined(edges, errors, part * AIMED)
        if len(finer) > MOST_STEPS:
            break
        edges = finer
    if error > part * ENOUGH and is_last:  # where forces jump, a node meets them or misses them by chance
        error = max(before, error)
    if error > DOUBTFUL:
        warn(
            f"{name}: derivatives along this simulation are known to {error:.1g} of the largest at best, "
            "however close their nodes are. A force that jumps, or a curve that bends more tightly than the wheel "
            "on it, does that: smooth it. A toggle that is passed within no time does it, too: take differences of "
            "whole simulations",
            ModelWarning,
        )
    elif noise > DOUBTFUL:
        warn(
            f"{name}: derivatives along this simulation may err by {min(noise, 1.0):.1g} of themselves. It passes a "
            "toggle, where they are so much larger that little of their digits is left. Take differences of whole "
            "simulations, or masses and lengths that pass it less closely",
            ModelWarning,
        )
    return finish(), max(error, noise)
