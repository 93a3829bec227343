"""Rows of outlines within the loop of events: which pair a closed row keeps, and where that ends.

A row that closes keeps its pair of a run and a feature, and its sibling, the row of the same runs for a second place,
looks for another one (mbsd/equations/relative/outline_features.py). A closed row ends where its foot comes to the end
of what the run can slide on without a jump of the normal: the guard of a closed contact is then the lesser of its
normal force and

    load * room / size        room: way of the foot to that end (m); load: the largest of the motion (N)

so that a pawl falls off the tip of a tooth at its exact time. The row opens there, and what touches then closes.
"""

from __future__ import annotations

from mbsd.compiling.alternatives import alternatives
from mbsd.compiling.jit import internal
from mbsd.dynamics.events import arrays
from mbsd.dynamics.events.rows import read_gaps
from mbsd.equations.relative.outline_features import CODES, PLACE, ROOM
from mbsd.equations.system import LAST

GAP_ROW, RELATIVE, WAY, SIBLING = range(4)
"""Columns of Contacts.outlines: row of Contacts, rows in Workspace.relative of gap and way, and its sibling here; -1 of
what there is not."""


@internal
def _forget_pairs(dyn, scratch, contacts):
    """Let no row keep a pair."""
    for o in range(contacts.outlines.shape[0]):
        _keep(scratch, contacts, o, 0.0)


@internal
def keep_pairs(dyn, scratch, contacts, t, q):
    """Let rows that have just closed keep their pairs at a pose q (3 nb,), and open rows none."""
    if contacts.outlines.shape[0] == 0:
        return
    read_gaps(dyn, scratch, t, q)
    relative = scratch.ws.relative
    for o in range(contacts.outlines.shape[0]):
        row = contacts.outlines[o, RELATIVE]
        closed = contacts.number[contacts.outlines[o, GAP_ROW], arrays.CLOSED] > 0.0
        contacts.pairs[o] = relative[row, PLACE] if closed else 0.0
    for o in range(contacts.outlines.shape[0]):
        sibling = contacts.outlines[o, SIBLING]
        other = contacts.pairs[sibling] if sibling >= 0 else 0.0
        _keep(scratch, contacts, o, contacts.pairs[o] + CODES * other)


@internal
def _keep(scratch, contacts, o, codes):
    scratch.ws.relative[contacts.outlines[o, RELATIVE], LAST] = codes
    if contacts.outlines[o, WAY] >= 0:
        scratch.ws.relative[contacts.outlines[o, WAY], LAST] = codes


@internal
def _end_at_corners(dyn, scratch, contacts):
    """Lower vector[VALUE] of closed rows to their room, at the pose that was measured."""
    for o in range(contacts.outlines.shape[0]):
        k = contacts.outlines[o, GAP_ROW]
        if contacts.number[k, arrays.CLOSED] > 0.0:
            room = scratch.ws.relative[contacts.outlines[o, RELATIVE], ROOM]
            room *= contacts.number[k, arrays.SCALE] * contacts.clock[arrays.LOAD]
            contacts.vector[arrays.VALUE, k] = min(contacts.vector[arrays.VALUE, k], room)


forget_pairs = alternatives({}, _forget_pairs)
end_at_corners = alternatives({}, _end_at_corners)
