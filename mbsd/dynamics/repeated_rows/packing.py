"""Rows that repeat others, of a prepared run for the compiled loop, or why they do not go there."""

from __future__ import annotations

import numpy as np

from mbsd.dynamics.prepare.large import MANY_COORDINATES
from mbsd.dynamics.prepare.prepared import PreparedDynamics
from mbsd.dynamics.repeated_rows.arrays import BETTER, FOLLOWS, HELD, OPENED, ROW, SCALE, UNTIL, Repeated
from mbsd.kinematics.pose.held_values import RANK_TOLERANCE
from mbsd.kinematics.pose.mobility import BETTER as FACTOR

WORN = 1e3
"""As FACTOR where friction of joints comes from these rows' multipliers: other rows divide the load otherwise."""


def why_not(ready: PreparedDynamics) -> str | None:
    """Return why a mechanism whose joints repeat others does not go in a batch, or None."""
    if ready.switches.spare or not ready.dropped:
        return None
    return f"joints repeat others in a mechanism of {ready.packed.coordinates} coordinates; {MANY_COORDINATES} at most"


def repeated_of(ready: PreparedDynamics) -> Repeated:
    """Return the rows of a run at its start."""
    packed, switches = ready.packed, ready.switches
    spare = set(switches.spare)
    rows = range(packed.contact_rows) if spare else []
    k, n3, scale = len(rows), len(ready.initial.q), packed.row_scale()
    number = np.zeros((k, UNTIL + 1))
    number[:, HELD] = [row not in spare for row in rows]
    number[:, OPENED] = [row in spare for row in rows]
    number[:, SCALE] = [scale[row] for row in rows]
    number[:, UNTIL] = np.inf
    clock = np.zeros(FOLLOWS + 1)
    clock[FOLLOWS] = RANK_TOLERANCE
    clock[BETTER] = WORN if len(ready.dynamics.loads.friction) else FACTOR
    return Repeated(
        np.array([(row, *switches.place[row]) for row in rows], np.int64).reshape(-1, 3),
        number,
        clock,
        np.concatenate([np.zeros(3), packed.column_scale()]) if k else np.zeros(0),
        np.zeros((k, n3)),
        np.zeros((k, k)),
        np.zeros((k, k)),
        np.zeros((k, k)),
        np.zeros((2, k)),
        np.zeros((2, k), np.int64),
    )


def opened(repeated: Repeated) -> list[int]:
    """Return the rows that did not hold once, so that they might open."""
    return repeated.place[repeated.number[:, OPENED] > 0.0, ROW].tolist()
