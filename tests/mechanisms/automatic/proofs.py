"""Proofs of automatic parts: rules of the layout checked anew, solids built, meshed and kept apart."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from mechanisms.stages.automatic.automatic import Automatic
from mechanisms.stages.automatic.layout.items import span, spans_meet
from mechanisms.stages.automatic.layout.planar import core_gaps, placed
from tools.hunt_parts import case
from tools.models import shaft_machines as models


def meets(made: Automatic) -> list[str]:
    """Pairs of items at one height that come nearer than none: seen anew at some poses, without circles or coarse
    looks.
    """
    layout, meetings = made.layout, []
    at = np.linspace(0, len(layout.times) - 1, 60).astype(int)
    spans = [span(item.reach, made.decided) for item in layout.items]
    seen = [placed(item.shape.core_at(at), layout.poses[item.body][at]) for item in layout.items]
    for j, second in enumerate(layout.items):
        for i, first in enumerate(layout.items[:j]):
            by_design = first.body == second.body
            by_design = by_design or (first.spared and first.body in second.spares)
            by_design = by_design or (second.spared and second.body in first.spares)
            by_design = by_design or first.what in second.meshes or second.what in first.meshes
            if by_design or first.only or second.only or not spans_meet(spans[i], spans[j]):
                continue
            if (core_gaps(seen[i], seen[j]) < first.shape.radius + second.shape.radius).any():
                meetings.append(f"{first.what} meets {second.what}")
    return meetings


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
