"""What is hunted: a mechanism, how long it moves, and what is known about it without the solver."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np

from mbsd import Mechanism
from mbsd.results.solution import Solution


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
    """What a solution gets wrong, judged without the solver."""
    possible: bool | None = None
    """Whether the motion exists; None where that is not known, as within rounding of a change point."""
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
    """Whether it is one of the solver's registries; all of these together have a share of their own."""


FAMILIES: dict[str, Family] = {}


def family(name: str, weight: float = 1.0, example: bool = False) -> Callable[[Builder], Builder]:
    """Enter a builder. Raises ValueError if the name is taken."""

    def enter(build: Builder) -> Builder:
        if name in FAMILIES:
            raise ValueError(f"{name}: there are two")
        FAMILIES[name] = Family(name, build, weight, example)
        return build

    return enter
