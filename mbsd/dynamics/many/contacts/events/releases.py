"""Joints that events of the user release: their rows of J hold no more, for good, and they have no friction."""

from __future__ import annotations

import math

from mbsd.compiling.jit import internal, lazy
from mbsd.dynamics.many.contacts.arrays import CLOSED, FRICTION, HELD, RELEASED, SIGN
from mbsd.dynamics.many.events.arrays import (
    BLOCK,
    GROUP,
    ITS_FRICTION,
    OPEN_BLOCK,
    OPEN_SIDE,
    ROW,
    SIDE_OF_BLOCK,
)
from mbsd.dynamics.many.repeated import arrays as repeated_arrays
from mbsd.dynamics.many.repeated.taking_over import take_over
from mbsd.equations.joint_friction import NONE, SENSE

REPEATED_HELD, UNTIL, NO_MORE = repeated_arrays.HELD, repeated_arrays.UNTIL, repeated_arrays.GONE


@internal
def _put(dyn, contacts, k, row):
    """Put a row, or -1, where the k-th that may be released stands."""
    release = contacts.events.release
    if release[k, BLOCK] >= 0:
        dyn.schur.rows[release[k, BLOCK], release[k, SIDE_OF_BLOCK]] = row
    if release[k, OPEN_BLOCK] >= 0:
        contacts.schur.rows[release[k, OPEN_BLOCK], release[k, OPEN_SIDE]] = row


@internal
def _end_friction(dyn, contacts, at):
    """Let friction ``at`` be none; nothing more happens to a joint that sticks."""
    dyn.loads.friction_number[at, SENSE] = NONE
    for k in range(contacts.place.shape[0]):
        if contacts.place[k, FRICTION] == at:
            contacts.number[k, CLOSED] = 0.0
            contacts.number[k, HELD] = 0.0
            contacts.number[k, SIGN] = 0.0
            contacts.number[k, RELEASED] = 1.0


@lazy(None)
def hold_joints(dyn, contacts):
    """Let the rows of joints hold that no event has released, where none repeat others."""
    events = contacts.events
    release = events.release
    if contacts.repeated.place.shape[0] > 0:
        return
    for k in range(release.shape[0]):
        _put(dyn, contacts, k, release[k, ROW])
    for k in range(release.shape[0]):  # afterwards, as several events may release one joint
        if events.gone[release[k, GROUP]] < math.inf:
            _put(dyn, contacts, k, -1)


@lazy(None)
def release_joints(dyn, scratch, contacts, group, t, q):
    """Release the joints of a group at t (s) and q (3 nb,); rows that repeat theirs hold from then on."""
    events = contacts.events
    repeated = contacts.repeated
    events.gone[group] = min(events.gone[group], t)
    for k in range(events.release.shape[0]):
        if events.release[k, GROUP] != group:
            continue
        if events.release[k, ITS_FRICTION] >= 0:
            _end_friction(dyn, contacts, events.release[k, ITS_FRICTION])
        if repeated.place.shape[0] > 0:
            row = events.release[k, ROW]
            repeated.number[row, REPEATED_HELD] = NO_MORE
            repeated.number[row, UNTIL] = min(repeated.number[row, UNTIL], t)
    if repeated.place.shape[0] > 0:
        take_over(dyn, scratch, repeated, t, q)
    else:
        hold_joints(dyn, contacts)
