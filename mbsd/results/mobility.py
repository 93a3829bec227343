"""Mobility: what the joints of a mechanism leave free."""

from __future__ import annotations

from dataclasses import dataclass

from mbsd.base.names import Suggesting
from mbsd.base.quantity import counted


@dataclass(frozen=True)
class Mobility(Suggesting):
    """Freedoms that the joints leave."""

    nominal: int
    """By counting rows."""
    dof: int
    """By rank."""
    redundant_rows: int
    """How many rows repeat others: the nominal count is wrong by this many."""
    redundant: tuple[str, ...]
    """Joints those rows belong to: one removable set."""
    singular: bool
    """The start pose has a lower rank than poses near it."""
    free_bodies: tuple[str, ...]
    """Bodies that can move."""

    def __str__(self) -> str:
        text = f"{counted(self.dof, 'degree')} of freedom ({self.nominal} nominal)"
        if self.redundant:
            rows = counted(self.redundant_rows, "redundant row")
            text += f", {rows}, removable at {', '.join(self.redundant)}"
        return text + (", start pose singular" if self.singular else "")
