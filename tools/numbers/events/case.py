"""A run by name: its model, how it is simulated, and what is known of it."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from typing import Any

from mbsd import Mechanism, Solution

TOLERANCE = 1e-10
"""So small that errors of a method stay below the bounds of most runs."""


@dataclass(frozen=True)
class Case:
    """A run that is recorded."""

    name: str
    build: Callable[[], Mechanism]
    duration: float
    """s, such that no output falls on an event."""
    options: Mapping[str, Any] = field(default_factory=dict)
    """Arguments of ``simulate`` beside the duration."""
    steps: int = 10
    kink: str = ""
    """Why this run moves by more than rounding, if it does."""
    even: bool = False
    """True where symmetry makes things happen at one instant: then all masses are moved by one factor."""
    refused: tuple[str, ...] = ()
    """Words that the text of the error must have; empty where the run is not refused."""
    quick: bool = False
    """True if it is checked by the quick tests."""

    def simulate(self, m: Mechanism | None = None, **options: Any) -> Solution:
        """Return the simulation of a model, this one's if none is given; warnings are not shown."""
        with warnings.catch_warnings(action="ignore"):
            given = {"tolerance": TOLERANCE, "steps": self.steps, **self.options, **options}
            return (m or self.build()).simulate(self.duration, **given)

    def by(self, suffix: str, **options: Any) -> Case:
        """Return the same run under another name and with other options."""
        return replace(self, name=f"{self.name}, {suffix}", options={**self.options, **options}, quick=False)
