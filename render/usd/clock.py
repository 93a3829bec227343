"""Time codes of a motion: real time, counted from its first moment."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

RATE = 24.0
"""Time codes a second, at least: what programs take that do not ask."""
FEWEST = 48
"""Time codes over a motion, at least, so that a short one plays in as many pictures."""


class Clock:
    """Counts the times of data.json in codes."""

    def __init__(self, time: NDArray[np.float64]) -> None:
        """``time`` (T,) in s."""
        length = float(time[-1] - time[0])
        self.rate = max(RATE, float(math.ceil(FEWEST / length)))
        self.codes: list[float] = ((time - time[0]) * self.rate).tolist()
        """(T,): the code of each time."""
        self.last = self.codes[-1]
