"""What every motion law is: f, f', f'' as functions of time."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from mbsd.errors import ModelError

Times = np.ndarray


def refuse_non_finite(law: str, **numbers: float) -> None:
    """Raise ModelError naming the first number that is NaN or infinite."""
    for name, value in numbers.items():
        if not math.isfinite(value):
            raise ModelError(f"{law}: {name} is {value}; it must be a finite number")


@dataclass(frozen=True)
class Motion:
    """Base of the laws. ``period`` (s) is the time after which the motion repeats, or None."""

    @property
    def period(self) -> float | None:
        """Time (s) of one turn or one swing; None if the law does not repeat."""
        return None

    def over(self, first: float, last: float) -> Motion:
        """The law made ready for times ``first`` .. ``last`` (s)."""
        return self

    def __call__(self, times: Times) -> np.ndarray:
        """(T,) times to (T, 3): f, f', f''."""
        raise NotImplementedError
