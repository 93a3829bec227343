"""Finding of a check of a model: one suspicious thing."""

from __future__ import annotations

from dataclasses import dataclass

from mbsd.base.names import Suggesting


@dataclass(frozen=True)
class Finding(Suggesting):
    """One suspicious number: whose it is, what is odd, what to do."""

    name: str
    problem: str
    remedy: str
    is_note: bool = False
    """True if it is something to know of a model that may well be meant so."""

    def __str__(self) -> str:
        return f"{self.name}: {self.problem}. {self.remedy}"
