"""Rows of a simulation on both sides of where the pressure in a cylinder changes phase with the angle of its crank."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from mbsd.arrays.chambers import phase_changes
from mbsd.dynamics.follow import resumed
from mbsd.dynamics.prepare.prepared import PreparedDynamics
from mbsd.dynamics.runs.recording import Recording
from mbsd.dynamics.runs.run import Run
from mbsd.dynamics.state import Output
from mbsd.model.event import Event
from mbsd.results.jump_rows import Asked, jumps_of


def with_phase_changes(
    ready: PreparedDynamics,
    run: Run,
    recording: Recording,
    events: list[Event],
    grid: np.ndarray,
    asked: Asked | None,
) -> tuple[Recording, Asked | None]:
    """The recording with rows beside each change of phase, and what was asked for with them.

    ``grid`` (T,): output times (s); ``asked``: what was, with those beside jumps at known times.
    """
    out = recording.out

    def motion(times: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        y = resumed(ready, run, recording, times, events).out.y
        return y[:, 0], y[:, 1]

    changes = phase_changes(ready.packed, out.t, (out.y[:, 0], out.y[:, 1], out.a), motion)
    if not changes:
        return recording, asked
    known = ready.stops.jumps
    rows = [*zip(known.before.tolist(), known.after.tolist(), known.names, strict=True)]
    asked = jumps_of([*rows, *((a, b, (name,)) for a, b, name in changes)]).among(grid)
    new = asked.solved[~np.isin(asked.solved, out.t) & (asked.solved < out.t[-1])]
    kept = ~np.isin(out.t, np.setdiff1d(grid, asked.solved))
    more = resumed(ready, run, recording, new, events)
    parts = zip(out, more.out, strict=True)
    both = [np.concatenate([first[kept], second]) for first, second in parts]
    held = np.concatenate([recording.held[kept], more.held])
    order = np.argsort(both[0], kind="stable")
    return replace(recording, out=Output(*(part[order] for part in both)), held=held[order]), asked
