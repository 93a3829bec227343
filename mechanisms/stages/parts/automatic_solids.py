"""The solids of a mechanism without a parts.py: planned from mechanism.py and its motion alone.

A simulated motion follows from the masses of the parts, and these follow from the motion: so it is solved again with
the masses of the parts, and parts are made for that motion, until they stay as they are.
Parts of a model at a scale move as the machine does: with its masses.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from mechanisms.stages.loading.wished_scale import wished_scale
from mechanisms.stages.solve.bare_motion import bare_solution, depends_on_masses
from shared.stage.paths import Out

if TYPE_CHECKING:
    from shared.contract import Mass
    from shared.shapes.solid import Solid

ROUNDS = 3
"""Rounds of parts made for a motion with the masses of those before."""
ALIKE = 1e-9
"""Masses that differ by less, relatively, are those of the same parts."""


def solids_of(name: str) -> dict[str, list[Solid]]:
    """Every piece by body. Raises UserError where the model cannot move, or has no automatic parts."""
    from mechanisms.stages.automatic.automatic import automatic

    if wished_scale() is not None:
        solution = bare_solution(name, masses_of_machine(name))
        return automatic(solution.mechanism, solution=solution).solids()
    solution = bare_solution(name)
    solids = automatic(solution.mechanism, solution=solution).solids()
    if not depends_on_masses(name, solution):
        return solids
    masses = _masses(solids)
    for _ in range(ROUNDS):
        solution = bare_solution(name, masses)
        solids = automatic(solution.mechanism, solution=solution).solids()
        before, masses = masses, _masses(solids)
        if all(abs(masses[body].mass - before[body].mass) <= ALIKE * before[body].mass for body in before):
            break
    return solids


def masses_of_machine(name: str) -> dict[str, Mass]:
    """By body, those of the parts of the machine itself; none where there are none. The solids need not be there."""
    from shared.contract import Parts
    from shared.stage import jsonfile

    out = Out(name)
    if not out.parts.is_file():
        return {}
    bodies = jsonfile.read(out.parts, Parts).bodies
    return {body: described.mass for body, described in bodies.items() if body != "ground"}


def _masses(solids: dict[str, list[Solid]]) -> dict[str, Mass]:
    """Masses of all pieces of each moving body together."""
    from mechanisms.stages.parts.mass_properties import combined, mass_of
    from shared.contract.materials import MATERIALS

    return {
        body: combined(mass_of(piece.shape.solids().vals()[0], MATERIALS[piece.material].density) for piece in pieces)
        for body, pieces in solids.items()
        if body != "ground"
    }
