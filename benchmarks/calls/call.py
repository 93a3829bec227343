"""A call of one code on one problem."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any


@dataclass(frozen=True)
class Call:
    """``call`` is timed; ``error`` of what it returned is not."""

    problem: str
    settings: str
    call: Callable[[], Any]
    error: Callable[[Any], float]
