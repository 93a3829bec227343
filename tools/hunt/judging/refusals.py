"""Which refusals are expected of a variation, by what the program promises."""

from __future__ import annotations

from mbsd import Mechanism
from mbsd.base.errors import MechanismError
from mbsd.model.force import FORCE_KINDS
from mbsd.model.joint import KINDS
from mbsd.model.laws.function import Function
from tools.hunt.words.raised import Raised

PROMISED = (
    "is not possible here",
    "does not know",
    "does not take",
    "need scikit-sundae",
    "in reference coordinates",
    "do not end there",
    "is lost in rounding",
    "may be on the other branch",
)
"""Words of refusals that say what a method or formulation is not made for.

How far masses are apart, and so what is lost in rounding, depends on the frames of bodies by a factor of two.
"""


def expected_refusal(error: MechanismError) -> bool:
    """Whether the program says beforehand that it will not."""
    return any(words in str(error) for words in PROMISED)


def cannot_be_saved(m: Mechanism) -> bool:
    """Whether the model holds a Python function, or events."""
    laws = [driver.motion for driver in m.drivers.values()]
    laws += [law for force in m.forces.values() for law in force.laws.values()]
    kinds = [KINDS[joint.kind.name].saved for joint in m.joints.values()]
    kinds += [FORCE_KINDS[force.kind.name].saved for force in m.forces.values()]
    return bool(m.events) or not all(kinds) or any(isinstance(law, Function | Raised) for law in laws)
