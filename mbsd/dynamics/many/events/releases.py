"""Joints that events of the user release: their rows of J hold no more, for good."""

from __future__ import annotations

from mbsd.compiling.jit import internal, lazy
from mbsd.dynamics.many.events.arrays import (
    BLOCK,
    EVENT,
    GONE,
    ITS_FRICTION,
    OPEN_BLOCK,
    OPEN_SIDE,
    ROW,
    SIDE_OF_BLOCK,
)
from mbsd.equations.joint_friction import NONE, SENSE


@internal
def _put(dyn, contacts, k, row):
    """Put a row, or -1, where the k-th that may be released stands."""
    release = contacts.events.release
    if release[k, BLOCK] >= 0:
        dyn.schur.rows[release[k, BLOCK], release[k, SIDE_OF_BLOCK]] = row
    if release[k, OPEN_BLOCK] >= 0:
        contacts.schur.rows[release[k, OPEN_BLOCK], release[k, OPEN_SIDE]] = row


@lazy(None)
def hold_joints(dyn, contacts):
    """Let the rows of joints hold that no event has released; friction of the others is none."""
    events = contacts.events
    release = events.release
    for k in range(release.shape[0]):
        _put(dyn, contacts, k, release[k, ROW])
    for k in range(release.shape[0]):  # afterwards, as several events may release one joint
        if events.number[release[k, EVENT], GONE] > 0.0:
            _put(dyn, contacts, k, -1)
            if release[k, ITS_FRICTION] >= 0:
                dyn.loads.friction_number[release[k, ITS_FRICTION], SENSE] = NONE
