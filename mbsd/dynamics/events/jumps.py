"""What changes at an event: velocities by actions and impacts; what contacts and joints that stick do from then on.

action   of the user: velocities change, joints are released; velocities are brought back onto the joints
impacts  of contacts that approach (impact.py)
decide   which contacts are open, slide or stick from now on, and which joints stick (stick_slip.py)
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy as np

from mbsd.base.errors import ModelError
from mbsd.base.users_function import described
from mbsd.compiling.callback import as_numbers
from mbsd.dynamics.events.bounds import CREEP
from mbsd.dynamics.events.laws.compliance import Compliance
from mbsd.dynamics.events.laws.impact import impacts
from mbsd.dynamics.events.laws.independent import independent
from mbsd.dynamics.events.laws.stick_slip import Case, Verdict, decide
from mbsd.dynamics.events.laws.together import one_by_one
from mbsd.dynamics.events.moment import Moment
from mbsd.dynamics.events.monitors import CLOSES, HALTS, OPENS, SLIPS, Monitor
from mbsd.dynamics.reference.arrays import Scratch
from mbsd.dynamics.reference.projection import project
from mbsd.dynamics.rows.held import OPEN, RELEASED, SLIDES, STICKS
from mbsd.dynamics.rows.joint_sticks import release
from mbsd.dynamics.rows.switches import RunContact
from mbsd.dynamics.state import TIME, State
from mbsd.model.event import Event, Happening

if TYPE_CHECKING:
    from mbsd.dynamics.prepare.prepared import PreparedDynamics


class Jumps:
    """Jumps of one run, whose ``state`` they change; ``near``, ``still`` (m,): gaps and rates that count as zero."""

    def __init__(
        self, ready: PreparedDynamics, scratch: Scratch, state: State, near: np.ndarray, still: np.ndarray
    ) -> None:
        self.packed, self.dynamics = ready.packed, ready.dynamics
        self.switches, self.sticks = ready.switches, ready.sticks
        self.scratch, self.state, self.near, self.still = scratch, state, near, still
        self.happenings: list[Happening] = []
        self.without_end = False
        """Whether contacts come to their limits again and again at this time, one by the other."""

    @property
    def by_turns(self) -> bool:
        """Whether contacts come to their limits one by one."""
        return one_by_one(self.switches.contacts, self.sticks) and not self.without_end

    def compliance(self, time: float, q: np.ndarray) -> Compliance:
        """Compliance of a pose q (3 nb,) with the joints that hold now."""
        return Compliance(self.packed, self.dynamics, self.switches, float(time), q.copy())

    def act(self, event: Event) -> None:
        """Let an event of the user change velocities by its action, and release joints."""
        moment = Moment(self.packed, float(self.state.clock[TIME]), self.state.y[0].copy(), self.state.y[1].copy())
        if event.action is not None:
            self._call(event, event.action, moment)
        for name in event.releases:
            moment.release(name)
        for joint in moment.released:
            self.switches.release(joint)
            release(self.switches.now, self.dynamics.loads, self.sticks, int(self.packed.first_row[joint]))
        if moment.released:
            self.switches.hold_spare(self.state.y[0])
        for row in range(self.packed.contact_rows, len(self.packed.ws.phi)):
            # contacts push back by impacts, not by this projection; friction is no impact
            self.switches.release_row(row)
        self.state.y[1] = moment.v
        self.state.y[1, :3] = 0.0
        project(self.dynamics, self.scratch, moment.t, self.state.y, 2)

    def _call(self, event: Event, action: Callable[..., object], moment: Moment) -> None:
        try:
            if event.frames:
                given = action(moment.t, *moment.numbers(event.frames))
                moment.set_numbers(event.frames, as_numbers(given, 3 * len(event.frames)))
            else:
                action(moment)
        except Exception as error:
            raise ModelError(
                f"{self.packed.name}: event '{event.name}': its action fails at t = {moment.t:.6g} s: "
                f"{described(error)}"
            ) from error

    def resolve(self, monitor: Monitor | None) -> None:
        """Impacts, and what every contact and joint does from now on; ``monitor``: what fell through zero."""
        contacts = self.switches.contacts
        if contacts or self.sticks:
            at = self.compliance(self.state.clock[TIME], self.state.y[0])
            fired = monitor.contact if monitor is not None else None
            closed = [
                contact
                for contact in contacts
                if contact.always_closed or contact is fired or at.phi[contact.gap] <= self._close(contact)
            ]
            self._strike(at, closed)
            v = self.state.y[1]
            rates = at.rates([contact.gap for contact in closed], v)
            staying = [t for t, rate in zip(closed, rates, strict=True) if rate <= max(t.settle, self.still[t.gap])]
            forced: dict[str, float] = {}
            if monitor is not None and fired is not None:
                if monitor.what == OPENS and fired in staying:
                    staying.remove(fired)
                if monitor.what == SLIPS:
                    forced[fired.name] = float(np.sign(self.state.lam[fired.way or 0]))
                if monitor.what == HALTS:
                    forced[fired.name] = 0.0
            before = [stick.state for stick in self.sticks]
            self._set(at, self._settled(at, self._case(monitor, staying, forced)), before)

    def _case(self, monitor: Monitor | None, staying: list[RunContact], forced: dict[str, float]) -> Case:
        case = Case(staying, self.sticks, self.state.y[1], self.still, forced, one_by_one=self.by_turns)
        if monitor is not None:
            case.slipping = monitor.what == SLIPS and monitor.contact is None
            case.touched = monitor.name if monitor.what == CLOSES else None
            case.halted = monitor.stick.name if monitor.stick is not None and monitor.what == HALTS else None
        return case

    def _settled(self, at: Compliance, case: Case) -> Verdict:
        """What contacts and joints do, once those that hold are at rest: a rebound too slow to count ends here.

        Its rate must not go on into accelerations: they would turn bodies that two contacts hold, and make these slide
        against each other. Nor may a contact that carries nothing close as slowly: it would do so again and again.
        """
        verdict = decide(at, case)
        for _ in case.closed:
            holding = {decision.contact.name for decision in verdict.contacts if decision.normal > 0.0}
            closed = np.array([contact.gap for contact in case.closed], np.int64)
            holds = np.array([contact.name in holding for contact in case.closed])
            rates, still = at.rates(closed, case.v), self.still[closed]
            creeping = ~holds & (rates < -CREEP * still)
            if not (creeping.any() or (np.abs(rates) > still)[holds].any()):
                break
            gaps = closed[holds | creeping]
            ways = np.array([c.way for c in case.closed if c.name in holding and c.way is not None], np.int64)
            resting = ways[np.abs(at.rates(ways, case.v)) <= self.still[ways]]
            sticking = [stick.way for stick in self.sticks if verdict.joints.get(stick.name) == 0.0]
            self.state.y[1] = case.v = at.stopped([*gaps, *resting, *sticking], case.v)
            verdict = decide(at, case)
        return verdict

    def _close(self, contact: RunContact) -> float:
        return 1e2 * self.near[contact.gap]

    def _strike(self, at: Compliance, closed: list[RunContact]) -> None:
        inertia = self.dynamics.inertia
        before = 0.5 * float(inertia @ self.state.y[1] ** 2)
        after, given = impacts(at, closed, self.state.y[1], self.still)
        if not given:
            return
        self.state.y[1] = after
        change = 0.5 * float(inertia @ after**2) - before
        for impulse in given:
            self.tell(impulse.contact.name, "impact", impulse.normal, change)
            change = 0.0

    def _set(self, at: Compliance, verdict: Verdict, before: list[str]) -> None:
        sliding, sticking = self.switches.now.factors, []
        by_name = {decision.contact.name: decision for decision in verdict.contacts if decision.normal > 0.0}
        sliding[:] = 0.0
        rows: list[int] = []
        for contact in self.switches.contacts:
            old = contact.state
            self.switches.release_row(contact.gap)
            if contact.way is not None:
                self.switches.release_row(contact.way)
            decision = by_name.get(contact.name)
            if decision is None:
                contact.set(OPEN)
            else:
                rows.append(contact.gap)
                if contact.always_closed:
                    self.switches.move_zero(contact.gap, at.phi[contact.gap])
                contact.set(SLIDES, decision.sliding)
                if contact.way is not None and decision.sliding == 0.0:
                    contact.set(STICKS)
                    if old != STICKS:
                        self.switches.move_zero(contact.way, at.phi[contact.way])
                    sticking.append(contact.way)
                elif contact.way is not None:
                    sliding[contact.sliding] = contact.friction * decision.sliding
            self._tell_change(contact, old)
        for row in independent(at, rows + sticking + self._set_joints(at, verdict.joints, before)):
            self.switches.hold_row(row)

    def _set_joints(self, at: Compliance, signs: dict[str, float], before: list[str]) -> list[int]:
        """The rows of the joints that stick from now on; their states ``before``."""
        rows: list[int] = []
        for stick, old in zip(self.sticks, before, strict=True):
            self.switches.release_row(stick.way)
            if stick.state == RELEASED:
                continue
            sign = signs[stick.name]
            stick.set(SLIDES if sign else STICKS, sign)
            if stick.state == STICKS:
                rows.append(stick.way)
                if old != STICKS:
                    self.switches.move_zero(stick.way, at.phi[stick.way])
            if old != stick.state:
                self.tell(stick.name, stick.state)
        return rows

    def _tell_change(self, contact: RunContact, old: str) -> None:
        new = contact.state
        if old != new:
            self.tell(contact.name, "opens" if new == OPEN else "closes" if old == OPEN else new)

    def tell(self, name: str, what: str, impulse: float = 0.0, energy: float = 0.0) -> None:
        """One more of what happened, now."""
        self.happenings.append(Happening(float(self.state.clock[TIME]), name, what, impulse, energy))
