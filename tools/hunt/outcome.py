"""What came of one solution of a case."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

from mbsd.base.errors import MechanismError

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


class Raw(Exception):
    """An error that is none of the package: what a user would see as a traceback."""


def attempt(solve: Callable[[], Any]) -> tuple[Any, MechanismError | None]:
    """The solution, or the package's error; anything else comes out as :class:`Raw`."""
    try:
        return solve(), None
    except MechanismError as error:
        return None, error
    except Exception as error:
        import traceback

        where = traceback.extract_tb(error.__traceback__)[-1]
        raise Raw(f"{type(error).__name__}: {error} ({where.filename}:{where.lineno})") from error
