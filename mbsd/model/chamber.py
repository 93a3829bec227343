"""A chamber behind a piston as its results are asked for: pressure, volume, and what a cycle gives."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import numpy as np


@dataclass(frozen=True)
class Chamber:
    """Volume is area (x + shift), pressure effort / area + outside; x: what the force measures."""

    area: float
    """m^2"""
    shift: float
    """m"""
    outside: float
    """Pa"""
    cycle: CrankCycle | None = None


@dataclass(frozen=True)
class CrankCycle:
    """How the pressure repeats with a crank."""

    crank: str
    """Name of the body."""
    fires_at: float
    """Its angle against the cylinder's body (rad)."""
    sense: float
    """-1: it turns clockwise."""
    period: float
    """rad"""
    displaced: float
    """m^3"""
    changes: tuple[float, ...]
    """Angles after the firing at which one phase follows another (rad)."""
    height: Callable[[np.ndarray], np.ndarray] | None
    """Height of the gas (m) at angles after the firing, by crank and rod; None where the pressure needs none."""
    burns: bool
    """Whether heat is released at these heights."""
