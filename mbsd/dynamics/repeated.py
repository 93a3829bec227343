"""Simulations of one mechanism over one span at several sets of output times, prepared once where it moves smoothly.

A run without events, contacts and jumps, in independent coordinates, leaves nothing behind in what was prepared: the
next one has the digits of one that is prepared anew, and what the first one recorded is a solution at its own times.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from mbsd.arrays.packing import Packed
from mbsd.arrays.states import without_states
from mbsd.dynamics.prepare.prepare import prepare_dynamics
from mbsd.dynamics.prepare.prepared import PreparedDynamics
from mbsd.dynamics.runs.run import Recording, Run
from mbsd.dynamics.simulate import (
    Between,
    follow,
    integrator_named,
    refuse_impossible,
    resumed,
    simulate,
    solution,
    warn_of_start,
)
from mbsd.dynamics.state import Output
from mbsd.model.mechanism import Model
from mbsd.results.shaking import planes_of
from mbsd.results.solution import Solution


@dataclass
class Course:
    """How a simulation goes, without reactions and residuals."""

    packed: Packed
    t: np.ndarray
    """(T,) s; with events twice the same where one happens."""
    v: np.ndarray
    """(T, 3 nb), as a."""
    a: np.ndarray
    steps: int
    """Steps of the integrator."""
    remembers: bool
    """True if contacts remember how fast they were approached."""
    q: np.ndarray | None = None
    """(T, 3 nb), where it moves smoothly."""
    masses_apart: bool = False
    """True if several freedoms join masses so far apart that one solution of the equations of motion is too coarse."""
    dropped: tuple[int, ...] = ()
    """Rows of joints that repeat others."""


@dataclass
class Outputs:
    """A smooth motion at some R times, whose reactions are found when they are asked for."""

    t: np.ndarray
    """(R,) s."""
    q: np.ndarray
    """(R, 3 nb), as v and a."""
    v: np.ndarray
    a: np.ndarray
    solve: Callable[[], Solution]
    """Gives the solution at these times, whatever has become of the mechanism since."""

    def take(self, rows: np.ndarray) -> Outputs:
        """Some of the times; the solution stays that of all."""
        return Outputs(self.t[rows], self.q[rows], self.v[rows], self.a[rows], self.solve)


def _are_apart(ready: PreparedDynamics) -> bool:
    return ready.masses_apart and ready.mobility.dof > 1


class Repeated:
    """Simulations from the first to the last of ``grid`` (T,) (s), with rows before and after events."""

    def __init__(self, m: Model, grid: np.ndarray, tolerance: float) -> None:
        self.m, self.tolerance = m, tolerance
        self.method = integrator_named(m.name, "dop853")
        self.ready: PreparedDynamics | None = None
        self.grid = grid
        self.span = float(grid[0]), float(grid[-1])
        self.run: Run | None = None
        self.recording: Recording | None = None

    def course(self, times: np.ndarray) -> Course:
        """How it goes at times (T,) (s) from the start to the end. Raises what ``simulate`` raises."""
        ready = prepare_dynamics(self.m, *self.span, contacts=True)
        if not (self.m.events or ready.switches.contacts or ready.sticks or ready.stops.jumps or ready.approaches):
            return self._smooth(ready, times)
        sol = self._simulated(times, ready)
        v, a = (part.reshape(len(sol.t), -1) for part in (sol.v, sol.a))
        apart = _are_apart(ready)
        return Course(sol.packed, sol.t, v, a, sol.stats.steps, sol.approached is not None, None, apart, ready.dropped)

    def closer(self, times: np.ndarray) -> Course:
        """The same at other times, of a motion that is smooth."""
        assert self.ready is not None
        return self._smooth(self.ready, times)

    def _smooth(self, ready: PreparedDynamics, times: np.ndarray) -> Course:
        duration = self.span[1] - self.span[0]
        run = Run(ready, self.method, self.tolerance, float(np.diff(self.grid).max()), duration, {})
        recording = follow(run, times, [], event_rows=True, progress=None)
        shown, out = without_states(ready.packed), recording.out
        q, v, a = (part[:, : 3 * len(shown.body_names)] for part in (out.y[:, 0], out.y[:, 1], out.a))
        if recording.independent:
            self.ready, self.run, self.recording = ready, run, recording
        looked_at = q if recording.independent else None
        return Course(shown, out.t, v, a, recording.steps, False, looked_at, _are_apart(ready), ready.dropped)

    def recorded(self, rows: np.ndarray) -> Outputs:
        """Some rows of the course that was looked at last, of a motion that is smooth."""
        ready, run, recording = self.ready, self.run, self.recording
        assert ready is not None
        assert run is not None
        assert recording is not None
        warn_of_start(ready)
        own = replace(recording, out=Output(*(part[rows] for part in recording.out)), held=recording.held[rows])
        refuse_impossible(ready.packed, own.out.t, own.out.y)

        def at(times: np.ndarray) -> Solution:
            return solution(self.m, ready, resumed(run, own, times, []))

        anew = partial(simulate, self.m, None, 1, self.grid, "dop853", self.tolerance, None, None, {})
        traces, planes = dict(self.m.traces), planes_of(self.m.bodies.values())

        def solve() -> Solution:
            made = solution(self.m, ready, own, Between(at, anew, own.out.y[-1, 0]))
            return replace(made, traces=traces, planes=planes)

        end = 3 * len(without_states(ready.packed).body_names)
        q, v, a = (np.ascontiguousarray(part[:, :end]) for part in (own.out.y[:, 0], own.out.y[:, 1], own.out.a))
        return Outputs(own.out.t, q, v, a, solve)

    def __call__(self, times: np.ndarray) -> Solution:
        """The simulation at times (T,) (s)."""
        return self._simulated(times, self.ready if (times[0], times[-1]) == self.span else None)

    def _simulated(self, times: np.ndarray, ready: PreparedDynamics | None) -> Solution:
        return simulate(self.m, None, 1, times, "dop853", self.tolerance, None, None, {}, event_rows=True, ready=ready)
