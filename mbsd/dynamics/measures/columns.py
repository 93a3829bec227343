"""Rows that were simulated, as columns of numbers."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from mbsd.base.errors import ModelError
from mbsd.base.names import shown
from mbsd.dynamics.measures.kinds import Measure


@dataclass
class Done:
    """Rows that were simulated: columns of numbers, NaN where there is a reason."""

    columns: dict[str, np.ndarray]
    reasons: list[str | None]
    alone: list[str | None]
    """Why each was simulated by itself; None of those in the compiled loop."""

    def row(self, k: int) -> Done:
        """One of them."""
        columns = {name: column[k : k + 1] for name, column in self.columns.items()}
        return Done(columns, [self.reasons[k]], [self.alone[k]])


def columns_of(
    measures: Mapping[str, Measure], t: np.ndarray, along: Mapping[str, np.ndarray]
) -> dict[str, np.ndarray]:
    """All columns, from values (n, T) of the quantities."""
    out: dict[str, np.ndarray] = {}
    for name, measure in measures.items():
        out |= measure.of(name, t, along)
    return out


def numbers_of(owner: str, given: Any) -> dict[str, float]:
    """Return the numbers that a function of the user gave. Raises ModelError for anything but names and numbers."""
    if not isinstance(given, Mapping) or not given:
        raise ModelError(f"{owner}: measure gives {shown(given)}; it must give names and numbers {{name: number}}")
    out = {}
    for name, value in given.items():
        value = value.item() if getattr(value, "size", 0) == 1 and hasattr(value, "item") else value
        if not isinstance(name, str) or not isinstance(value, bool | int | float):
            raise ModelError(
                f"{owner}: measure gives {shown(value)} as {shown(name)}; it must be a number under a name"
            )
        out[name] = float(value)
    return out


def failed(reason: str, why: str | None = None) -> Done:
    """One row with a reason."""
    return Done({}, [reason], [why])


def joined(parts: Sequence[Done]) -> Done:
    """Rows one after the other; NaN where a row has no number."""
    names = list(dict.fromkeys(name for part in parts for name in part.columns))
    columns = {}
    for name in names:
        shape = next(part.columns[name].shape[1:] for part in parts if name in part.columns)
        columns[name] = np.concatenate(
            [part.columns.get(name, np.full((len(part.reasons), *shape), np.nan)) for part in parts]
        )
    reasons = [reason for part in parts for reason in part.reasons]
    return Done(columns, reasons, [why for part in parts for why in part.alone])
