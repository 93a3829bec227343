"""Scale of a printed model: 1:20, 2:1."""

from __future__ import annotations

import re
from dataclasses import dataclass
from fractions import Fraction

from shared.stage.errors import UserError
from shared.stage.face import said

SMALLEST, LARGEST = Fraction(1, 10_000), Fraction(100)
_NUMBER = r"[0-9]+(?:\.[0-9]+)?"
_FORM = re.compile(rf"\s*({_NUMBER})\s*(?:[:/]\s*({_NUMBER}))?\s*")


@dataclass(frozen=True)
class Scale:
    """Length of the model to the same length of the machine, in lowest terms."""

    model: int
    machine: int

    @property
    def ratio(self) -> float:
        """Ratio as a number: 0.05 for 1:20."""
        return self.model / self.machine

    @property
    def slug(self) -> str:
        """Name for files and folders: ``scale_1_20``."""
        return f"scale_{self.model}_{self.machine}"

    def __str__(self) -> str:
        return f"{self.model}:{self.machine}"


def scale_of(text: str) -> Scale | None:
    """Return a scale from words like 1:20, 1/20, 0.05 or 2:1; None from none.

    Raises UserError for other words.
    """
    if not text.strip():
        return None
    match = _FORM.fullmatch(text)
    below = Fraction(match[2] or 1) if match else 0
    ratio = Fraction(match[1]) / below if match and below else Fraction(0)
    if not SMALLEST <= ratio <= LARGEST:
        raise UserError(
            f"{said(scale=text)} is not a scale between 1:{1 / SMALLEST} and {LARGEST}:1; write the ratio of model "
            f"to machine, such as {said(scale='1:20')}, 1/20 or 0.05"
        )
    if match and match[2] is None and ratio > 1:
        raise UserError(
            f"{said(scale=text)} is ambiguous; write {said(scale=f'1:{text}')} for a small model, {text}:1 for "
            "a large one"
        )
    return Scale(ratio.numerator, ratio.denominator)
