"""Integrator: a method by name, and the registry of all of them."""

from __future__ import annotations

import importlib
import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from mbsd.base.errors import ModelError
from mbsd.base.names import no_such, shown

if TYPE_CHECKING:
    from mbsd.dynamics.reference.arrays import Dynamics

ARGUMENTS = ("duration", "steps", "times", "method", "tolerance", "step", "progress", "event_rows", "formulation")
"""Arguments of simulate that are no options of a method; a message suggests them for a misspelt one."""


@dataclass(frozen=True)
class Option:
    """A number that a method takes beside step and tolerance."""

    default: float
    low: float
    high: float
    """Both are allowed."""


@dataclass(frozen=True)
class Integrator:
    """A method by name.

    ``advance(dyn, scratch, state, out, settings, end, max_steps)`` goes on from a State to the time ``end`` (s),
    writes the outputs it passes and returns a status (see state.py). It is a kernel, or a Python function.
    """

    name: str
    advance: Callable[..., int]
    stages: int
    """Rows of Scratch.stages it needs."""
    order: int
    """Order of the global error for smooth problems, which the registry test measures; 0: the method varies it."""
    fixed_step: bool
    """Steps are given by the user, not by an error estimate."""
    options: Mapping[str, Option] = field(default_factory=dict)
    """Numbers that ``simulate`` takes by name for this method; in this order they stand in Settings.options."""
    matrices: tuple[int, int] = (0, 0)
    """Full matrices it needs, and their rows for each coordinate (see mbsd/dynamics/integrators/full_matrix.py)."""
    independent: bool = False
    """True if ``advance`` integrates independent coordinates as well: ``dyn`` is then an Embedding."""
    general: bool = False
    """True if ``advance`` steps q' = N(q) v of any formulation; other methods step q' = v."""
    refusal: Callable[[Dynamics], str | None] = lambda dynamics: None
    """Why this method cannot simulate a mechanism, or None."""
    meets_switches: bool = False
    """True if its steps end where contacts by penalty begin, so that it knows how fast they approach then."""
    package: str = ""
    """Another library's, by the name it is imported by; needed for this method alone."""

    @property
    def installed(self) -> bool:
        """Return True if this method can run here."""
        if not self.package:
            return True
        try:
            importlib.import_module(self.package)
        except ImportError:
            return False
        return True

    def why_refused(self, dynamics: Dynamics) -> str | None:
        """Return why this method cannot simulate a mechanism here, or None."""
        if not self.installed:
            return (
                f"method '{self.name}' needs the package '{self.package}', which is not installed; take another method"
            )
        return self.refusal(dynamics)

    def numbers(self, model: str, given: Mapping[str, float]) -> np.ndarray:
        """Return (options,) as given, else the defaults. Raises ModelError for unknown names and impossible values."""
        for name, value in given.items():
            if name not in self.options:
                known = no_such("option", name, [*self.options, *ARGUMENTS])
                raise ModelError(f"{model}: method '{self.name}': {known}")
            option = self.options[name]
            if isinstance(value, bool) or not isinstance(value, int | float | np.number) or not math.isfinite(value):
                raise ModelError(
                    f"{model}: option '{name}' of '{self.name}' is {shown(value)}; it must be a finite number"
                )
            if not option.low <= value <= option.high:
                raise ModelError(
                    f"{model}: option '{name}' of '{self.name}' is {value:g}; "
                    f"it must be within {option.low:g} .. {option.high:g}"
                )
        return np.array([float(given.get(name, option.default)) for name, option in self.options.items()])


def without_sliding(dynamics: Dynamics) -> str | None:
    """Return why a method that does not step along the derivative cannot simulate friction, or None."""
    if len(dynamics.loads.friction):
        return "this method does not know the friction of joints; take 'dop853', or joints without friction"
    if len(dynamics.sliding.rows):
        return "this method does not know the friction of rigid contacts; take 'dop853', or contacts without friction"
    return None


INTEGRATORS: dict[str, Integrator] = {}


def register(integrator: Integrator) -> Integrator:
    """Enter an integrator; raises ValueError if its name is taken."""
    if integrator.name in INTEGRATORS:
        raise ValueError(f"{integrator.name}: registered twice")
    INTEGRATORS[integrator.name] = integrator
    return integrator
