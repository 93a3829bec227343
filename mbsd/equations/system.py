"""Arrays of the kernels: System, the mechanism, and Workspace, scratch. arrays/packing.py builds them.

System is constant: its arrays cannot be written into. Closing the start makes another one, with its own ARM and ACTIVE
of ``special``, first four of each constraint's ``numbers`` (kinematics/pose/phases.py) and turns of ``angle_offset``
(close.py). What events change of a constraint of relative pose stands in the last columns of ``Workspace.relative``
(ZERO, LAST), where its equation finds it beside its pose; a run keeps it at events.

Bodies are numbered 0 .. nb-1; body 0 is ground. A row of the Jacobian touches two bodies, so six numbers hold it.
A constraint table has one row per constraint: marker i, marker j, first row in J, motion (0: none, constant 0).

Markers move with their bodies; one kernel places all of them.

    arm      s = R(theta) s_local
    position p = r + s
    axis     u = R(theta) u_local
    velocity p' = r' + omega s_perp,              s_perp = (-s_y, s_x) = ds/dtheta
    convective acceleration c = -omega^2 s        (p'' = r'' + alpha s_perp + c)

Source: Haug, Computer Aided Kinematics and Dynamics of Mechanical Systems, 1989, ch. 2.4 and 3.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np

from mbsd.compiling.jit import inlined

PLACE = 0x7FFF_FFFF
"""A place in an array, read from a table, & PLACE: then compiled indexing need not look for negative numbers."""
ZERO, LAST = 14, 15
"""Columns of ``Workspace.relative`` that no evaluation writes. ZERO: from where the sliding of a contact, or of a joint
that sticks, is counted (m, rad). LAST: parameter last accepted on a curve that crosses itself (m); NaN: none yet."""


class System(NamedTuple):
    """A mechanism as arrays (SI). nb bodies, nm markers."""

    mass: Any
    """(nb,) kg; ground 0."""
    inertia: Any
    """(nb,) kg m^2 about the centre of mass; ground 0."""
    gravity: Any
    """(2,) m/s^2."""
    marker_body: Any
    """(nm,) body of each marker."""
    marker_arm: Any
    """(nm, 2) from the centre of mass, body axes (m)."""
    marker_axis: Any
    """(nm, 2) unit x axis of the marker, body axes."""
    moving: Any
    """Markers on moving bodies."""
    directed: Any
    """Markers whose axis a constraint uses."""
    point: Any
    angle: Any
    slot: Any
    along: Any
    distance: Any
    """(k, 4) int constraint tables."""
    special: Any
    """(k, 7) int table of the constraints of relative pose; columns in mbsd/equations/relative/equation.py."""
    address: Any
    """(k,) of their equations."""
    numbers: Any
    """All numbers of all of them."""
    driven: Any
    """(drivers, 2) row and motion of each driven constraint."""
    row_body: Any
    """(m, 2) first and second body of each row."""
    angle_offset: Any
    """(k,) rad, for the rows of ``angle``."""
    distance_length: Any
    """(k,) m, for the rows of ``distance``."""

    def changed(self, **arrays: np.ndarray) -> System:
        """Return the mechanism with other arrays."""
        return self._replace(**{name: constant(array) for name, array in arrays.items()})

    def __reduce__(self) -> tuple[Any, ...]:
        """Return deep copies, and what is unpickled, are constant too: kernels are compiled for such arrays."""
        return constant_system, tuple(self)


class Workspace(NamedTuple):
    """Scratch of one evaluation; every kernel call overwrites it, but for what ``relative`` remembers."""

    cos_sin: Any
    """(nb, 2) of the body angles."""
    arm: Any
    """(nm, 2) from the centre of mass, world axes."""
    position: Any
    """(nm, 2) world."""
    axis: Any
    """(nm, 2) unit, world."""
    velocity: Any
    """(nm, 2) world."""
    convective: Any
    """(nm, 2) convective acceleration -omega^2 arm, world."""
    relative: Any
    """(k, 16) relative pose of each special constraint, scratch of its equation, then ZERO and LAST."""
    equation: Any
    """(k, 10) value, gradient and second derivatives of the special constraints."""
    phi: Any
    """(m,) residual."""
    jac: Any
    """(m, 6) dPhi/dq on the first body (x, y, theta), then on the second; what falls on ground is not used."""
    right: Any
    """(2, m) right-hand sides: -Phi and nu, then gamma."""
    pose: Any
    """(3 nb,) of the Newton iteration."""
    delta: Any
    """(2, 3 nb) its correction, and the velocities."""


def constant(array: np.ndarray) -> np.ndarray:
    """Return the array, which cannot be written into any more."""
    array.setflags(write=False)
    return array


def constant_system(*arrays: np.ndarray) -> System:
    """Return the System of these arrays, in the order of its fields."""
    return System(*map(constant, arrays))


def workspace(system: System, rows: int) -> Workspace:
    """Return scratch for ``rows`` constraint rows.

    Entries of ``jac`` that no constraint writes stay zero for ever.
    """
    bodies = len(system.mass)
    cos_sin = np.zeros((bodies, 2))
    cos_sin[:, 0] = 1.0
    on_ground = system.marker_body == 0
    at_rest = np.where(on_ground[:, None], system.marker_arm, 0.0)
    relative = np.zeros((len(system.special), LAST + 1))
    relative[:, LAST] = np.nan
    return Workspace(
        cos_sin=cos_sin,
        arm=at_rest.copy(),
        position=at_rest.copy(),
        axis=np.where(on_ground[:, None], system.marker_axis, 0.0),
        velocity=np.zeros_like(at_rest),
        convective=np.zeros_like(at_rest),
        relative=relative,
        equation=np.zeros((len(system.special), 10)),
        phi=np.zeros(rows),
        jac=np.zeros((rows, 6)),
        right=np.zeros((2, rows)),
        pose=np.zeros(3 * bodies),
        delta=np.zeros((2, 3 * bodies)),
    )


@inlined
def place(system, q, ws):
    """Fill arm, position and axis of the markers from q (3 nb,); those of ground never change."""
    for b in range(1, system.mass.shape[0]):
        theta = q[3 * b + 2]
        ws.cos_sin[b, 0] = math.cos(theta)
        ws.cos_sin[b, 1] = math.sin(theta)
    for coded in system.moving:
        k = coded & PLACE
        b = system.marker_body[k] & PLACE
        c = ws.cos_sin[b, 0]
        s = ws.cos_sin[b, 1]
        x = system.marker_arm[k, 0]
        y = system.marker_arm[k, 1]
        arm_x = c * x - s * y
        arm_y = s * x + c * y
        ws.arm[k, 0] = arm_x
        ws.arm[k, 1] = arm_y
        ws.position[k, 0] = q[3 * b] + arm_x
        ws.position[k, 1] = q[3 * b + 1] + arm_y
    for coded in system.directed:
        k = coded & PLACE
        b = system.marker_body[k] & PLACE
        c = ws.cos_sin[b, 0]
        s = ws.cos_sin[b, 1]
        x = system.marker_axis[k, 0]
        y = system.marker_axis[k, 1]
        ws.axis[k, 0] = c * x - s * y
        ws.axis[k, 1] = s * x + c * y


@inlined
def move(system, v, ws):
    """Fill velocity and convective acceleration of the markers from v (3 nb,), after place."""
    for coded in system.moving:
        k = coded & PLACE
        b = 3 * (system.marker_body[k] & PLACE)
        omega = v[b + 2]
        ws.velocity[k, 0] = v[b] - omega * ws.arm[k, 1]
        ws.velocity[k, 1] = v[b + 1] + omega * ws.arm[k, 0]
        ws.convective[k, 0] = -omega * omega * ws.arm[k, 0]
        ws.convective[k, 1] = -omega * omega * ws.arm[k, 1]
