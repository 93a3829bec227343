"""Simulations with events of the user: the compiled loop of the plane goes on from event to event.

A function of the user is watched along each step, on its quintic and along the motion itself, exactly as in the plane
(mbsd/dynamics/events/). Its number is that of the motion now (moment.py), or of the numbers of frames (frames.py).
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from mbsd.base.errors import ModelError, SimulationError
from mbsd.compiling.callback import Callback
from mbsd.dynamics import repeated_rows
from mbsd.dynamics.events import arrays, loop, users
from mbsd.dynamics.events.laws.division import division_of
from mbsd.dynamics.events.laws.least_part import together_of
from mbsd.dynamics.events.moment import value_at
from mbsd.dynamics.events.packing import NEAR, ROUNDINGS, looks_of
from mbsd.dynamics.events.search import CHANCE
from mbsd.dynamics.reference.sliding import sliding_for
from mbsd.dynamics.state import CHOOSE, PAUSED, REACHED, TIME, WORK, State
from mbsd.model.event import Event, Happening
from mbsd.spatial.arrays.packing import Packed
from mbsd.spatial.dynamics.formulation import Table
from mbsd.spatial.dynamics.frames import SpaceEvents
from mbsd.spatial.dynamics.moment import Moment
from mbsd.spatial.model.body import Marker
from mbsd.spatial.model.rotation import euler_parameters

AT_ONCE = 2000
"""Steps between two looks of Python."""


class Events:
    """Events of a run as arrays, and what happened."""

    def __init__(
        self, packed: Packed, events: list[Event], state: State, longest: float, end: float, dyn: Any, rows: bool
    ) -> None:
        """``rows``: keep outputs right before and after each event."""
        self.packed, self.events, self.counted = packed, events, dyn.counted
        self.callbacks: list[Callback] = []
        self.happenings: list[Happening] = []
        self.rows: list[tuple[Any, ...]] = []
        """Time, state, derivative, multipliers, work and counted turns of each output beside events."""
        span = end - float(state.clock[TIME])
        self.contacts = no_contacts(state, self._arrays(len(state.y[0]), longest, span))
        self.contacts.clock[arrays.PAUSES] = arrays.BEFORE_AND_AFTER if rows else arrays.AFTER

    def follow(self, advance: Callable[[Any, int], int], state: State, end: float, often: bool) -> int:
        """Go on to ``end`` (s), or to a terminal event; returns a status of a run.

        ``advance`` calls the loop with the arrays of contacts and steps at most. ``often``: come back after each step.
        """
        before = None
        while True:
            status = advance(self.contacts, 1 if often else AT_ONCE)
            for callback in self.callbacks:
                callback.check()
            happened = int(self.contacts.clock[arrays.WHICH]) - 1
            if status == loop.FOUND:
                before = self._row(state)
            elif status == loop.JUMPED:
                self.contacts.clock[arrays.WHICH] = 0.0
                if happened >= 0:
                    self._tell(state, happened, "event")
                    self.rows += [] if before is None else [before, self._row(state)]
            elif status == loop.OVER:
                self._tell(state, happened, "end")
                self.rows.append(self._row(state))
                return loop.OVER
            elif status == loop.ACTING:
                self._act(state, int(self.contacts.clock[arrays.PENDING]) - 1)
            elif status in (loop.TOO_MANY, CHANCE):
                raise self._refusal(status, state, happened)
            elif status != PAUSED:
                return status
            elif often:
                return REACHED if state.clock[TIME] >= end else CHOOSE

    def _row(self, state: State) -> tuple[Any, ...]:
        self.packed.ws.guess[:] = self.packed.ws.turn
        self.packed.measured(state.y[0])
        turns = self.packed.ws.turn.copy()
        return float(state.clock[TIME]), state.y.copy(), state.dy[1].copy(), state.lam.copy(), state.clock[WORK], turns

    def _tell(self, state: State, e: int, what: str) -> None:
        self.happenings.append(Happening(float(state.clock[TIME]), self.events[e].name, what))

    def _act(self, state: State, e: int) -> None:
        moment = Moment(self.packed, float(state.clock[TIME]), state.y[0].copy(), state.y[1].copy(), self.counted)
        moment.act(self.events[e])
        state.y[1] = moment.v
        self.contacts.clock[arrays.ACTED] = 1.0

    def _refusal(self, status: int, state: State, e: int) -> Exception:
        where = f"{self.packed.name}: event '{self.events[e].name}' at t = {float(state.clock[TIME]):.6g} s"
        if status == CHANCE:
            return ModelError(
                f"{where}: its function jumps with the sign of rounding, so that chance would decide whether it "
                "happens. Give a function that is smooth in time and motion"
            )
        return SimulationError(
            f"{where}: more than {loop.AT_ONE_TIME} events at this time. Change what its action does there"
        )

    def _arrays(self, entries: int, longest: float, span: float) -> SpaceEvents:
        frames, table, number = list[Marker](), list[tuple[int, ...]](), []
        for event in self.events:
            what, first = f"{self.packed.name}: event '{event.name}'", len(frames)
            own: Any = event.frames  # markers in space
            frames += own
            value, given = self._value(event, entries, what)
            action, acting = 0, len(frames)
            if event.action is not None and Callback.is_machine_code(event.action):
                action = self._address(event.action, event, 6 * len(event.frames), f"{what}: its action")
                frames += own
            elif event.action is not None:
                action = users.BY_PYTHON
            table.append(
                (value, first, given, event.direction, int(event.terminal), action, acting, len(frames) - acting)
            )
            number.append((0.0, 0.0, event.shortest or 0.0, 0.0))
        most = max((len(event.frames) for event in self.events), default=0)
        looks = max((looks_of(event, longest) for event in self.events), default=0)
        sizes = np.zeros(entries)
        for b in range(1, len(self.packed.bodies)):
            sizes[7 * b - 4 : 7 * b - 1], sizes[7 * b - 1 : 7 * b + 3] = self.packed.size, 1.0
        return SpaceEvents(
            table=np.array(table, np.int64),
            number=np.array(number),
            gone=np.zeros(0),
            release=np.zeros((0, users.ITS_FRICTION + 1), np.int64),
            body=np.array([self.packed.body_names.index(marker.body.name) for marker in frames], np.int64),
            arm=np.array([self._arm(marker) for marker in frames]).reshape(-1, 7),
            inputs=np.zeros(max(13 * most, 2 * entries)),
            outputs=np.zeros(max(6 * most, 1)),
            near=np.array([signs[0] * NEAR for signs in ROUNDINGS]),
            away=np.array([NEAR * sizes * np.resize(signs, entries) for signs in ROUNDINGS]),
            span=np.array([span]),
            pose=np.zeros((2, entries)),
            bend=np.zeros(entries),
            parts=np.zeros(looks),
            values=np.zeros(looks),
            more=np.zeros((2, looks)),
            there=np.zeros((2, looks)),
            rough=np.zeros((2, looks), np.int64),
            skipped=np.zeros(len(self.events), np.int64),
        )

    def _value(self, event: Event, entries: int, what: str) -> tuple[int, int]:
        """Return the address of the function of an event, and how many frames it gets."""
        if event.frames:
            return self._address(event.value, event, 1, f"{what}: its function"), len(event.frames)

        def watched(t: float, q: np.ndarray, v: np.ndarray) -> float:
            packed: Any = self.packed
            moment: Any = Moment(self.packed, t, q, v, self.counted)
            return value_at(packed, event, moment)

        self.callbacks.append(Callback(watched, (entries, entries), 1, f"{what}: its function"))
        return self.callbacks[-1].address, users.WHOLE

    def _address(self, function: Any, event: Event, outputs: int, what: str) -> int:
        frames = len(event.frames)
        self.callbacks.append(Callback(function, (7 * frames, 6 * frames), outputs, what))
        return self.callbacks[-1].address

    def _arm(self, marker: Marker) -> np.ndarray:
        body = marker.body
        own = body.principal[1].T
        return np.concatenate([own @ (np.array(marker.place) - body.com), euler_parameters(own @ marker.axes)])


def no_events() -> SpaceEvents:
    """Return arrays of no event, for loops that look for none."""
    return SpaceEvents(*(np.zeros(0) for _ in SpaceEvents._fields))


def no_contacts(state: State, events: SpaceEvents) -> arrays.Contacts:
    """Return arrays of the loop of events for a mechanism whose rows always hold."""
    n, rows = state.y.shape[1], len(state.lam)
    none, whole, square = np.zeros(0), np.zeros((0, 2), np.int64), np.zeros((0, 0))

    def another() -> State:
        return State(*(np.zeros_like(part) for part in state))

    table = Table(whole, whole)
    return arrays.Contacts(
        place=np.zeros((0, arrays.FRICTION + 1), np.int64), number=np.zeros((0, arrays.RELEASED + 1)),
        clock=np.zeros(arrays.DIVIDES + 1), before=another(), trial=another(), quintic=np.zeros((6, n)),
        pose=np.zeros((2, n)), rates=np.zeros((2, n)), lam=np.zeros(rows), force=np.zeros(n),
        parts=arrays.PARTS.copy(), samples=np.zeros((0, len(arrays.PARTS))), answer=np.zeros((0, n)),
        compliance=square, factor=square, tableau=np.zeros((0, 2)), vector=np.zeros((arrays.SHIFT + 1, 0)),
        intervals=np.zeros((arrays.MOST_LOOKS + 2, 6)), chosen=np.zeros((arrays.STRUCK + 1, 0), np.int64),
        schur=table, special=whole, basis=np.zeros((2, 0), np.int64),
        sticks=arrays.Sticks(
            np.zeros(0, np.int64), np.zeros((arrays.GIVES + 1, 0)), np.zeros((arrays.BASIS + 1, 0)), square,
            np.zeros((2, rows)), np.zeros((2, n)), square, square, square, division_of(0), together_of(0),
        ),
        friction=arrays.Friction(
            np.zeros(0, np.int64), np.zeros((0, arrays.HOLDING + 1)), square, np.zeros(0, np.int64),
            sliding_for(whole, n, rows),
        ),
        wheels=arrays.Wheels(whole, none, np.zeros(3), another()),
        curves=arrays.Curves(np.zeros((0, 4), np.int64), none, none),
        events=events,
        repeated=repeated_rows.Repeated(
            np.zeros((0, 3), np.int64), np.zeros((0, repeated_rows.UNTIL + 1)), np.zeros(repeated_rows.FOLLOWS + 1),
            none, square, square, square, square, np.zeros((2, 0)), np.zeros((2, 0), np.int64),
        ),
        log=np.zeros((0, 2)),
        outside=arrays.Outside(np.zeros(1, np.int64), np.zeros(2), np.zeros(1)),
        outlines=np.zeros((0, 4), np.int64), pairs=none, swept_place=np.zeros((0, 4), np.int64), swept=np.zeros((0, 7)),
    )  # fmt: skip
