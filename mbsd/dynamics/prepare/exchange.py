"""Rows of joints that repeat others, exchanged during a run for rows that are further from dependent.

The equations of motion hold r independent rows of J. Which r does not matter to the motion, but rows that are
independent at the start may become dependent on the way: of three equal cranks the two that are kept can lie flat where
the third does not. Multipliers and rounding grow there without bound, although nothing is singular. So now and then the
rows are chosen anew by pivoted QR of all, and taken where their least singular value is clearly the larger.

Source: Wehage and Haug 1982, J. Mech. Design 104, 247 (choice by factorisation); Golub and Van Loan, Matrix
Computations, sec. 5.4 (pivoted QR).
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from mbsd.kinematics.pose.mobility import BETTER, better_rows, scaled_jacobian

if TYPE_CHECKING:
    from mbsd.dynamics.prepare.prepared import PreparedDynamics
    from mbsd.dynamics.state import State

WORN = 1e3
"""As BETTER where friction of joints comes from these rows' multipliers: other rows divide the load otherwise."""


def exchange_rows(ready: PreparedDynamics, state: State) -> None:
    """Release and hold rows of ``ready.switches`` so that they serve at ``state``; only where some are spare."""
    switches, packed = ready.switches, ready.packed
    spare = switches.spare
    if not spare:
        return
    held = [int(row) for row in switches.bilateral()]
    rows = sorted([*held, *spare])
    jac = scaled_jacobian(packed, state.y[0])[rows]
    better = WORN if len(ready.dynamics.loads.friction) else BETTER
    chosen = better_rows(jac, [rows.index(row) for row in held], better)
    if chosen is None:
        return
    wanted = {rows[k] for k in chosen}
    for row in held:
        if row not in wanted:
            switches.release_row(row)
    for row in wanted - set(held):
        switches.hold_row(row)
    ready.dropped = tuple(sorted({*ready.dropped, *(set(held) - wanted)}))
