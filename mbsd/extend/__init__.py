"""Names for joints, drivers, forces and contacts of your own; docs/extending.md shows some.

Rooms below may move; these names stay. What integrators need is in :mod:`mbsd.extend.integrators`, and derivatives in
coordinates of your own in :mod:`mbsd.extend.derivatives`, because these load the compiler; :mod:`mbsd.testing` checks a
kind.
"""

from mbsd.base.codes import (
    AXIS,
    CONSTANT,
    DAMPING,
    DRY,
    LAW_RATE,
    LAW_TIME,
    LAW_VALUE,
    LINE,
    LINEAR,
    POWER,
    PUSH,
    TURN,
)
from mbsd.model.body import Body, Marker
from mbsd.model.entries import (
    Amount,
    Law,
    Limits,
    add_contact,
    add_force,
    amount_given,
    amounts_given,
    frictions_given,
    join,
    limits_given,
    phase_given,
    radii_given,
    stop_given,
)
from mbsd.model.force import Element, Force, ForceKind, Interaction, States, Term, register_force
from mbsd.model.joint import ContactKind, Joint, JointKind, register_contact, register_joint
from mbsd.model.mechanism import Model, length_given, number_given

__all__ = [
    "AXIS",
    "CONSTANT",
    "DAMPING",
    "DRY",
    "LAW_RATE",
    "LAW_TIME",
    "LAW_VALUE",
    "LINE",
    "LINEAR",
    "POWER",
    "PUSH",
    "TURN",
    "Amount",
    "Body",
    "ContactKind",
    "Element",
    "Force",
    "ForceKind",
    "Interaction",
    "Joint",
    "JointKind",
    "Law",
    "Limits",
    "Marker",
    "Model",
    "States",
    "Term",
    "add_contact",
    "add_force",
    "amount_given",
    "amounts_given",
    "frictions_given",
    "join",
    "length_given",
    "limits_given",
    "number_given",
    "phase_given",
    "radii_given",
    "register_contact",
    "register_force",
    "register_joint",
    "stop_given",
]
