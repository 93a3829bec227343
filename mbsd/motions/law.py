"""What every motion law is: f, f', f'' as functions of time."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from mbsd.arguments import finite_number

if TYPE_CHECKING:
    from mbsd.laws import Compiled

Times = np.ndarray
COMPILED_PIECES = (256, 1024, 4096, 16384, 65536)
"""Tried in turn for a law that has no compiled form of its own."""
COMPILED_TOLERANCE = np.array([1e-12, 1e-10, 1e-8])
"""Of f, f' and f'' halfway between the samples, relative to their largest values."""


def refuse_non_finite(law: str, **numbers: float) -> None:
    """Raise ModelError naming the first that is no finite number."""
    for name, value in numbers.items():
        finite_number(f"{law}: {name}", value)


@dataclass(frozen=True)
class Motion:
    """Base of the laws. ``period`` (s) is the time after which the motion repeats, or None."""

    @property
    def period(self) -> float | None:
        """Time (s) of one turn or one swing; None if the law does not repeat."""
        return None

    def knots(self, first: float, last: float) -> np.ndarray:
        """Rising times (s) in ``first`` .. ``last`` so close that the law does not turn back between two.

        A sweep looks at them where several lie between two of its outputs. A law of which nothing is known is looked at
        513 times.
        """
        return np.linspace(first, last, 513)

    def over(self, first: float, last: float) -> Motion:
        """The law made ready for times ``first`` .. ``last`` (s)."""
        return self

    def compiled(self, first: float, last: float) -> Compiled:
        """The law as kernels evaluate it over ``first`` .. ``last`` (s): quintic pieces unless the law knows better."""
        from mbsd.laws import hermite_pieces, pack_laws, tabulate_law

        last = last if last > first else first + 1.0
        for count in COMPILED_PIECES:
            times = np.linspace(first, last, 2 * count + 1)
            samples = self(times)
            law = hermite_pieces(times[::2], samples[::2])
            check = np.zeros_like(samples)
            tabulate_law(pack_laws([law]), 1, times, check)
            if (np.abs(check - samples) <= COMPILED_TOLERANCE * (np.abs(samples).max(axis=0) + 1e-300)).all():
                break
        return law

    def __call__(self, times: Times) -> np.ndarray:
        """(T,) times to (T, 3): f, f', f''."""
        raise NotImplementedError
