"""Outcome of one solution of a case, and variations of a case by name."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

# What came of one solution of a case.


AGREED, REFUSED, UNCLEAR, WRONG, HUNG = "agreed", "refused", "not compared", "wrong", "hung"
"""refused: with an error of the package, for a reason that holds. not compared: the variation does not apply, or the
motion is too sensitive to compare."""
STATES = (AGREED, REFUSED, UNCLEAR, WRONG, HUNG)
BASE = "as built"
"""The variation that is none."""


@dataclass
class Outcome:
    """Outcome of one variation of one mechanism."""

    variation: str
    state: str
    reason: str = ""
    """Reason of a refusal: the error's class and whether it was expected; why it was not compared; what is wrong."""
    detail: str = ""


@dataclass
class CaseResult:
    """All of one case."""

    seed: int
    family: str
    outcomes: list[Outcome] = field(default_factory=list)
    seconds: float = 0.0


# Where variations of a case stand by name.


class Variations[Case](dict[str, Callable[[Case], Outcome]]):
    """By name, in the order in which they are run."""

    def enter(self, name: str) -> Callable[[Callable[[Case], Outcome]], Callable[[Case], Outcome]]:
        """Decorates a variation, which takes a case and gives its outcome."""

        def entered(run: Callable[[Case], Outcome]) -> Callable[[Case], Outcome]:
            self[name] = run
            return run

        return entered
