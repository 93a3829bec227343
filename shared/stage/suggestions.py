"""Suggestions for an unknown name: the known name that was probably meant."""

from __future__ import annotations

from collections.abc import Iterable
from difflib import get_close_matches

ALIKE = 0.6
"""Least similarity (0..1, difflib) of a name that is suggested."""


def did_you_mean(name: str, known: Iterable[str]) -> str:
    """Return ``; did you mean 'crank'?`` for the end of an error; empty if no known name is alike.

    Case is ignored.
    """
    by_lower = {other.lower(): other for other in known}
    matches = get_close_matches(name.lower(), by_lower, n=1, cutoff=ALIKE)
    return f"; did you mean '{by_lower[matches[0]]}'?" if matches else ""
