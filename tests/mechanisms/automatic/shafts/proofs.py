"""Parts built, meshed and proven to stay apart."""

from __future__ import annotations

from functools import cache
from typing import TYPE_CHECKING

from mechanisms.stages.automatic.automatic import Automatic
from tools.hunt_parts import case
from tools.models import shaft_machines as models

if TYPE_CHECKING:
    from cadquery import BoundBox

    from mbsd import Mechanism
    from shared.shapes.bodies import Bodies
    from shared.shapes.solid import Solid


def model(of: str) -> Mechanism:
    """A model of tools/models/shaft_machines.py by its name there."""
    return models.legs() if of == "LEGS" else models.engine(getattr(models, of))


@cache
def proven(of: str) -> tuple[Automatic, Bodies]:
    """The plan and the solids of a model, once, after :func:`checked`."""
    return checked(model(of))


def checked(m: Mechanism) -> tuple[Automatic, Bodies]:
    """The plan and the solids. Raises UserError where a solid is unsound, or two come too near."""
    solution = m.sweep(steps=90)
    made = Automatic(m, solution)
    bodies = made.solids()
    pieces = case.meshed(bodies)
    assert not case.overlapping(pieces)
    case.proven(m, solution, bodies, pieces)
    return made, bodies


def box(solid: Solid) -> BoundBox:
    """Return the box of a solid's mesh: the box of its curved faces is wider."""
    shape = solid.shape.val()
    shape.mesh(0.05)
    return shape.BoundingBox()


def plan(of: str) -> Automatic:
    """The plan of a model, without solids."""
    m = model(of)
    return Automatic(m, m.sweep(steps=90))
