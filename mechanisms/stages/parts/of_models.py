"""What the parts of a model at a scale need of the machine itself: the masses of its parts, if these decide the motion.

A sweep moves as its drivers say. A simulation of bodies whose masses mechanism.py does not give moves as the masses of
their parts make it, so these parts are made first.
"""

from __future__ import annotations

from mechanisms.stages.loading import loading
from mechanisms.stages.solve import solving
from mechanisms.stages.solve.masses import give_masses
from shared.stage.errors import UserError


def needs_machine(name: str) -> bool:
    """Whether the motion of mechanism ``name`` may depend on the masses of its parts.

    It may, too, where that is not known without solving it: mechanism.py has a ``motion()``, or is refused.
    """
    from mbsd import MechanismError

    try:
        module, p = loading.load(name, "mechanism"), loading.params(name)
        m = solving.build(name, module, p)
        if "estimate" not in give_masses(m, None)[0].values():
            return False
        return hasattr(module, "motion") or m.mobility().dof > len(m.drivers)
    except (UserError, MechanismError):
        return True
