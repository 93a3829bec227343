"""The motion of a mechanism from mechanism.py alone, before there are any parts."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

from mechanisms.stages.loading import loading
from mechanisms.stages.solve import solving
from mechanisms.stages.solve.masses import give_masses

if TYPE_CHECKING:
    from mbsd import Solution
    from shared.contract import Mass


def bare_solution(name: str, masses: Mapping[str, Mass] | None = None) -> Solution:
    """Solve a mechanism with the masses of mechanism.py; where it gives none, with ``masses`` or estimated ones.

    Poses of a mechanism whose drivers fix every freedom do not depend on masses; those of a simulation do, so parts
    made for it follow from a motion with their own masses (automatic_solids.py). Raises UserError.
    """
    module, p = loading.load(name, "mechanism"), loading.params(name)
    m = solving.build(name, module, p)
    sources, _ = give_masses(m, None)
    for body in (body for body, source in sources.items() if source == "estimate" and body in (masses or {})):
        mass = (masses or {})[body]
        m.set_mass(body, mass.mass, mass.com, mass.inertia)
    return solving.motion_of(name, module, m, p)


def depends_on_masses(name: str, solution: Solution) -> bool:
    """Return True if the motion is a simulation of bodies some of which have no mass in mechanism.py."""
    m = solving.build(name, loading.load(name, "mechanism"), loading.params(name))
    return solution.work is not None and "estimate" in give_masses(m, None)[0].values()
