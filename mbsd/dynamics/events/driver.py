"""A simulation with events: the compiled loop goes on from event to event, and Python keeps what happened at each.

The loop (loop.py) returns after each event, and before it where outputs on both sides are asked for.
Here its arrays become words: what happened, which rows hold at each output, points to go on from, and errors.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy as np

from mbsd.arrays.outline_pairs import pair_rows
from mbsd.base.errors import ModelError, ModelWarning, SimulationError
from mbsd.base.warning import warn
from mbsd.compiling.callback import Callback
from mbsd.dynamics.events import arrays, loop, users
from mbsd.dynamics.events.arrays import Contacts
from mbsd.dynamics.events.moment import Moment, value_at
from mbsd.dynamics.events.packing import contacts_of, opened
from mbsd.dynamics.events.refusals import jam_at, refuse_inside, taking_turns
from mbsd.dynamics.events.search import CHANCE
from mbsd.dynamics.runs.diagnosis import refusal
from mbsd.dynamics.runs.run import Snapshot
from mbsd.dynamics.runs.steps import Pace, advance, check_callbacks
from mbsd.dynamics.state import NEXT, NOT_FINITE, PAUSED, REACHED, TIME, WORK, Output, State
from mbsd.equations.system import LAST, ZERO
from mbsd.model.event import Event, Happening

if TYPE_CHECKING:
    from mbsd.dynamics.prepare.prepared import PreparedDynamics
    from mbsd.dynamics.runs.run import Run

OPEN, SLIDES, STICKS, RELEASED_FOR_GOOD = "open", "slides", "sticks", "released"
"""States of a contact, one without friction slides, and of a joint with friction."""
EVENT_STEPS = 20
"""Steps that an event is worth where the pace of a run is looked at."""
AHEAD = 2.0
"""Last steps within which wheels that meet are why another one fails."""
GOES_ON = (REACHED, PAUSED, loop.FOUND, loop.JUMPED, loop.ACTING, loop.OVER)
"""Status of runs that can go on, or have ended."""


class EventSteps:
    """Steps of a simulation with events; ``happenings`` lists what happened, ``snapshots`` are points to go on from."""

    def __init__(
        self, ready: PreparedDynamics, run: Run, state: State, out: Output, events: list[Event], rows: bool = False
    ) -> None:
        """``rows``: keep outputs right before and after each event."""
        self.ready, self.packed, self.dynamics, self.switches = ready, ready.packed, ready.dynamics, ready.switches
        self.run, self.state, self.out, self.events = run, state, out, events
        if run.contacts is None:
            run.contacts = contacts_of(ready, state, events, run.settings.longest, run.method, log=True)
        self.contacts: Contacts = run.contacts
        self._go_on = ready.loop((loop.run_events.__name__, type(self.dynamics)), loop.run_events)
        if self.contacts.clock[arrays.METHOD] == arrays.OUTSIDE:
            self._outside = Callback(self._advance_outside, (2,), 1, f"{self.packed.name}: steps")
            self.contacts.outside.address[0] = self._outside.address
        self.contacts.clock[arrays.PAUSES] = arrays.BEFORE_AND_AFTER if rows else arrays.AFTER
        self._failure: BaseException | None = None
        what = f"{self.packed.name}: event '"
        self._watched = [callback for callback in self.packed.specials.callbacks if callback.what.startswith(what)]
        self.happenings: list[Happening] = []
        self.snapshots: list[Snapshot] = []
        self.held = np.zeros((len(out.t), len(self.packed.ws.phi)), bool)
        """(T, m) rows that held at each output."""
        self._outlined = pair_rows(self.packed)
        self.pairs = np.zeros((len(out.t), len(self._outlined)))
        """(T, o) pairs of outlines at each output."""
        self.rows: list[tuple] = []
        """Outputs right before and after each event: the parts of an Output, and the rows that hold."""
        self.ended = False
        self._told = 0
        self._unknown: set[str] = set()
        self._before: tuple | None = None
        self._kept = tuple(part for part in self._changing() if part.size)
        self._states, self._senses, self._holding = self._read()
        self._paired = self._pairs_now()

    # -- going on -----------------------------------------------------------------------------------------------

    def begin(self) -> None:
        """Close contacts at the start of a simulation, and resolve velocities that they forbid."""
        self._call(float(self.state.clock[TIME]), 0)

    def resume(self, snapshot: Snapshot, work: float) -> None:
        """Go on from where another run was, with its contacts as they were."""
        pauses = self.contacts.clock[arrays.PAUSES]
        for own, given in zip(self._kept, snapshot.held, strict=True):
            own[...] = given
        self.switches.released = set(snapshot.released)
        self.contacts.clock[arrays.PAUSES] = pauses
        self.contacts.clock[arrays.BEGUN] = arrays.RESUMED
        self.ready.following.settle(*self.state.y)
        self.state.clock[WORK] = work
        self._states, self._senses, self._holding = self._read()
        self._paired = self._pairs_now()

    def to(self, end: float, progress: Callable[[float], None] | None = None) -> bool:
        """Go on to ``end`` (s); False if a terminal event came before."""
        pace = Pace(self.run, self.state, end, progress)
        steps = 1 if self.ready.approaches else self.run.steps_at_once
        while not self.ended:
            status = self._call(end, steps)
            try:
                pace.note(extra=0 if status in (REACHED, PAUSED) else EVENT_STEPS)
            except SimulationError as error:
                raise taking_turns(self.packed.name, self.happenings, end) or error from None
            if status == REACHED and self.state.clock[TIME] >= end:
                return True
        return False

    def _call(self, end: float, steps: int) -> int:
        """Let the loop go on, and keep what it did; returns its status."""
        ready, state, contacts = self.ready, self.state, self.contacts
        status = self._go_on(
            self.dynamics, self.run.scratch, state, self.run.settings, contacts, self.out, end, steps,
            ready.stops.before, ready.stops.after,
        )  # fmt: skip
        self._check(status)
        if len(contacts.repeated.place):
            ready.dropped = tuple(sorted({*ready.dropped, *opened(contacts.repeated)}))
        ready.approaches.note(float(state.clock[TIME]))
        self._note_outputs()
        if status == loop.FOUND:
            self._before = self._row()
        elif status == loop.ACTING:
            self._act(self.events[int(contacts.clock[arrays.PENDING]) - 1 - len(contacts.place)])
        elif status == loop.JUMPED:
            self._note_jump()
        elif status == loop.OVER:
            self.ended = True
            self._tell(self._name(), "end")
            self.rows.append(self._before or self._row())
            self.snapshots.append(self.snapshot())
        return status

    def _advance_outside(self, end: float, asked: np.ndarray) -> float:
        """Let an integrator in Python go on; ``asked``: steps at most, and whether they are tried."""
        try:
            state = self.contacts.trial if asked[1] else self.state
            return float(advance(self.run, state, self.out, end, int(asked[0])))
        except BaseException as error:  # nothing can be raised through the loop
            self._failure = error
            return float(NOT_FINITE)

    # -- what happened ------------------------------------------------------------------------------------------

    def _read(self) -> tuple[list[str], tuple[float, ...], np.ndarray]:
        """Return states of contacts and of joints that stick, directions of sliding, and rows (m,) that hold."""
        contacts, switches = self.contacts, self.switches
        release = contacts.events.release
        if len(release):
            gone = release[contacts.events.gone[release[:, users.GROUP]] < np.inf]
            switches.released.update(gone[:, users.ROW].tolist())
        number, gaps = contacts.number, len(switches.contacts)
        states, way = [], gaps
        for k, contact in enumerate(switches.contacts):
            rough = contact.way is not None
            closed = STICKS if rough and number[way, arrays.CLOSED] > 0.0 else SLIDES
            states.append(closed if number[k, arrays.CLOSED] > 0.0 else OPEN)
            way += rough
        for joint in number[way:]:
            resting = STICKS if joint[arrays.CLOSED] > 0.0 else SLIDES
            states.append(RELEASED_FOR_GOOD if joint[arrays.RELEASED] != 0.0 else resting)
        return states, tuple(number[gaps:, arrays.SIGN].tolist()), switches.held()

    def _note_outputs(self) -> None:
        """Note which rows held at the outputs that were written since the last call."""
        following = int(self.state.count[NEXT])
        self.held[self._told : following] = self._holding
        self.pairs[self._told : following] = self._paired
        self._told = max(self._told, following)

    def _note_jump(self) -> None:
        clock, known = self.contacts.clock, len(self.happenings)
        states, senses, self._holding = self._read()
        self._paired = self._pairs_now()
        which = int(clock[arrays.WHICH]) - 1 - len(self.contacts.place)
        if which >= 0:
            self._tell(self.events[which].name, "event")
        if clock[arrays.WHICH] != 0.0 or not self.snapshots:
            self._tell_impacts()
            self._tell_changes(states)
        self._states = states
        if self._before is not None:  # a gap that only rounding closes is no event
            if len(self.happenings) > known or senses != self._senses:
                self.rows += [self._before, self._row()]
            self._before = None
        self._senses = senses
        self.snapshots.append(self.snapshot())

    def _tell_impacts(self) -> None:
        energy = float(self.contacts.clock[arrays.ENERGY])
        for gap, impulse in self.contacts.log[: int(self.contacts.clock[arrays.LOGGED])].tolist():
            if impulse > 0.0:
                self._tell(self.switches.contacts[int(gap)].name, "impact", impulse, energy)
                energy = 0.0

    def _tell_changes(self, states: list[str]) -> None:
        names = [part.name for part in (*self.switches.contacts, *self.ready.sticks)]
        gaps = len(self.switches.contacts)
        for k, (name, old, new) in enumerate(zip(names, self._states, states, strict=True)):
            if old != new and new != RELEASED_FOR_GOOD:
                opens = k < gaps and new == OPEN
                closes = k < gaps and old == OPEN
                self._tell(name, "opens" if opens else "closes" if closes else new)

    def _tell(self, name: str, what: str, impulse: float = 0.0, energy: float = 0.0) -> None:
        self.happenings.append(Happening(float(self.state.clock[TIME]), name, what, impulse, energy))

    def _name(self) -> str:
        """Return the name of what happened last, or is to happen."""
        clock, contacts = self.contacts.clock, self.switches.contacts
        which = int(clock[arrays.PENDING] or clock[arrays.WHICH]) - 1
        rough = [contact.name for contact in contacts if contact.way is not None]
        names = [contact.name for contact in contacts] + rough + [stick.name for stick in self.ready.sticks]
        return [*names, *(event.name for event in self.events)][which]

    def _act(self, event: Event) -> None:
        """Let the Python action of an event change velocities and release joints."""
        state, contacts = self.state, self.contacts
        moment = Moment(self.packed, float(state.clock[TIME]), state.y[0].copy(), state.y[1].copy())
        moment.act(event)
        for joint in moment.released:
            contacts.events.gone[len(self.events) + joint] = moment.t
        state.y[1] = moment.v
        state.y[1, :3] = 0.0
        contacts.clock[arrays.ACTED] = 1.0

    # -- points to go on from -----------------------------------------------------------------------------------

    def snapshot(self) -> Snapshot:
        """Return this moment, to go on from."""
        held = tuple(part.copy() for part in self._kept)
        released = frozenset(self.switches.released)
        return Snapshot(
            self.state.y.copy(), float(self.state.clock[TIME]), float(self.state.clock[WORK]), held, released
        )

    def _changing(self) -> tuple[np.ndarray, ...]:
        """Return all arrays that events change."""
        contacts, loads, ws = self.contacts, self.dynamics.loads, self.packed.ws
        return (
            contacts.number, contacts.clock, contacts.friction.number, contacts.sticks.vector, contacts.sticks.normal,
            contacts.events.number, contacts.events.gone, contacts.repeated.number, contacts.repeated.clock,
            contacts.schur.rows, self.switches.rows, ws.relative[:, ZERO:], self.dynamics.sliding.table,
            loads.friction_number, loads.normal, loads.iteration, loads.switch,
        )  # fmt: skip

    def _row(self) -> tuple:
        state = self.state
        return (
            float(state.clock[TIME]), state.y.copy(), state.dy[1].copy(), self.contacts.lam.copy(),
            float(state.clock[WORK]), float(self.run.scratch.report[0]), self.switches.held(), self._pairs_now(),
        )  # fmt: skip

    def _pairs_now(self) -> np.ndarray:
        return self.packed.ws.relative[self._outlined, LAST].copy()

    # -- what cannot be -----------------------------------------------------------------------------------------

    def _check(self, status: int) -> None:
        """Raise what went wrong in the loop, and warn of what it could not resolve."""
        state, contacts = self.state, self.contacts
        time = float(state.clock[TIME])
        if self._failure is not None:
            raise self._failure
        for callback in self._watched:
            callback.check()
        check_callbacks(self.run, state, status in GOES_ON)
        if self.events:
            self._warn_of_unknown()
        if status in GOES_ON:
            return
        if status == loop.TOO_MANY:
            raise SimulationError(
                f"{self.packed.name}: more than {loop.AT_ONE_TIME} events at t = {time:.6g} s, the last of "
                f"'{self._name()}'. Change its restitution or friction, or what an action does there."
            )
        if status == loop.NOT_SOLVED:
            if not self.snapshots:
                refuse_inside(self.ready, self.packed.ws.phi)
            raise jam_at(self.ready, contacts, state)
        tried = contacts.trial if contacts.clock[arrays.FAILURE] != 0.0 else state
        if status == CHANCE:
            raise self._chance()
        wheels, before = self.ready.following.wheels, contacts.wheels.before
        wheels.refuse_met(time, state.y[0])
        ahead = AHEAD * float(contacts.wheels.bounds[arrays.LAST_STEP])
        wheels.refuse_meeting(float(before.clock[TIME]), before.y, ahead)
        raise refusal(self.run, status, tried)

    def _warn_of_unknown(self) -> None:
        unknown = self.contacts.events.number[:, users.UNKNOWN]
        for event, values in zip(self.events, unknown.tolist(), strict=True):
            if values:
                self._warn_of(event, int(values))
        unknown[:] = 0.0

    def _warn_of(self, event: Event, count: int) -> None:
        """Say once of each event that its function is not resolved."""
        if event.name in self._unknown:
            return
        self._unknown.add(event.name)
        start, length = self.contacts.clock[[arrays.START, arrays.LENGTH]].tolist()
        warn(
            f"{self.packed.name}: event '{event.name}' changes too often to be looked at closely: {count} values "
            f"between t = {start:.6g} and {start + length:.6g} s do not tell how it goes, so that events may be "
            "missed. Give shortest= (s), how long the shortest thing in it lasts",
            ModelWarning,
        )

    def _chance(self) -> ModelError:
        """Return the error of an event whose function jumps with the sign of rounding."""
        clock, state = self.contacts.clock, self.state
        there = state if clock[arrays.BEYOND] == 1.0 else self.contacts.trial
        event = self.events[int(clock[arrays.WHICH]) - 1 - len(self.contacts.place)]
        q, v, time = there.y[0], there.y[1], float(there.clock[TIME])
        value = value_at(self.packed, event, Moment(self.packed, time, q, v))
        away, near = self.contacts.events.away, self.contacts.events.near
        moments = [Moment(self.packed, time * (1.0 + n), q + a, v + a) for n, a in zip(near, away, strict=True)]
        jump = max(abs(value_at(self.packed, event, moment) - value) for moment in moments)
        return ModelError(
            f"{self.packed.name}: event '{event.name}' at t = {time:.6g} s: its function is {value:.6g}, and changes "
            f"by {jump:.6g} where places and speeds change by rounding alone, so that chance would decide whether the "
            "event happens. It jumps with the sign of something that is zero here, perhaps of a speed that a contact "
            "or a joint holds. Give a function that is smooth in time and motion"
        )
