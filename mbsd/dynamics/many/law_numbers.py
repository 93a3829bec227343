"""Numbers of laws of forces that vary, by their places in the block of a prepared run.

The start of a simulation does not depend on them. Where steps end does, on those that say when a law begins and ends;
such rows, and laws of drivers, which move the start, are prepared one by one.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from mbsd.arrays.directory import directory
from mbsd.base.codes import CYCLOIDAL, HARMONIC, POLYNOMIAL
from mbsd.base.errors import MechanismError
from mbsd.dynamics.many.base import Base
from mbsd.dynamics.many.designs import Designs
from mbsd.dynamics.many.varied import Varied
from mbsd.model.laws import Motion
from mbsd.model.numbers import put_together

TIMES_OF_CYCLOIDAL = slice(1, 3)
"""Its duration and when it begins."""


def law_columns(designs: Designs, base: Base, varied: Sequence[Varied]) -> list[tuple[int, np.ndarray]] | None:
    """Places in the block and values (n,) of all rows; None where more depends on a number, or one is refused."""
    columns: list[tuple[int, np.ndarray]] = []
    by_force: dict[str, list[Varied]] = {}
    for each in varied:
        at, force = each.number.within, designs.m.forces.get(each.whole)
        if at is None or force is None or at.key not in force.laws or at.whole in designs.changes:
            return None
        by_force.setdefault(each.whole, []).append(each)
    for name, own in by_force.items():
        own_columns = _of_force(designs, base, name, own)
        if own_columns is None:
            return None
        columns += own_columns
    return columns


def _of_force(designs: Designs, base: Base, name: str, own: Sequence[Varied]) -> list[tuple[int, np.ndarray]] | None:
    ready, laws = base.run.ready, base.arguments[0].laws
    rows = _rows(designs, name, own, ready.start, ready.end)
    if rows is None:
        return None
    columns: list[tuple[int, np.ndarray]] = []
    for k, *compiled in zip(directory(ready.packed)[name].law, *rows, strict=True):
        begin, end = int(laws.first[k]), int(laws.first[k + 1])
        if any(kind != laws.kind[k] or len(numbers) != end - begin for kind, numbers in compiled):
            return None
        numbers = np.array([numbers for _, numbers in compiled])
        fixed = {POLYNOMIAL: slice(0), HARMONIC: slice(0), CYCLOIDAL: TIMES_OF_CYCLOIDAL}.get(
            int(laws.kind[k]), slice(None)
        )
        if (numbers[:, fixed] != laws.numbers[begin:end][fixed]).any():
            return None
        columns += [(base.layout.place(laws.numbers, begin + c), numbers[:, c].copy()) for c in range(end - begin)]
    return columns


def _rows(designs: Designs, name: str, own: Sequence[Varied], start: float, end: float) -> list[list[Any]] | None:
    """For each row all laws of the force as kernels evaluate them; None where one is refused."""
    work, numbers = designs.copied(), [each.number for each in own]
    before, out = work.forces[name].params, []
    for row in range(designs.count):
        try:
            put_together(work, numbers, [float(each.values[row]) for each in own])
            force = work.forces[name]
            ready = [law.as_load(start, end) if isinstance(law, Motion) else law for law in force.laws.values()]
            out.append([law.compiled(start, end) for law in ready])
        except MechanismError:
            return None
        if force.params != before:
            return None
    return out
