"""Steps of a run with events: one by one, back to the start of the step where one happens, and on from there.

    step     one step of the integrator; do monitored scalars fall through zero within it?
    root     from the state before the step, integrate to shorter and shorter ends, until the scalar is zero
    jump     what changes there: jumps.py
    restart  from the new state

The integrator itself steps to the event, so that it is met as exactly as the motion is known.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy as np

from mbsd.base.errors import ModelWarning, SimulationError
from mbsd.base.warn import warn
from mbsd.dynamics.events.bounds import NEAR
from mbsd.dynamics.events.crossing import first_crossing
from mbsd.dynamics.events.dense import Quintic
from mbsd.dynamics.events.jumps import Jumps
from mbsd.dynamics.events.laws.resting import carried
from mbsd.dynamics.events.laws.together import held_together, shares_contacts
from mbsd.dynamics.events.monitors import (
    Divide,
    Monitor,
    Samples,
    contact_monitors,
    event_monitor,
    stick_monitors,
)
from mbsd.dynamics.events.resolution import resolved
from mbsd.dynamics.events.sides import refuse_chance, rounding_of, side_ahead, value_of
from mbsd.dynamics.events.start_inside import refuse_inside
from mbsd.dynamics.prepare.exchange import exchange_rows
from mbsd.dynamics.reference.acceleration import derivative
from mbsd.dynamics.rows.bounds import LOOK
from mbsd.dynamics.rows.held import STICKS
from mbsd.dynamics.runs.pace import Pace
from mbsd.dynamics.runs.recording import Snapshot
from mbsd.dynamics.runs.reference_steps import advance
from mbsd.dynamics.state import (
    EVALUATIONS,
    NEXT,
    POWER,
    REACHED,
    STARTED,
    STEP,
    TIME,
    WORK,
    Output,
    State,
    copied,
)
from mbsd.model.event import Event

if TYPE_CHECKING:
    from mbsd.dynamics.prepare.prepared import PreparedDynamics
    from mbsd.dynamics.runs.run import Run

STILL = 1e-9
EVENT_STEPS = 20
"""Steps that an event is worth where the pace of a run is looked at."""
IN_TURN = 5
"""Events at one time, for each contact, after which contacts are no longer taken one by one."""
AT_ONE_TIME = 500
"""Events that may happen without time going on."""


class EventSteps:
    """Steps from ``state``; what happened is in ``happenings``, points to go on from in ``snapshots``."""

    def __init__(self, ready: PreparedDynamics, run: Run, state: State, out: Output, events: list[Event]) -> None:
        self.ready, self.packed, self.dynamics, self.switches = ready, ready.packed, ready.dynamics, ready.switches
        self.sticks = ready.sticks
        self.run, self.state, self.out, self.events = run, state, out, events
        scale = 1.0 / self.packed.row_scale()
        self.near, self.still = NEAR * scale, STILL * scale
        self.now = self.switches.now
        self.now.events, self.now.sliding = {}, [0.0] * len(self.switches.contacts)
        self.jumps = Jumps(ready, run.scratch, state, self.near, self.still)
        self.monitors: list[Monitor] = []
        self.happenings = self.jumps.happenings
        self.snapshots: list[Snapshot] = []
        self.held = np.zeros((len(out.t), len(self.packed.ws.phi)), bool)
        """(T, m) rows that held at each output."""
        self.rows: list[tuple] = []
        """Outputs right before and after each event: the parts of an Output, and the rows that hold."""
        self.ended = False
        self._told = 0
        self._times: list[float] = []
        self._unresolved: set[str] = set()
        self._shares: Divide | None = None
        self._together = False

    # -- going on -----------------------------------------------------------------------------------------------

    def begin(self) -> None:
        """At the start of a simulation: what is closed, and impacts of velocities that contacts forbid."""
        refuse_inside(self.packed, self.dynamics, self.run.scratch, self.switches.contacts, self.state)
        for event in self.events:
            value = value_of(self.packed, event, self.state)
            self.now.events[event.name] = (
                0.0 if abs(value) <= rounding_of(self.packed, event, value, self.state) else float(np.sign(value))
            )
        self.jumps.resolve(None)
        self._restart()
        self._meet_reached()

    def resume(self, snapshot: Snapshot, work: float) -> None:
        """Go on from where another run was, with its contacts as they were."""
        self.now.restore(snapshot.held)
        self.ready.following.settle(*self.state.y)
        self.state.clock[WORK] = work
        self._restart()

    def to(self, end: float, progress: Callable[[float], None] | None = None) -> bool:
        """Go on to ``end`` (s); False if a terminal event came before."""
        state = self.state
        pace = Pace(self.run, state, end, progress)
        turn = 0
        while not self.ended:
            if turn % LOOK == 0:
                exchange_rows(self.ready, state)
            turn += 1
            self.ready.stops.cross(state)
            self._make_valid()
            self._leave_zero()
            before = copied(state)
            status = advance(self.run, state, self.out, end, 1)
            crossing = self._crossing(before) if state.clock[TIME] > before.clock[TIME] else None
            pace.note(extra=0 if crossing is None else EVENT_STEPS)
            if crossing is None:
                self._note_rows()
                if status == REACHED and state.clock[TIME] >= end:
                    return True
                continue
            monitor, first, last = crossing
            self._find(monitor, before, first, last)
            self._note_rows()
            self._meet(monitor)
            self._meet_reached()
        return False

    def _meet(self, monitor: Monitor) -> None:
        """Let what ``monitor`` says happen at the state, whose scalar passes zero there."""
        self._make_valid()
        if not monitor.stops:
            self._turn_side(monitor)
            self._restart()
            return
        before_it, known, senses = self._row(), len(self.happenings), self._senses()
        self._happen(monitor)
        if len(self.happenings) > known or self._senses() != senses:  # a gap that only rounding closes is no event
            self.rows += [before_it] if self.ended else [before_it, self._row()]

    def _senses(self) -> tuple[float, ...]:
        """Return the directions of sliding of contacts and joints; where one reverses, friction jumps."""
        return *self.now.sliding, *self.now.joints_sliding

    def _meet_reached(self) -> None:
        """Let events happen whose value has come to zero by what has just happened, and stays there.

        From then on it passes zero by rounding alone, as the speed of a body that a contact now holds does.
        """
        while not self.ended:
            watched = ((monitor, monitor.event) for monitor in self.monitors if monitor.event is not None)
            reached = next((monitor for monitor, event in watched if self._side_ahead(event) == 0.0), None)
            if reached is None:
                return
            self._meet(reached)

    def _make_valid(self) -> None:
        state = self.state
        if state.count[STARTED] == 0:
            state.clock[POWER] = derivative(
                self.dynamics, self.run.scratch, state.clock[TIME], state.y, state.dy, state.lam
            )
            state.count[EVALUATIONS] += 1
            state.count[STARTED] = 1

    def _note_rows(self) -> None:
        """Outputs written since the last call were written with the rows that hold now."""
        following = int(self.state.count[NEXT])
        if following > self._told:
            self.held[self._told : following] = self.switches.held()
            if self._shares is not None:
                for k in range(self._told, following):
                    q, v = self.out.y[k]
                    self.out.lam[k] = self._shares(self.out.t[k], q, v, self.out.lam[k])[0]
            self._told = following

    # -- joints at rest that share their friction ---------------------------------------------------------------

    def _find_shares(self) -> None:
        """Find what divides the forces of joints and contacts at rest, if one set of rows does not say them."""
        held = self.switches.held() if self.switches.place else np.zeros(0, bool)
        self._together = shares_contacts(self.switches, self.sticks, held, self.jumps.by_turns)
        sharing = any(stick.state == STICKS and not held[stick.way] for stick in self.sticks)
        self._shares = self._divided if self._together or sharing else None

    def _divided(self, time: float, q: np.ndarray, v: np.ndarray, lam: np.ndarray) -> tuple[np.ndarray, float]:
        divide = held_together if self._together else carried
        return divide(self.jumps.compliance(time, q), self.sticks, self.switches, v, lam)

    # -- finding ------------------------------------------------------------------------------------------------

    def _crossing(self, before: State) -> tuple[Monitor, float, float] | None:
        if not self.monitors:
            return None
        quintic = Quintic(before, self.state)
        if quintic.times(np.array([0.5]))[0] in (quintic.start, self.state.clock[TIME]):
            return self._at_end(before)

        def samples(x: np.ndarray) -> Samples:
            q, v = quintic.at(x)
            return Samples(self.packed, self.dynamics, self.run.scratch, quintic.times(x), q, v)

        def true(monitor: Monitor, x: float) -> float:
            return self._true(monitor, before, float(quintic.times(np.array([x]))[0]))

        def looked(monitor: Monitor, x: np.ndarray, values: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
            assert monitor.event is not None
            shortest = monitor.event.shortest
            x, values, known = resolved(x, values, lambda more: monitor.value(samples(more)), quintic.length, shortest)
            if not known:
                self._warn_of(monitor, quintic.start, quintic.length, len(x))
            return x, values

        def rounding(event: Event) -> float:
            return rounding_of(self.packed, event, value_of(self.packed, event, before), before)

        monitors = list(self.monitors)
        while monitors:
            crossing = first_crossing(monitors, samples, true, looked, rounding)
            if crossing is None:
                return None
            monitor, where, negative = crossing
            times = quintic.times(np.array([where, negative]))
            if where == 0.0 or self._true(monitor, before, float(times[1])) < -monitor.still:
                if monitor.event is not None:
                    refuse_chance(self.packed, monitor.event, self._later(before, float(times[1])))
                return monitor, float(times[0]), float(times[1])
            monitors.remove(monitor)  # the quintic dips below zero, the motion does not
        return None

    def _at_end(self, before: State) -> tuple[Monitor, float, float] | None:
        """The same for a step with no time within it, on which a polynomial is rounding."""
        end = float(self.state.clock[TIME])
        fallen = (monitor for monitor in self.monitors if self._true(monitor, before, end) < -monitor.still)
        return next(((monitor, end, end) for monitor in fallen), None)

    def _warn_of(self, monitor: Monitor, start: float, length: float, count: int) -> None:
        """Say once of each event that its function is not resolved."""
        if monitor.name not in self._unresolved:
            self._unresolved.add(monitor.name)
            warn(
                f"{self.packed.name}: event '{monitor.name}' changes too often to be looked at closely: {count} values "
                f"between t = {start:.6g} and {start + length:.6g} s do not tell how it goes, so that events may be "
                "missed. Give shortest= (s), how long the shortest thing in it lasts",
                ModelWarning,
            )

    def _true(self, monitor: Monitor, before: State, time: float) -> float:
        """The monitored scalar of the motion itself at a time (s) within the step; the state is left before it."""
        trial = self._later(before, time)
        at = np.array([trial.clock[TIME]])
        sample = Samples(self.packed, self.dynamics, self.run.scratch, at, trial.y[0][None], trial.y[1][None])
        return float(monitor.value(sample)[0])

    def _later(self, before: State, time: float) -> State:
        """The motion itself at a time (s) within the step."""
        trial = copied(before)
        if time > before.clock[TIME]:
            nowhere = self.run.nowhere
            trial.count[NEXT] = len(nowhere.t)
            advance(self.run, trial, nowhere, time)
        return trial

    def _find(self, monitor: Monitor, before: State, first: float, last: float) -> None:
        """Bring the state to the root, which the quintic puts at ``first`` (s) and ``last`` is beyond."""
        from scipy.optimize import brentq

        start = float(before.clock[TIME])
        root = first
        if first > start:
            low, high = start, last
            reach = min(1e-3 * (last - start), 0.5 * (first - start))  # the start itself may be zero but for rounding
            values: dict[float, float] = {}

            def value(time: float) -> float:
                if time not in values:
                    values[time] = self._true(monitor, before, time)
                return values[time]

            if value(first - reach) > 0.0:
                low = first - reach
            if first + reach < high and value(first + reach) < 0.0:
                high = first + reach
            if value(low) > 0.0 > value(high):
                root = float(brentq(value, low, high, xtol=1e-15))  # pyright: ignore[reportArgumentType]
            # else it left zero at the start of the step: the quintic's root stands
        for target, source in zip(self.state, before, strict=True):
            target[...] = source
        if root > start:
            advance(self.run, self.state, self.out, root)

    def _turn_side(self, monitor: Monitor) -> None:
        """The side of an event that has just passed zero: none where its value stays there."""
        assert monitor.event is not None
        stays = self._side_ahead(monitor.event) == 0.0
        self.now.events[monitor.name] = 0.0 if stays else -self.now.events[monitor.name]

    # -- jumps --------------------------------------------------------------------------------------------------

    def _happen(self, monitor: Monitor) -> None:
        time = float(self.state.clock[TIME])
        self._times = [earlier for earlier in self._times if earlier == time] + [time]
        self.jumps.without_end = len(self._times) > IN_TURN * len(self.switches.contacts)
        if len(self._times) > AT_ONE_TIME:
            raise SimulationError(
                f"{self.packed.name}: more than {AT_ONE_TIME} events at t = {time:.6g} s, the last of '{monitor.name}' "
                f"({monitor.what}). Change its restitution or friction, or what an action does there."
            )
        if monitor.event is not None:
            self._turn_side(monitor)
            self.jumps.tell(monitor.name, "end" if monitor.event.terminal else "event")
            if monitor.event.terminal:
                self.ended = True
                return
            if monitor.event.acts:
                self.jumps.act(monitor.event)
                self.now.events[monitor.name] = 0.0  # it may go back to where it came from
        self.jumps.resolve(monitor)
        self._restart()

    def _restart(self) -> None:
        """Forget the derivative and what was monitored: both belong to the motion before."""
        state = self.state
        state.count[STARTED] = 0
        state.clock[STEP] = 0.0
        self._make_valid()
        load = max(float(np.abs(self.dynamics.weight[3:]).max()), float(np.abs(state.lam).max(initial=0.0)), 1e-300)
        self.monitors = []
        self._find_shares()
        for contact in self.switches.contacts:
            self.monitors += contact_monitors(contact, self.near, self.still, load, self._shares, self._together)
        resting = (part.name for part in (*self.sticks, *self.switches.contacts) if part.state == STICKS)
        self.monitors += stick_monitors(self.sticks, self._shares, next(resting, ""), self.still, load)
        for event in self.events:
            if self.now.events[event.name] == 0.0:
                self.now.events[event.name] = self._side_ahead(event)
            if self.now.events[event.name] != 0.0:
                self.monitors.append(event_monitor(self.packed, event, self.now.events[event.name]))
        self.snapshots.append(self.snapshot())

    def _side_ahead(self, event: Event) -> float:
        return side_ahead(self.packed, event, self.state, self.ready.end - self.ready.start)

    def _leave_zero(self) -> None:
        """Monitor events whose value has stayed zero, which passes nothing by rounding, once they leave it."""
        for event in self.events:
            if self.now.events[event.name] == 0.0:
                side = self.now.events[event.name] = self._side_ahead(event)
                if side != 0.0:
                    self.monitors.append(event_monitor(self.packed, event, side))

    def snapshot(self) -> Snapshot:
        """This moment, to go on from."""
        return Snapshot(
            self.state.y.copy(),
            float(self.state.clock[TIME]),
            float(self.state.clock[WORK]),
            self.now.copy(),
        )

    def _row(self) -> tuple:
        state, shares = self.state, self._shares
        return (
            float(state.clock[TIME]),
            state.y.copy(),
            state.dy[1].copy(),
            state.lam.copy()
            if shares is None
            else shares(float(state.clock[TIME]), state.y[0], state.y[1], state.lam)[0],
            float(state.clock[WORK]),
            float(self.run.scratch.report[0]),
            self.switches.held(),
        )
