"""Arrays of a spanning tree: Tree is constant during a run, Work is what every evaluation overwrites.

Coordinates (3 + nq,) of the joints stand behind three idle entries, and so do their rates (3 + nz,):

    joint         coordinates                       rates
    free          place r (3), Euler parameters     r', w in the axes of the body
    spherical     Euler parameters, from parent     w against the parent, in the axes of the body
    weld          -                                 -
    prismatic     slide                             its rate
    revolute      turn                              its rate
    cylindrical   turn, slide                       their rates
    universal     turn about the axis of each       their rates

Motions are (w, v) and forces (moment, force) in the axes of the world, about the origin of their tree: where its first
joint stands on ground, or the centre of a body that is free.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

FREE, SPHERICAL, WELD, PRISMATIC, REVOLUTE, CYLINDRICAL, UNIVERSAL = range(7)
"""Joints of a tree; those from REVOLUTE on begin with a turn."""
COORDINATES = {FREE: 7, SPHERICAL: 4, WELD: 0, PRISMATIC: 1, REVOLUTE: 1, CYLINDRICAL: 2, UNIVERSAL: 2}
RATES = {FREE: 6, SPHERICAL: 3, WELD: 0, PRISMATIC: 1, REVOLUTE: 1, CYLINDRICAL: 2, UNIVERSAL: 2}

KIND, PARENT, FIRST_Q, FIRST_Z, COUNT, ROOT = range(6)
"""Columns of Tree.index; COUNT are rates, ROOT is the first body of the tree."""
TURN, SECOND, ARM, OWN_ARM, AXIS, OWN_AXIS = 0, 8, 16, 19, 22, 25
"""Columns of Tree.number; TURN and SECOND are two quaternions each, for the cosine and the sine of half a turn."""
VELOCITY, MOTION, PUSH, FLOW, REACH, ORIGIN = 0, 6, 12, 18, 24, 27
"""Columns of Work.body: its motion, its acceleration, the force it needs, that of a row, centre of mass, origin."""
AXIS_OF, SHARE, INVERSE, LEFT = 0, 6, 12, 13
"""Columns of Work.column: S, U = I S, 1 / (S . U), and what is left for two right-hand sides."""


class Tree(NamedTuple):
    """A spanning tree over bodies and the rows of joints that are cut."""

    order: Any
    """(n,) bodies, parents first."""
    index: Any
    """(nb, 6) see KIND."""
    number: Any
    """(nb, 28) see TURN; arms and axes in principal axes of the parent and of the body itself."""
    path: Any
    """Bodies on which a row acts, and those below them, row after row, children first."""
    begin: Any
    """(m + 1,) where the path of each row begins."""
    linear: Any
    """(l, 3) row, rate and coordinate of terms that are coordinates themselves."""
    factor: Any
    """(l,) weight of each."""
    turns: Any
    """(t, 2) where each turn is read: a coordinate and 0, or a turn of the cut joints and 1."""


class Work(NamedTuple):
    """Scratch of one evaluation."""

    pose: Any
    """(3 + 7 n,) reference coordinates."""
    rate: Any
    """(3 + 6 n,) velocities in the world."""
    bend: Any
    """(3 + 6 n,) accelerations in the world while rates stay."""
    body: Any
    """(nb, 30) see VELOCITY."""
    inertia: Any
    """(nb, 21) of articulated bodies; see bodies.py."""
    column: Any
    """(nz, 15) see AXIS_OF."""
    spread: Any
    """(m, nz) rows, each passed down the tree as a force."""
    side: Any
    """(2, m) Phi and J v - nu."""
    own: Any
    """(2, m) squares of rows, and what others leave of them."""


def work_for(bodies: int, rates: int, rows: int) -> Work:
    """Return scratch for a tree."""
    return Work(
        pose=np.zeros(7 * bodies - 4),
        rate=np.zeros(6 * bodies - 3),
        bend=np.zeros(6 * bodies - 3),
        body=np.zeros((bodies, 30)),
        inertia=np.zeros((bodies, 21)),
        column=np.zeros((rates, 15)),
        spread=np.zeros((rows, rates)),
        side=np.zeros((2, rows)),
        own=np.zeros((2, rows)),
    )
