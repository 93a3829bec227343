"""Genevas as arrays that the compiled loop reads and overwrites; empty where there are none, or none are looked for."""

from __future__ import annotations

from typing import Any, NamedTuple

CRANK, WHEEL = range(2)
"""Columns of Genevas.body."""
ARM_X, ARM_Y, AXIS_X, AXIS_Y, TO_X, TO_Y, RADIUS = range(7)
"""Columns of Genevas.number: the crank's marker and its x axis in the axes of its body, the wheel's marker in those of
its own, radius of the pin (m)."""


class Memory(NamedTuple):
    """Arrays of Embedding and EmbeddingScratch, by their names there, from which the next poses are predicted."""

    number: Any
    base: Any
    coordinate: Any
    block_work: Any
    body: Any
    watch: Any


class Genevas(NamedTuple):
    """g Genevas of a run with f coordinates and nb bodies."""

    body: Any
    """(g, 2) int"""
    number: Any
    """(g, 7)"""
    gap: Any
    """(2, g) x - r (m) of where steps begin, and of where they lead."""
    here: Any
    """mbsd.dynamics.state.Output of one time."""
    state: Any
    """(2, 3 + f)"""
    stage: Any
    """(2, 3 + f)"""
    before: Any
    """mbsd.dynamics.state.State: a point to return to."""
    kept: Memory
    """As it was there."""
