"""Rows that repeat others: whether they really do, or only seem to at the start pose, or open later.

Dynamics works on independent rows alone. A row left out as redundant must close wherever the others close: that is
tried at poses beside the start. If it opens there, the start pose is singular (a toggle, a change point, a stretched
chain): rows depend on each other only in it, and the equations do not say how the links go on.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from mbsd.base.errors import SingularPoseError
from mbsd.dynamics.reference.arrays import scratch_for
from mbsd.dynamics.reference.projection import project
from mbsd.dynamics.reference.rows import OPENED_BY

if TYPE_CHECKING:
    from mbsd.dynamics.prepare.prepared import PreparedDynamics

BESIDE = (0.003, 0.001)
"""How far beside the start is looked, in sizes and rad; nearer where the links do not close, or a row opens: from afar
they may have closed on another branch."""
CLOSED = 1e-9
"""Residuals (sizes, rad) of rows that hold."""
PASSES = 30


def refuse_singular_start(ready: PreparedDynamics, kept: list[int], rows: int) -> None:
    """Note the rows left out of the first ``rows``; raises SingularPoseError if they only seem redundant."""
    packed = ready.packed
    ready.dropped = tuple(sorted(set(range(rows)) - set(kept)))
    if not ready.dropped:
        return
    scratch = scratch_for(ready.dynamics, packed.ws, len(packed.motions), 1)
    scale = packed.row_scale()
    random = np.random.default_rng(3)
    for _ in range(3):
        away = np.concatenate([np.zeros(3), packed.column_scale() * random.standard_normal(packed.coordinates)])
        opened = None
        for part in BESIDE:
            state = np.stack([ready.initial.q + part * away, ready.initial.v])
            project(ready.dynamics, scratch, ready.start, state, PASSES)
            packed.specials.check()
            gaps = np.abs(packed.ws.phi * scale)
            if gaps[kept].max(initial=0.0) <= CLOSED:
                opened = [row for row in ready.dropped if not gaps[row] <= OPENED_BY]
                if not opened:
                    break
        if opened:
            _refuse(ready, opened)


def _refuse(ready: PreparedDynamics, opened: list[int]) -> None:
    packed = ready.packed
    names = ", ".join(dict.fromkeys(f"'{packed.joint_of_row(row).name}'" for row in opened))
    raise SingularPoseError(
        f"{packed.name}: the start pose at t = {ready.start:.6g} s is singular (a toggle, a change point or a "
        f"stretched chain): only there {names} {'repeat' if ',' in names else 'repeats'} what others hold, and how the "
        "links go on is not determined. Start a little beside it with start_near; if nothing can move there, free a "
        "joint."
    )


def refuse_opened(ready: PreparedDynamics, times: np.ndarray, phi: np.ndarray) -> None:
    """Raise SingularPoseError if a row left out as redundant opens at residuals phi (T, m) of ``times`` (T,)."""
    if not ready.dropped:
        return
    packed, rows = ready.packed, np.array(ready.dropped)
    gaps = np.abs(phi[:, rows] * packed.row_scale()[rows])
    late = np.flatnonzero(~(gaps.max(axis=1) <= OPENED_BY))
    if len(late):
        k = int(late[0])
        row = int(rows[np.argmax(gaps[k])])
        raise SingularPoseError(
            f"{packed.name}: by t = {times[k]:.6g} s joint '{packed.joint_of_row(row).name}', left out as redundant, "
            f"is open by {abs(phi[k, row]):.3g} (m or rad): the links passed a change point on another branch, "
            "lengths do not agree there, or an event released the joint that it repeats. Correct the lengths, end "
            "before it, or leave out another joint."
        )
