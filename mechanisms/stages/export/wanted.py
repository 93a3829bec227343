"""What is to be exported: a solved mechanism, the time of a pose, and its parts where there are some."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from shared.contract import Parts
from shared.stage.paths import Out


@dataclass(frozen=True)
class Wanted:
    """One export."""

    solution: Any
    time: float
    """Time of a pose (s)."""
    out: Out
    parts: Parts | None

    @property
    def row(self) -> int:
        """Number of the output nearest to the time."""
        return int(np.abs(self.solution.t - self.time).argmin())
