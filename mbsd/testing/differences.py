"""Two arrays that should be equal, compared with words for the place where they differ most."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np


def compare(
    what: str,
    given: np.ndarray,
    expected: np.ndarray,
    tolerance: float | np.ndarray,
    place: Callable[..., str] = lambda *index: f"at {index}",
) -> None:
    """Raise AssertionError if ``given`` is too far from ``expected``, or is no number.

    ``place`` puts the index of the worst element into words.
    """
    given, expected = np.broadcast_arrays(given, expected)
    distance = np.abs(given - expected)
    excess = np.where(np.isfinite(distance), distance - tolerance, np.inf)
    if not excess.size or excess.max() <= 0.0:
        return
    worst = tuple(int(k) for k in np.unravel_index(int(excess.argmax()), excess.shape))
    raise AssertionError(
        f"{what}, {place(*worst)}: {given[worst]:.9g} instead of {expected[worst]:.9g} "
        f"({np.count_nonzero(excess > 0.0)} of {excess.size} numbers differ)"
    )


def coordinate(bodies: list[str], column: int) -> str:
    """The name of a coordinate by its number, ground's three included."""
    return f"{('x', 'y', 'theta')[column % 3]} of '{bodies[column // 3]}'"
