"""Joints that take freedoms from two bodies: pin, slider, weld, slot, rod, angle lock.

Revolute joint (pin): markers i and j share one point and turn freely.

    Phi = p_j - p_i        constraint `point`, 2 rows

The reaction is the pin force on body j.

Prismatic joint (slider): marker j slides along the x axis of marker i and does not turn against it.

    Phi_1 = n_i . (p_j - p_i)                   constraint `slot`, 1 row
    Phi_2 = (theta_j + a_j) - (theta_i + a_i)   constraint `angle`, 1 row (a: angle of the marker in its body)

The reaction on body j is a force across the slide and a torque.

Weld: marker j is fixed to marker i in place and direction.

    Phi_12 = p_j - p_i                          constraint `point`, 2 rows
    Phi_3  = (theta_j + a_j) - (theta_i + a_i)  constraint `angle`, 1 row

The reaction on body j is a force and a torque, what a section through the body would carry.

Pin in slot (point on line): marker j moves along the x axis of marker i and turns freely.

    Phi = n_i . (p_j - p_i)        constraint `slot`, 1 row

The reaction on body j is a force across the slot.

Distance joint (massless rod): markers i and j stay a fixed distance apart.

    Phi = |p_j - p_i| - length        constraint `distance`, 1 row

The reaction on body j is the rod's push along it.

Angle lock (parallel joint): marker j keeps the direction of marker i and is free to move.

    Phi = (theta_j + a_j) - (theta_i + a_i)        constraint `angle`, 1 row (a: angle of the marker in its body)

The reaction on body j is a torque.
"""

from __future__ import annotations

from mbsd.base.errors import ModelError
from mbsd.model.body import Marker
from mbsd.model.entries import Limits, join, limits_given
from mbsd.model.joint import Joint, JointKind, register_joint
from mbsd.model.mechanism import SHORTEST, Model

REVOLUTE = register_joint(JointKind("revolute", ("point",), example=lambda m, i, j: m.revolute("example", i, j)))


@REVOLUTE.adds
def revolute(m: Model, name: str, i: Marker, j: Marker, limits: Limits = None) -> Joint:
    """A pin: markers i and j share one point. ``limits``: of the angle of j against i (rad), None: free."""
    return join(m, REVOLUTE, name, i, j, None, **limits_given(m, name, limits))


PRISMATIC = register_joint(
    JointKind("prismatic", ("slot", "angle"), example=lambda m, i, j: m.prismatic("example", i, j))
)


@PRISMATIC.adds
def prismatic(m: Model, name: str, i: Marker, j: Marker, limits: Limits = None) -> Joint:
    """A slider: marker j moves along the x axis of marker i and does not turn against it.

    ``limits``: lower and upper place of j along that axis (m), None on a free side.
    """
    return join(m, PRISMATIC, name, i, j, None, **limits_given(m, name, limits))


WELD = register_joint(JointKind("weld", ("point", "angle"), example=lambda m, i, j: m.weld("example", i, j)))


@WELD.adds
def weld(m: Model, name: str, i: Marker, j: Marker) -> Joint:
    """Marker j is fixed to marker i in place and direction."""
    return join(m, WELD, name, i, j)


PIN_IN_SLOT = register_joint(
    JointKind("pin_in_slot", ("slot",), look="captive", example=lambda m, i, j: m.pin_in_slot("example", i, j))
)


@PIN_IN_SLOT.adds
def pin_in_slot(m: Model, name: str, slot: Marker, pin: Marker, limits: Limits = None) -> Joint:
    """The point of marker ``pin`` moves along the x axis of marker ``slot``, within ``limits`` (m)."""
    return join(m, PIN_IN_SLOT, name, slot, pin, None, **limits_given(m, name, limits))


DISTANCE = register_joint(
    JointKind("distance", ("distance",), example=lambda m, i, j: m.distance("example", i, j, length=0.7))
)


@DISTANCE.adds
def distance(m: Model, name: str, i: Marker, j: Marker, length: float) -> Joint:
    """A massless rod of the given length (m) between the points of markers i and j."""
    if length < SHORTEST:
        raise ModelError(
            f"{m.name}: distance joint '{name}' has length {length:g} m; it must be positive, {SHORTEST:g} m or "
            "more (use a revolute joint for two points that coincide)"
        )
    return join(m, DISTANCE, name, i, j, length=length)


ANGLE_LOCK = register_joint(JointKind("angle_lock", ("angle",), example=lambda m, i, j: m.angle_lock("example", i, j)))


@ANGLE_LOCK.adds
def angle_lock(m: Model, name: str, i: Marker, j: Marker) -> Joint:
    """Marker j keeps the direction of marker i and is free to move."""
    return join(m, ANGLE_LOCK, name, i, j)
