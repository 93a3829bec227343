"""The solids that a motion or a model at a scale needs: those whose masses mechanism.py does not give.

A sweep moves as its drivers say; its forces follow from the masses. A simulation of bodies whose masses mechanism.py
does not give moves as the masses of their parts make it, so these parts are made first.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from mechanisms.stages.loading import loading
from mechanisms.stages.solve import solving
from mechanisms.stages.solve.masses import leaves_masses
from shared.stage.errors import UserError

if TYPE_CHECKING:
    from mbsd import Mechanism


def needs_masses(name: str) -> bool:
    """Return True if mechanism ``name`` leaves the mass of a body to its parts, or cannot be built to see that."""
    from mbsd import MechanismError

    try:
        return leaves_masses(_build(name)[0])
    except (UserError, MechanismError):
        return True


def needs_machine(name: str) -> bool:
    """Return True if the motion of mechanism ``name`` may depend on the masses of its parts.

    It may, too, where that is not known without solving it: mechanism.py has a ``motion()``, or cannot be built.
    """
    from mbsd import MechanismError

    try:
        m, module = _build(name)
        return leaves_masses(m) and (hasattr(module, "motion") or m.mobility().dof > len(m.drivers))
    except (UserError, MechanismError):
        return True


def _build(name: str) -> tuple[Mechanism, Any]:
    """Return the mechanism, whose bodies have the masses that mechanism.py gives, and its module."""
    module, p = loading.load(name, "mechanism"), loading.params(name)
    return solving.build(name, module, p), module
