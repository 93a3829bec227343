"""Genevas of a prepared run for the compiled loop over simulations."""

from __future__ import annotations

import numpy as np

from mbsd.dynamics.many.indexing.arrays import RADIUS, Genevas, Memory
from mbsd.dynamics.prepare.prepared import PreparedDynamics
from mbsd.dynamics.runs.independent_steps import IndependentSteps
from mbsd.dynamics.runs.indexing import memory
from mbsd.dynamics.state import State, output_for


def genevas_of(ready: PreparedDynamics, state: State, independent: IndependentSteps | None) -> Genevas:
    """Those of a run at its start; none in reference coordinates, where steps end anywhere."""
    rows = [] if independent is None else independent.genevas.rows
    count, n3, width = len(rows), len(ready.initial.q) if rows else 0, state.y.shape[1] if rows else 0
    before = State(*(np.zeros(part.shape if rows else (0,) * part.ndim, part.dtype) for part in state))
    own = memory(independent.arrays, independent.scratch) if independent is not None and rows else _NOTHING
    return Genevas(
        np.array([row[:2] for row in rows], np.int64).reshape(-1, 2),
        np.array([row[2:] for row in rows], float).reshape(-1, RADIUS + 1),
        np.zeros((2, count)),
        output_for(np.zeros(count and 1), n3, 0),
        np.zeros((2, width)),
        np.zeros((2, width)),
        before,
        Memory(*(np.zeros_like(part) for part in own)),
    )


_NOTHING = tuple(np.zeros((0,) * dimensions) for dimensions in (2, 2, 2, 1, 2, 1))
"""In place of what steps in independent coordinates predict from."""
