"""Subject of a hunt: a mechanism, its duration, and what is known about it without the solver."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from mbsd import Mechanism
from mbsd.base.errors import MechanismError
from mbsd.results.solution import Solution

TOLERANCE = 1e-9


@dataclass
class Subject:
    """One random mechanism."""

    m: Mechanism
    duration: float
    """s."""
    driven: bool = True
    """A sweep; else a simulation."""
    turn: float | None = None
    """Seconds of one turn or swing; None: the whole duration."""
    truth: Callable[[Solution], list[str]] | None = None
    """Function that lists the errors of a solution, judged without the solver."""
    possible: bool | None = None
    """True if the motion exists; None where that is not known, as within rounding of a change point."""
    distance: float = 1.0
    """Least distance from a change point or a toggle, in sizes, as far as known."""
    traits: frozenset[str] = field(default_factory=frozenset)
    """bifurcates: passes exact change points; contacts: events and unilateral contacts; stiff; sticks; jumps:
    accelerations jump on the way, so that steps of fixed length lose their order."""

    @property
    def turns(self) -> float:
        """How many."""
        return self.duration / (self.turn or self.duration)


Builder = Callable[[np.random.Generator], Subject]


@dataclass(frozen=True)
class Family:
    """Mechanisms of one kind."""

    name: str
    build: Builder
    weight: float = 1.0
    example: bool = False
    """True if it is one of the solver's registries; all of these together have a share of their own."""


FAMILIES: dict[str, Family] = {}


def family(name: str, weight: float = 1.0, example: bool = False) -> Callable[[Builder], Builder]:
    """Enter a builder. Raises ValueError if the name is taken."""

    def enter(build: Builder) -> Builder:
        if name in FAMILIES:
            raise ValueError(f"{name}: there are two")
        FAMILIES[name] = Family(name, build, weight, example)
        return build

    return enter


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
