"""Numbers as XML files of other programs have them."""

from __future__ import annotations

DIGITS = 15
ROUNDING = 1e-15
"""Less is written as zero."""


def number(value: float) -> str:
    """One number with all the digits that matter."""
    return f"{value:.{DIGITS}g}"


def numbers(*values: float) -> str:
    """Several, with spaces between."""
    return " ".join(number(0.0 if abs(value) < ROUNDING else value) for value in values)
