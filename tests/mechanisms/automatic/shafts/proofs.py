"""Parts built, meshed and proven to stay apart."""

from __future__ import annotations

from typing import TYPE_CHECKING

from mechanisms.stages.automatic.automatic import Automatic
from tools.hunt_parts import case
from tools.models import shaft_machines as models

if TYPE_CHECKING:
    from mbsd import Mechanism
    from shared.shapes.bodies import Bodies


def checked(m: Mechanism) -> tuple[Automatic, Bodies]:
    """The plan and the solids. Raises UserError where a solid is unsound, or two come too near."""
    solution = m.sweep(steps=90)
    made = Automatic(m, solution)
    bodies = made.solids()
    pieces = case.meshed(bodies)
    assert not case.overlapping(pieces)
    case.proven(m, solution, bodies, pieces)
    return made, bodies


def plan(of: str) -> Automatic:
    """Return the plan of an engine of tools/models/shaft_machines.py by its name there, without solids."""
    m = models.engine(getattr(models, of))
    return Automatic(m, m.sweep(steps=90))
