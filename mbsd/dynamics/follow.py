"""Follow a run to its end, with or without events, and go on from where it was."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from mbsd.base.errors import SimulationError
from mbsd.compiling.interrupts import kept
from mbsd.dynamics.events.driver import EventSteps
from mbsd.dynamics.prepare.prepared import PreparedDynamics
from mbsd.dynamics.reference.multipliers import fill_multipliers
from mbsd.dynamics.runs.motion import to_end
from mbsd.dynamics.runs.recording import Recording, Snapshot
from mbsd.dynamics.runs.run import INDEPENDENT, Run
from mbsd.dynamics.runs.steps import step_to
from mbsd.dynamics.state import ACCEPTED, NEXT, TIME, WORK, Output
from mbsd.model.event import Event

Progress = Callable[[float], None] | None


def follow(
    ready: PreparedDynamics,
    run: Run,
    times: np.ndarray,
    events: list[Event],
    event_rows: bool,
    progress: Progress,
) -> Recording:
    """Simulate from the consistent start to the last of ``times`` (s)."""
    with kept():
        return _followed(ready, run, times, events, event_rows, progress)


def recording_of(met: EventSteps, event_rows: bool = False) -> Recording:
    """Recording of steps with events that have ended: outputs that were reached, with rows at events if asked for."""
    written = int(met.state.count[NEXT])
    out, held = Output(*(part[:written] for part in met.out)), met.held[:written]
    rows = met.rows if event_rows else met.rows[-1:] if met.ended else []
    if rows:
        parts = [np.stack(column) for column in zip(*(row[:-1] for row in rows), strict=True)]
        both = [np.concatenate([a, b]) for a, b in zip(out, parts, strict=True)]
        order = np.argsort(both[0], kind="stable")
        out = Output(*(part[order] for part in both))
        held = np.concatenate([held, np.stack([row[-1] for row in rows])])[order]
    return Recording(
        out, held, int(met.state.count[ACCEPTED]), met.happenings, met.snapshots, met.ready.approaches.copy()
    )


def resumed(
    ready: PreparedDynamics,
    run: Run,
    recording: Recording,
    times: np.ndarray,
    events: list[Event],
    passes_singular: bool = False,
) -> Recording:
    """The motion at other times (T,), rising and within the recording: each from the last point known before it.

    ``passes_singular``: take the steps that pass singular poses at once, where the run was in independent coordinates.
    """
    passes_singular = passes_singular and recording.independent
    smooth = not (events or ready.is_switched)
    began = np.array([snapshot.time for snapshot in recording.snapshots])
    which = np.maximum(np.searchsorted(began, times, side="right") - 1, 0)
    outputs = np.searchsorted(recording.out.t, times, side="right") - 1
    starts = [
        (int(s), int(k) if k >= 0 and recording.out.t[k] > began[s] else -1)
        for s, k in zip(which, outputs, strict=True)
    ]
    pieces, steps, first = [], 0, 0
    while first < len(times):
        last = first
        while last < len(times) and starts[last] == starts[first]:
            last += 1
        s, k = starts[first]
        snapshot = recording.snapshots[s]
        state, out = ready.begun(times[first:last])
        state.clock[TIME] = snapshot.time if k < 0 else recording.out.t[k]
        state.y[...] = snapshot.y if k < 0 else recording.out.y[k]
        state.clock[WORK] = snapshot.work if k < 0 else recording.out.work[k]
        if recording.approaches is not None:
            recording.approaches.recall(float(state.clock[TIME]))
        piece = None
        if not smooth:
            met = EventSteps(ready, run, state, out, events)
            met.resume(snapshot, float(state.clock[WORK]))
            met.to(float(times[last - 1]))
            piece = recording_of(met)
        elif not passes_singular:
            try:
                step_to(run, state, out, float(times[last - 1]))
                held = np.broadcast_to(ready.switches.held(), out.lam.shape)
                piece = Recording(out, held, int(state.count[ACCEPTED]))
            except SimulationError:
                piece = None
        if piece is None:
            # near a singular pose, which independent coordinates pass
            state, out = ready.begun(times[first:last])
            state.clock[TIME] = snapshot.time if k < 0 else recording.out.t[k]
            state.y[...] = snapshot.y if k < 0 else recording.out.y[k]
            state.clock[WORK] = snapshot.work if k < 0 else recording.out.work[k]
            if to_end(run.passing, state, out):
                fill_multipliers(ready.packed, ready.dynamics, out.t, out.y, out.lam, out.margin)
            held = np.broadcast_to(ready.switches.held(), out.lam.shape)
            piece = Recording(out, held, int(state.count[ACCEPTED]))
        pieces.append(piece)
        steps += pieces[-1].steps
        first = last
    out = Output(*(np.concatenate(parts) for parts in zip(*(piece.out for piece in pieces), strict=True)))
    held = np.concatenate([piece.held for piece in pieces])
    return Recording(out, held, steps, approaches=recording.approaches)


def _followed(
    ready: PreparedDynamics,
    run: Run,
    times: np.ndarray,
    events: list[Event],
    event_rows: bool,
    progress: Progress,
) -> Recording:
    state, out = ready.begun(times)
    ready.approaches.forget()
    if run.formulation == INDEPENDENT or not (events or ready.is_switched):
        begun = Snapshot(state.y.copy(), float(state.clock[TIME]), float(state.clock[WORK]))
        independent = to_end(run, state, out, progress)
        held = ready.switches.held()[None].repeat(len(times), axis=0)
        return Recording(out, held, int(state.count[ACCEPTED]), [], [begun], ready.approaches.copy(), independent)
    met = EventSteps(ready, run, state, out, events, event_rows)
    met.begin()
    met.to(float(times[-1]), progress)
    return recording_of(met, event_rows)
