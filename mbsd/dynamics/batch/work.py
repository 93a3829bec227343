"""What is asked of many simulations, as all threads share it."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from mbsd.dynamics.batch.designs import Designs
from mbsd.dynamics.batch.early import Plan
from mbsd.dynamics.batch.patches import Patches
from mbsd.dynamics.batch.single_run import Asked
from mbsd.dynamics.measures.kinds import Measure
from mbsd.dynamics.measures.quantities import Quantity

Measures = Mapping[str, Measure] | Callable[[Any], Any]


@dataclass
class Work:
    """What all threads share."""

    designs: Designs
    asked: Asked
    measures: Measures
    quantities: Mapping[str, Quantity]
    why: str | None
    """Why none goes in the compiled loop, if so."""
    stop: np.ndarray
    """(1,) not zero where all is to stop."""
    plan: Plan
    """Which outputs are made; see early.py."""
    reactive: bool = False
    """Whether any measure reads reactions."""
    looked: bool = False
    """Whether it is known if rows must be prepared."""
    patches: Patches | None = None
    """Numbers of rows that need not be."""
    note: str | None = None
    """Why not, if so."""

    def unwanted(self) -> bool:
        """Whether all is to stop."""
        return bool(self.stop[0])
