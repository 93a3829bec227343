"""The motion of a mechanism from mechanism.py alone, before there are any parts."""

from __future__ import annotations

from typing import TYPE_CHECKING

from mechanisms import loading, solving
from mechanisms.masses import give_masses

if TYPE_CHECKING:
    from mbsd import Solution


def bare_solution(name: str) -> Solution:
    """Solve a mechanism with the masses of mechanism.py, and estimated ones where it gives none.

    Poses of a mechanism whose drivers fix every freedom do not depend on masses; those of a simulation do, so parts
    made for it are checked along the motion that is solved with their own masses. Raises UserError.
    """
    module, p = loading.load(name, "mechanism"), loading.params(name)
    m = solving.build(name, module, p)
    give_masses(m, None)
    return solving.motion_of(name, module, m, p)
