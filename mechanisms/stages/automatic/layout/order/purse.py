"""What the search for layers may cost in all, in conflicts of the solver: no clock, so it ends the same everywhere."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from mechanisms.stages.automatic.layout.order.layer_clauses import Clauses

ALL = 500_000
"""Conflicts that the whole search for the parts of one mechanism may cost: some hundred times what it takes."""


class Undecided(Exception):
    """The purse is empty, and whether there is an order of layers is not known."""


@dataclass
class Purse:
    """Conflicts of the solver that are left for questions which have no budget of their own."""

    left: int = ALL

    def solved(self, clauses: Clauses, assumed: Sequence[int] = ()) -> bool:
        """Whether there is a model. Raises Undecided where the purse does not last."""
        before = clauses.spent
        answer = clauses.solved(assumed, max(self.left, 1))
        self.left -= clauses.spent - before
        if answer is None:
            raise Undecided
        return answer
