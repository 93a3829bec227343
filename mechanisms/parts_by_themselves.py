"""The solids of a mechanism without a parts.py: planned from mechanism.py and its motion alone."""

from __future__ import annotations

from typing import TYPE_CHECKING

from mechanisms.bare_motion import bare_solution

if TYPE_CHECKING:
    from shared.shapes.solid import Solid


def solids_of(name: str) -> dict[str, list[Solid]]:
    """Every piece by body. Raises UserError where the model cannot move, or has no parts by itself."""
    from mechanisms.automatic.automatic import automatic

    solution = bare_solution(name)
    return automatic(solution.mechanism, solution=solution).solids()
