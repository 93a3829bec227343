"""Finding of a comparison: the same, different, made from other inputs, or missing."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

Verdict = Literal["same", "differs", "outdated", "missing"]


@dataclass(frozen=True)
class Finding:
    """One file, frame or film. ``outdated``: its inputs have changed since, so nothing follows."""

    what: str
    verdict: Verdict
    detail: str = ""

    def __str__(self) -> str:
        word = {"outdated": "made from other inputs", "missing": "not compared"}.get(self.verdict, self.verdict)
        return f"{self.what}: {word}{', ' * bool(self.detail)}{self.detail}"
