"""Genevas of a prepared run for the compiled loop over simulations."""

from __future__ import annotations

import numpy as np

from mbsd.arrays.packing import Packed
from mbsd.dynamics.genevas.arrays import RADIUS, Genevas, Memory
from mbsd.dynamics.independent.arrays import Embedding, EmbeddingScratch
from mbsd.dynamics.state import State, output_for

_NOTHING = tuple(np.zeros((0,) * dimensions) for dimensions in (2, 2, 2, 1, 2, 1))
"""In place of what steps in independent coordinates predict from."""


def genevas_of(packed: Packed, state: State, arrays: Embedding, scratch: EmbeddingScratch) -> Genevas | None:
    """Return the Genevas of a run in independent coordinates at its start, or None without any."""
    rows = _rows(packed)
    if not rows:
        return None
    memory = arrays.number, scratch.base, scratch.coordinate, scratch.block_work, scratch.body, scratch.watch
    width = state.y.shape[1]
    return _genevas(rows, 3 * len(packed.body_names), width, State(*(np.zeros_like(part) for part in state)), memory)


def no_genevas(state: State) -> Genevas:
    """Return empty arrays, as for runs in reference coordinates, where steps end anywhere."""
    return _genevas([], 0, 0, State(*(np.zeros((0,) * part.ndim, part.dtype) for part in state)), _NOTHING)


def _genevas(
    rows: list[tuple[float, ...]], coordinates: int, width: int, before: State, memory: tuple[np.ndarray, ...]
) -> Genevas:
    return Genevas(
        np.array([row[:2] for row in rows], np.int64).reshape(-1, 2),
        np.array([row[2:] for row in rows], float).reshape(-1, RADIUS + 1),
        np.zeros((2, len(rows))),
        output_for(np.zeros(min(len(rows), 1)), coordinates, 0),
        np.zeros((2, width)),
        np.zeros((2, width)),
        before,
        Memory(*(np.zeros_like(part) for part in memory)),
    )


def _rows(packed: Packed) -> list[tuple[float, ...]]:
    """Return the numbers of Genevas.body and Genevas.number of each."""
    specials, system = packed.specials, packed.system
    return [
        (
            *(int(system.marker_body[marker]) for marker in place[:2]),
            *system.marker_arm[place[0]].tolist(),
            *system.marker_axis[place[0]].tolist(),
            *system.marker_arm[place[1]].tolist(),
            float(joint.params["radius"]),
        )
        for name, joint, place in zip(specials.names, specials.joints, specials.places, strict=True)
        if name == "geneva"
    ]
