"""Arrays of the contacts of a run, as the compiled loop reads and overwrites them; none where there are no contacts."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

ROW, BLOCK, SIDE = 0, 1, 2
"""Columns of Contacts.place: the row of the gap in J, its block and its place there in Schur.rows."""
NEAR, REST, SETTLE, RESTITUTION, SCALE, CLOSED, HELD = 0, 1, 2, 3, 4, 5, 6
"""Columns of Contacts.number: gap and rate that count as zero, slowest rebound, coefficient of restitution, what makes
the gap dimensionless; whether it is closed now, and whether its row holds."""
VALUE, RATE, NORMAL, GIVEN, FREE, ALONE, PUSH, SHIFT = range(8)
"""Rows of Contacts.vector."""
SKIPPED, TOUCHING, STAYING, TAKING, KEPT = range(5)
"""Rows of Contacts.chosen."""
BEGUN, WHEN, AT_ONCE, MET, LOAD, START, LENGTH, WHERE, BEYOND, FAILURE = range(10)
"""Entries of Contacts.clock: whether the run has begun; time of the last event (s), events at that time, events so far;
the largest load; the step's start and length (s); where in it something was met, and a part where it is beyond; the
status with which a step to some time within it failed."""
PARTS = np.array([0.0, 0.2, 0.4, 0.6, 0.8, 1.0])
"""Parts of a step at which gaps and normal forces are looked at, as events/crossing.py does."""
MOST_LOOKS = 80


class Contacts(NamedTuple):
    """c contacts."""

    place: Any
    """(c, 3) int"""
    number: Any
    """(c, 7)"""
    clock: Any
    """(10,)"""
    before: Any
    """mbsd.dynamics.state.State: where the step began."""
    trial: Any
    """The same, somewhere within it."""
    quintic: Any
    """(6, 3 nb) of the step; see events/dense.py."""
    pose: Any
    """(2, 3 nb) coordinates and velocities on it."""
    rates: Any
    """(2, 3 nb) their derivative."""
    lam: Any
    """(m,)"""
    force: Any
    """(3 nb,)"""
    samples: Any
    """(6, c) gaps or normal forces at PARTS."""
    answer: Any
    """(c, 3 nb) change of velocities by a unit impulse of each contact."""
    compliance: Any
    """(c, c)"""
    factor: Any
    """(c, c) Cholesky factor of some of it."""
    tableau: Any
    """(c, 2 c + 2) of Lemke's method."""
    vector: Any
    """(8, c)"""
    intervals: Any
    """(MOST_LOOKS + 2, 6) that are still to be looked at for a dip."""
    chosen: Any
    """(5, c) int, flags of contacts."""
    schur: Any
    """mbsd.dynamics.reference.schur.Schur without the rows of contacts, while all are open."""
    special: Any
    """Constraints of relative pose that are no contacts."""
    basis: Any
    """(2, c) int: of the tableau, and rows of its ratio test."""
