"""Arrays of a mechanism in space: a constant System, and a Workspace for each evaluation.

Coordinates q (3 + 7 n,) of n moving bodies: three idle entries, as ground has in the plane, then of each body the place
r of its centre of mass and its Euler parameters e (w, x, y, z), from principal axes to world. Velocities (3 + 6 n,):
three idle ones, then of each body r' and the angular velocity w, both in the world. Body b has its coordinates from
7 b - 4 on and its velocities from 6 b - 3 on.

The compact J (m, 6 k) has for each row the force and the torque about the centre of mass, in the world, that a unit
multiplier takes from each of the row's k bodies. Rows of two bodies leave the rest zero.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np


class System(NamedTuple):
    """A mechanism as kernels read it; body 0 is ground."""

    mass: Any
    """(nb,) kg"""
    inertia: Any
    """(nb, 3) principal moments (kg m^2)."""
    gravity: Any
    """(3,) m/s^2"""
    arm_body: Any
    """(p,) body of each place on a body."""
    arm: Any
    """(p, 3) from the centre of mass, in principal axes (m)."""
    axis_body: Any
    """(x,) body of each direction fixed to a body."""
    axis: Any
    """(x, 3) unit vectors in principal axes."""
    point: Any
    """(., 5) first row, place i, place j, column of i and of j in the compact J."""
    dot: Any
    """(., 5) row, axis i, axis j, columns."""
    along: Any
    """(., 6) row, axis i, place i, place j, columns."""
    distance: Any
    """(., 5) row, place i, place j, columns."""
    turn: Any
    """(., 6) row, x and y axis of i, x axis of j, columns."""
    roll: Any
    """(., 11) row, axes x, y, z of i and of j, place i, place j, columns."""
    roll_number: Any
    """(., 2) radii of ring and tube (m)."""
    dot_weight: Any
    along_weight: Any
    distance_weight: Any
    turn_weight: Any
    """(.,) of each term in its row."""
    value: Any
    """(m,) constant that the sum of each row equals, besides its law."""
    driven: Any
    """(., 2) row and law."""
    row_body: Any
    """(m, k) bodies of each row; -1: none."""
    held: int
    """Rows of joints and drivers; those of forces stand behind them."""
    force: Any
    """(f, 2) row and law of each force; law 0: none."""
    push: Any
    """(f, 4) its stiffness, free value, damping and constant amount."""
    friction: Any
    """(r, 6) rows of forces that are friction; see friction.py."""
    friction_number: Any
    """(r, 8)"""
    call: Any
    """(c, 4) address of the function of each force that has one, its first frame, how many it has, first input."""
    frame_place: Any
    """(f,) place of each frame, as arms number them."""
    frame_turn: Any
    """(f, 4) Euler parameters from each frame to principal axes."""
    inputs: Any
    """(i,) inputs of all functions, whose numbers stay."""
    wrench: Any
    """(m, 2) joint of each row of joints, and column of its second body; -1: a driver's."""
    joint_arm: Any
    """(joints,) place at which the wrench of each joint is given."""


class Workspace(NamedTuple):
    """Scratch of one evaluation."""

    rotation: Any
    """(nb, 3, 3) from principal axes to world."""
    arm: Any
    """(p, 3) from centres of mass, in the world (m)."""
    place: Any
    """(p, 3) in the world (m)."""
    rate: Any
    """(p, 3) velocity of each place (m/s)."""
    bend: Any
    """(p, 3) w x (w x arm) of each place (m/s^2)."""
    axis: Any
    """(x, 3) in the world."""
    axis_rate: Any
    """(x, 3) w x axis."""
    axis_bend: Any
    """(x, 3) w x (w x axis)."""
    guess: Any
    """(turns,) angle that a turn's whole turns are counted by (rad)."""
    turn: Any
    """(turns,) counted angles (rad)."""
    turn_rate: Any
    """(turns,) rad/s"""
    phi: Any
    """(m,)"""
    jac: Any
    """(m, 6 k)"""
    right: Any
    """(2, m) right-hand sides: gamma, nu."""
    pose: Any
    """(3 + 7 n,) trial coordinates."""
    delta: Any
    """(2, 3 + 6 n) changes or velocities."""
    law: Any
    """(3,) value of a law with two derivatives."""
    load: Any
    """(3 + 6 n,) force and torque in the world that are left for multipliers."""
    inputs: Any
    """(i,) of functions of forces; see calls.py."""
    outputs: Any
    """(c, o) what they gave last."""
    friction: Any
    """(5, r) of friction; see friction.py."""
    roll: Any
    """(8, 3) vectors of one roll; see roll.py."""


def workspace_for(system: System) -> Workspace:
    """Return scratch for a system, with ground in its place."""
    bodies, places, axes, turns = len(system.mass), len(system.arm), len(system.axis), len(system.turn)
    rows, sides = system.row_body.shape
    rotation = np.zeros((bodies, 3, 3))
    rotation[0] = np.eye(3)
    return Workspace(
        rotation=rotation,
        arm=np.zeros((places, 3)),
        place=np.zeros((places, 3)),
        rate=np.zeros((places, 3)),
        bend=np.zeros((places, 3)),
        axis=np.zeros((axes, 3)),
        axis_rate=np.zeros((axes, 3)),
        axis_bend=np.zeros((axes, 3)),
        guess=np.zeros(turns),
        turn=np.zeros(turns),
        turn_rate=np.zeros(turns),
        phi=np.zeros(rows),
        jac=np.zeros((rows, 6 * sides)),
        right=np.zeros((2, rows)),
        pose=np.zeros(7 * bodies - 4),
        delta=np.zeros((2, 6 * bodies - 3)),
        law=np.zeros(3),
        load=np.zeros(6 * bodies - 3),
        roll=np.zeros((8, 3)),
        friction=np.zeros((5, len(system.friction))),
        inputs=system.inputs.copy(),
        outputs=np.zeros((len(system.call), 6 * int(system.call[:, 2].max(initial=0)) + 1)),
    )
