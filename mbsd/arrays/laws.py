"""Laws of drivers and forces as one table."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from mbsd.arrays.directory import directory
from mbsd.base.users_function import law_of, tell_missed
from mbsd.equations.laws import Laws, tabulate_law
from mbsd.model.laws import Motion
from mbsd.model.laws.numbers import (
    ZERO,
    Compiled,
)

if TYPE_CHECKING:
    from mbsd.arrays.packing import Packed
    from mbsd.model.force import Force


def pack_laws(laws: Sequence[Compiled]) -> Laws:
    """One table of laws; the constant zero is put before them."""
    everything = [ZERO, *laws]
    sizes = [len(numbers) for _, numbers in everything]
    return Laws(
        np.array([kind for kind, _ in everything], np.int64),
        np.concatenate([[0], np.cumsum(sizes)]).astype(np.int64),
        np.concatenate([np.asarray(numbers, float) for _, numbers in everything]),
    )


def compiled_laws(packed: Packed, start: float, end: float) -> Laws:
    """The laws of drivers, then those of forces, for times ``start`` .. ``end`` (s)."""
    laws = []
    for name, motion in zip(packed.driver_names, packed.motions, strict=True):
        with law_of(f"{packed.name}: driver '{name}'"):
            laws.append(motion.compiled(start, end))
    for force in packed.forces:
        for what, law in force.laws.items():
            with law_of(f"{packed.name}: force '{force.name}': {what}"):
                ready = law.as_load(start, end) if isinstance(law, Motion) else law
                laws.append(ready.compiled(start, end))
                tell_missed(f"{packed.name}: force '{force.name}': {what}", ready)
    return pack_laws(laws) if laws else _NONE


def law_values(packed: Packed, laws: Laws, force: Force, times: np.ndarray) -> dict[str, np.ndarray]:
    """(T,) values of the laws of a force at times (T,) (s), by the names of its method's arguments."""
    out = np.zeros((len(force.laws), len(times), 3))
    for k, rows in zip(directory(packed)[force.name].law, out, strict=True):
        tabulate_law(laws, k, np.ascontiguousarray(times, float), rows)
    return {name: rows[:, 0] for name, rows in zip(force.laws, out, strict=True)}


_NONE = pack_laws(())
