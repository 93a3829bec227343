"""The mechanism without rows that events switch, for steps in which none of them holds."""

from __future__ import annotations

from mbsd.compiling.jit import inlined, internal
from mbsd.dynamics.many.contacts.arrays import CLOSED
from mbsd.dynamics.reference.arrays import Dynamics
from mbsd.equations.system import System


@inlined
def without_contacts(dyn, contacts):
    """The mechanism without its contacts: a fifth less to do in steps in which all are open."""
    system = dyn.system
    bare = System(
        system.mass,
        system.inertia,
        system.gravity,
        system.marker_body,
        system.marker_arm,
        system.marker_axis,
        system.moving,
        system.directed,
        system.point,
        system.angle,
        system.slot,
        system.along,
        system.distance,
        contacts.special,
        system.address,
        system.numbers,
        system.driven,
        system.row_body,
        system.angle_offset,
        system.distance_length,
    )
    return Dynamics(
        bare,
        dyn.laws,
        dyn.loads,
        contacts.schur,
        contacts.friction.none,
        dyn.inertia,
        dyn.inverse,
        dyn.metric,
        dyn.weight,
        dyn.passes,
        dyn.baumgarte,
        dyn.per_size,
    )


@internal
def any_held(contacts):
    """Whether a contact is closed, or a joint sticks."""
    held = False
    for k in range(contacts.place.shape[0]):
        held = held or contacts.number[k, CLOSED] > 0.0
    return held
