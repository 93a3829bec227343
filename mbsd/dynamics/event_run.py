"""A simulation with events: step by step, back to the start of the step where one happens, and on from there.

    step     one step of the integrator; do watched scalars fall through zero within it?
    root     from the state before the step, integrate to shorter and shorter ends, until the scalar is zero
    jump     action of the user; impacts; which contacts are open, slide or stick from now on, and which joints stick
    restart  from the new state

The integrator itself steps to the event, so that it is met as exactly as the motion is known.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy as np

from mbsd.dynamics.acceleration import derivative
from mbsd.dynamics.compliance import Compliance
from mbsd.dynamics.crossing import first_crossing
from mbsd.dynamics.dense import Quintic
from mbsd.dynamics.impact import impacts
from mbsd.dynamics.independent import independent
from mbsd.dynamics.joint_sticks import let_go
from mbsd.dynamics.moment import Moment
from mbsd.dynamics.projection import project
from mbsd.dynamics.resting import carried
from mbsd.dynamics.stick_slip import Case, Verdict, decide
from mbsd.dynamics.switches import OPEN, RELEASED, SLIDES, STICKS, Touch
from mbsd.dynamics.trail import Snapshot
from mbsd.dynamics.watches import (
    HALTS,
    OPENS,
    SLIPS,
    Samples,
    Watch,
    checked,
    event_watch,
    stick_watches,
    touch_watches,
)
from mbsd.errors import SimulationError
from mbsd.event import Event, Happening
from mbsd.integrators.state import (
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
from mbsd.joint_friction import SENSE

if TYPE_CHECKING:
    from mbsd.dynamics.prepare import PreparedDynamics
    from mbsd.dynamics.run import Run

NEAR = 1e-11
"""Gaps below this part of the size (rad) are closed; rates below it by 1 s are zero where bodies rest."""
STILL = 1e-9
INSIDE = 1e-6
"""A contact that starts deeper than this part of the size (rad) inside is refused."""
AT_ONE_TIME = 500
"""Events that may happen without time going on."""


class EventRun:
    """One run from ``state``; what happened is in ``happenings``, points to go on from in ``snapshots``."""

    def __init__(self, ready: PreparedDynamics, run: Run, state: State, out: Output, events: list[Event]) -> None:
        self.ready, self.packed, self.dynamics, self.switches = ready, ready.packed, ready.dynamics, ready.switches
        self.sticks = ready.sticks
        self.run, self.state, self.out, self.events = run, state, out, events
        scale = 1.0 / self.packed.row_scale()
        self.near, self.still = NEAR * scale, STILL * scale
        self.signs = [0.0] * len(self.switches.touches)
        """Of sliding, by contact."""
        self.sides: dict[str, float] = {}
        """Sign of the value of each event of the user."""
        self.watches: list[Watch] = []
        self.happenings: list[Happening] = []
        self.snapshots: list[Snapshot] = []
        self.held = np.zeros((len(out.t), len(self.packed.ws.phi)), bool)
        """(T, m) rows that held at each output."""
        self.rows: list[tuple] = []
        """Outputs right before and after each event: the parts of an Output, and the rows that hold."""
        self.ended = False
        self._told = 0
        self._times: list[float] = []

    # -- going on -----------------------------------------------------------------------------------------------

    def begin(self) -> None:
        """At the start of a simulation: what is closed, and impacts of velocities that contacts forbid."""
        self._refuse_inside()
        for event in self.events:
            self.sides[event.name] = float(np.sign(self._value(event)))
        self._resolve(None)

    def resume(self, snapshot: Snapshot, work: float) -> None:
        """Go on from where another run was, with its contacts as they were."""
        self.dynamics.schur.rows[:] = snapshot.rows
        self.dynamics.sliding.table[:, 0] = snapshot.factor
        self.dynamics.loads.rub_number[:, SENSE] = snapshot.senses
        self.packed.system.numbers[:] = snapshot.numbers
        for stick, (state, sign) in zip(self.sticks, snapshot.joints, strict=True):
            stick.state, stick.sign = state, sign
        for touch, status in zip(self.switches.touches, snapshot.states, strict=True):
            touch.state = status
        self.signs, self.sides = list(snapshot.signs), dict(snapshot.sides)
        self.switches.released = set(snapshot.released)
        self.state.clock[WORK] = work
        self._restart()

    def to(self, end: float, progress: Callable[[float], None] | None = None) -> bool:
        """Go on to ``end`` (s); False if a terminal event came before."""
        state = self.state
        start = float(state.clock[TIME])
        while not self.ended:
            self._make_valid()
            before = copied(state)
            status = self.run.advance(state, self.out, end, 1)
            if progress is not None:
                progress((state.clock[TIME] - start) / (end - start))
            found = self._crossing(before) if state.clock[TIME] > before.clock[TIME] else None
            if found is None:
                self._note_rows()
                if status == REACHED and state.clock[TIME] >= end:
                    return True
                continue
            watch, first, last = found
            self._find(watch, before, first, last)
            self._note_rows()
            if watch.stops:
                self._make_valid()
                self.rows.append(self._row())
                self._happen(watch)
                if not self.ended:
                    self.rows.append(self._row())
            else:
                self._turn_side(watch)
                self._restart()
        return False

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
            if self._sharing:
                for k in range(self._told, following):
                    self.out.lam[k] = self._carried(self.out.t[k], self.out.y[k, 0], self.out.lam[k])[0]
            self._told = following

    # -- joints at rest that share their friction ---------------------------------------------------------------

    @property
    def _sharing(self) -> bool:
        held = self.switches.held() if self.sticks else None
        return held is not None and any(one.state == STICKS and not held[one.way] for one in self.sticks)

    def _carried(self, time: float, q: np.ndarray, lam: np.ndarray) -> tuple[np.ndarray, float]:
        return carried(self._compliance(time, q), self.sticks, lam)

    def _spare(self, samples: Samples) -> np.ndarray:
        """(S,) 1 - s"""
        along = zip(samples.t, samples.q, samples.multipliers(), strict=True)
        return np.array([1.0 - self._carried(*one)[1] for one in along])

    def _compliance(self, time: float, q: np.ndarray) -> Compliance:
        return Compliance(self.packed, self.dynamics, self.switches, float(time), q.copy())

    # -- finding ------------------------------------------------------------------------------------------------

    def _crossing(self, before: State) -> tuple[Watch, float, float] | None:
        if not self.watches:
            return None
        quintic = Quintic(before, self.state)

        def samples(x: np.ndarray) -> Samples:
            q, v = quintic.at(x)
            return Samples(self.packed, self.dynamics, self.run.scratch, quintic.times(x), q, v)

        watches = list(self.watches)
        while watches:
            found = first_crossing(watches, samples)
            if found is None:
                return None
            watch, where, negative = found
            times = quintic.times(np.array([where, negative]))
            if where == 0.0 or self._true(watch, before, float(times[1])) < -watch.still:
                return watch, float(times[0]), float(times[1])
            watches.remove(watch)  # the quintic dips below zero, the motion does not
        return None

    def _true(self, watch: Watch, before: State, time: float) -> float:
        """The watched scalar of the motion itself at a time (s) within the step; the state is left before it."""
        trial = copied(before)
        if time > before.clock[TIME]:
            nowhere = self.run.nowhere
            trial.count[NEXT] = len(nowhere.t)
            self.run.advance(trial, nowhere, time)
        at = np.array([trial.clock[TIME]])
        sample = Samples(self.packed, self.dynamics, self.run.scratch, at, trial.y[0][None], trial.y[1][None])
        return float(watch.value(sample)[0])

    def _find(self, watch: Watch, before: State, first: float, last: float) -> None:
        """Bring the state to the root, which the quintic puts at ``first`` (s) and ``last`` is beyond."""
        from scipy.optimize import brentq

        start = float(before.clock[TIME])
        root = first
        if first > start:
            low, high = start, last
            reach = 1e-3 * (last - start)
            values: dict[float, float] = {}

            def value(time: float) -> float:
                if time not in values:
                    values[time] = self._true(watch, before, time)
                return values[time]

            if value(max(first - reach, low)) > 0.0 and first - reach > low:
                low = first - reach
            if first + reach < high and value(first + reach) < 0.0:
                high = first + reach
            above = value(low)
            if above > 0.0:
                root = float(brentq(value, low, high, xtol=1e-15))  # pyright: ignore[reportArgumentType]
            elif low == start:
                root = first  # it left zero at the start of the step: the quintic's root stands
        for target, source in zip(self.state, before, strict=True):
            target[...] = source
        if root > start:
            self.run.advance(self.state, self.out, root)

    def _turn_side(self, watch: Watch) -> None:
        self.sides[watch.name] = -(self.sides[watch.name] or 1.0)

    # -- jumps --------------------------------------------------------------------------------------------------

    def _happen(self, watch: Watch) -> None:
        time = float(self.state.clock[TIME])
        self._times = [one for one in self._times if one == time] + [time]
        if len(self._times) > AT_ONE_TIME:
            raise SimulationError(
                f"{self.packed.name}: more than {AT_ONE_TIME} events at t = {time:.6g} s, the last of '{watch.name}' "
                f"({watch.what}). Change its restitution or friction, or what an action does there."
            )
        if watch.event is not None:
            self._turn_side(watch)
            self._tell(watch.name, "end" if watch.event.terminal else "event")
            if watch.event.terminal:
                self.ended = True
                return
            if watch.event.action is not None:
                self._act(watch.event)
        self._resolve(watch)

    def _act(self, event: Event) -> None:
        moment = Moment(self.packed, float(self.state.clock[TIME]), self.state.y[0].copy(), self.state.y[1].copy())
        assert event.action is not None
        event.action(moment)
        for joint in moment.released:
            self.switches.release(joint)
            let_go(self.dynamics.loads, self.sticks, int(self.packed.first_row[joint]))
        if moment.released:
            self.switches.stand_in(self.state.y[0])
        for row in range(self.packed.contact_rows, len(self.packed.ws.phi)):
            self.switches.let_go(row)  # contacts push back by impacts, not by this projection; friction is no impact
        self.state.y[1] = moment.v
        self.state.y[1, :3] = 0.0
        project(self.dynamics, self.run.scratch, moment.t, self.state.y, 2)

    def _resolve(self, watch: Watch | None) -> None:
        """Impacts, and what every contact does from now on."""
        touches = self.switches.touches
        if touches or self.sticks:
            at = self._compliance(self.state.clock[TIME], self.state.y[0])
            fired = watch.touch if watch is not None else None
            closed = [
                touch
                for touch in touches
                if touch.always_closed or touch is fired or at.phi[touch.gap] <= self._close(touch)
            ]
            self._strike(at, closed)
            v = self.state.y[1]
            rates = at.rates([touch.gap for touch in closed], v)
            staying = [t for t, rate in zip(closed, rates, strict=True) if rate <= max(t.settle, self.still[t.gap])]
            forced: dict[str, float] = {}
            if watch is not None and fired is not None:
                if watch.what == OPENS and fired in staying:
                    staying.remove(fired)
                if watch.what == SLIPS:
                    forced[fired.name] = float(np.sign(self.state.lam[fired.way or 0]))
                if watch.what == HALTS:
                    forced[fired.name] = 0.0
            before = [stick.state for stick in self.sticks]
            self._set(at, decide(at, self._case(watch, staying, forced)), before)
        self._restart()

    def _case(self, watch: Watch | None, staying: list[Touch], forced: dict[str, float]) -> Case:
        case = Case(staying, self.sticks, self.state.y[1], self.still, forced)
        if watch is not None and watch.stick is not None:
            case.slipping = watch.what == SLIPS
            case.halted = watch.stick.name if watch.what == HALTS else None
        return case

    def _close(self, touch: Touch) -> float:
        return 1e2 * self.near[touch.gap]

    def _strike(self, at: Compliance, closed: list[Touch]) -> None:
        inertia = self.dynamics.inertia
        before = 0.5 * float(inertia @ self.state.y[1] ** 2)
        after, given = impacts(at, closed, self.state.y[1], self.still)
        if not given:
            return
        self.state.y[1] = after
        change = 0.5 * float(inertia @ after**2) - before
        for impulse in given:
            self._tell(impulse.touch.name, "impact", impulse.normal, change)
            change = 0.0

    def _set(self, at: Compliance, verdict: Verdict, before: list[str]) -> None:
        sliding, sticking = self.dynamics.sliding.table[:, 0], []
        by_name = {decision.touch.name: decision for decision in verdict.contacts if decision.normal > 0.0}
        sliding[:] = 0.0
        rows: list[int] = []
        for k, touch in enumerate(self.switches.touches):
            old = touch.state
            self.switches.let_go(touch.gap)
            if touch.way is not None:
                self.switches.let_go(touch.way)
            decision = by_name.get(touch.name)
            self.signs[k] = 0.0
            if decision is None:
                touch.state = OPEN
            else:
                rows.append(touch.gap)
                if touch.always_closed:
                    self.switches.move_zero(touch.gap, at.phi[touch.gap])
                touch.state, self.signs[k] = SLIDES, decision.sliding
                if touch.way is not None and decision.sliding == 0.0:
                    touch.state = STICKS
                    if old != STICKS:
                        self.switches.move_zero(touch.way, at.phi[touch.way])
                    sticking.append(touch.way)
                elif touch.way is not None:
                    sliding[touch.sliding] = touch.friction * decision.sliding
            self._tell_change(touch, old)
        for row in independent(at, rows + sticking + self._set_joints(at, verdict.joints, before)):
            self.switches.take_up(row)

    def _set_joints(self, at: Compliance, signs: dict[str, float], before: list[str]) -> list[int]:
        """The rows of the joints that stick from now on; their states ``before``."""
        rows: list[int] = []
        for stick, old in zip(self.sticks, before, strict=True):
            self.switches.let_go(stick.way)
            if stick.state == RELEASED:
                continue
            sign = signs[stick.name]
            stick.set(SLIDES if sign else STICKS, sign)
            if stick.state == STICKS:
                rows.append(stick.way)
                if old != STICKS:
                    self.switches.move_zero(stick.way, at.phi[stick.way])
            if old != stick.state:
                self._tell(stick.name, stick.state)
        return rows

    def _tell_change(self, touch: Touch, old: str) -> None:
        new = touch.state
        if old != new:
            self._tell(touch.name, "opens" if new == OPEN else "closes" if old == OPEN else new)

    def _tell(self, name: str, what: str, impulse: float = 0.0, energy: float = 0.0) -> None:
        self.happenings.append(Happening(float(self.state.clock[TIME]), name, what, impulse, energy))

    def _restart(self) -> None:
        """Forget the derivative and what was watched: both belong to the motion before."""
        state = self.state
        state.count[STARTED] = 0
        state.clock[STEP] = 0.0
        self._make_valid()
        load = max(float(np.abs(self.dynamics.weight[3:]).max()), float(np.abs(state.lam).max(initial=0.0)), 1e-300)
        self.watches = []
        for touch, sign in zip(self.switches.touches, self.signs, strict=True):
            self.watches += touch_watches(touch, sign, self.near, self.still, load)
        together = self._spare if self._sharing else None
        self.watches += stick_watches(self.sticks, together, self.still, load)
        for event in self.events:
            if self.sides[event.name] == 0.0:
                self.sides[event.name] = float(np.sign(self._value(event)))
            self.watches.append(event_watch(self.packed, event, self.sides[event.name] or 1.0))
        self.snapshots.append(self.snapshot())

    def snapshot(self) -> Snapshot:
        """This moment, to go on from."""
        return Snapshot(
            self.state.y.copy(),
            float(self.state.clock[TIME]),
            float(self.state.clock[WORK]),
            self.dynamics.schur.rows.copy(),
            self.dynamics.sliding.table[:, 0].copy(),
            self.packed.system.numbers.copy(),
            [touch.state for touch in self.switches.touches],
            list(self.signs),
            dict(self.sides),
            set(self.switches.released),
            [(stick.state, stick.sign) for stick in self.sticks],
            self.dynamics.loads.rub_number[:, SENSE].copy(),
        )

    def _row(self) -> tuple:
        state = self.state
        return (
            float(state.clock[TIME]),
            state.y.copy(),
            state.dy[1].copy(),
            self._carried(state.clock[TIME], state.y[0], state.lam)[0] if self._sharing else state.lam.copy(),
            float(state.clock[WORK]),
            float(self.run.scratch.report[0]),
            self.switches.held(),
        )

    # -- at the start -------------------------------------------------------------------------------------------

    def _value(self, event: Event) -> float:
        state = self.state
        return checked(self.packed, event, Moment(self.packed, float(state.clock[TIME]), state.y[0], state.y[1]))

    def _refuse_inside(self) -> None:
        state, scale = self.state, self.packed.row_scale()
        time = np.array([state.clock[TIME]])
        sample = Samples(self.packed, self.dynamics, self.run.scratch, time, state.y[0][None], state.y[1][None])
        for touch in self.switches.touches:
            gap = float(sample.residuals()[0, touch.gap])
            if not touch.always_closed and gap * scale[touch.gap] < -INSIDE:
                raise SimulationError(
                    f"{self.packed.name}: contact '{touch.name}' starts {-gap:.3g} (m or rad) inside; "
                    "move the start with start_near, or turn the contact's marker"
                )
