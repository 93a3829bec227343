"""What an integrator is, and the registry that one test walks through."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass


@dataclass(frozen=True)
class Integrator:
    """A method by name.

    ``advance(dyn, scratch, state, out, settings, end, max_steps)`` goes on from a State to the time ``end`` (s),
    writes the outputs it passes and returns a status (see state.py).
    """

    name: str
    advance: Callable[..., int]
    stages: int
    """Rows of Scratch.stages it needs."""
    order: int
    """Of the global error for smooth problems; the registry test measures it."""
    fixed_step: bool
    """Steps are given by the user, not by an error estimate."""


INTEGRATORS: dict[str, Integrator] = {}


def register(integrator: Integrator) -> Integrator:
    """Enter an integrator; raises ValueError if its name is taken."""
    if integrator.name in INTEGRATORS:
        raise ValueError(f"{integrator.name}: registered twice")
    INTEGRATORS[integrator.name] = integrator
    return integrator
