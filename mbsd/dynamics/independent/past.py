"""What a block knows of the last accepted pose and of the one evaluated last."""

from __future__ import annotations

from typing import Any, NamedTuple


class Past(NamedTuple):
    """What is kept for one block with n unknowns and C columns of B."""

    q: Any
    """(3 nb,) the last accepted pose."""
    here: Any
    """(n, C + 2) unknowns, convective accelerations and columns: of the evaluation before, then of the present one."""
    kept: Any
    """The same at the last accepted pose."""
    seen: Any
    """(C + 1,) coordinates and time at which ``here`` was evaluated."""
    determinant: Any
    """The determinant of G at the last accepted pose; 0 at the first."""
