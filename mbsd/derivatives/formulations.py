"""Tangents of a run of any formulation, q' = N(q) v, with the jumps at its events.

    q' = N(q) v,  v' = a(t, q, v)     =>     (dq, dv)' = d(q', v')/d(q, v) (dq, dv) + d(q', v')/dp

dq has n entries and dv k <= n, at the start as well. Between events the run is repeated at nodes, where rates are
differentiated (free/rates.py), and the linear equations are collocated (free/linear_motion.py). At an event its time
moves by dt and the state jumps by the law of the run itself, R:

    dt = -(dg + g_p) / g'      dy_+ = dR(dy_- + y_-' dt) + R_p - y_+' dt

Where contacts open or the user only notes an event, rates go on as they were and nothing jumps. Sources: those of
free/jumps.py.

Mechanisms keep their own events (free/jumps.py, free/guards.py): these know joints, friction and clutches by name, and
act on the few coordinates that a motion leaves free. Nodes, errors and the march between events are shared.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from functools import partial
from typing import Any

import numpy as np

from mbsd.base.errors import ModelError, SimulationError
from mbsd.derivatives.free.explicit_time import find_toggles, stencil_at
from mbsd.derivatives.free.free_tangents import REACH, SLIGHT
from mbsd.derivatives.free.guards import ALIKE, GRAZING
from mbsd.derivatives.free.linear_motion import SAME_RATES, ByTime, Carried, carried, own_rates
from mbsd.derivatives.free.mesh import USUAL, nodes_of
from mbsd.derivatives.free.rates import (
    IDLE,
    differentiate_rates,
    let_act,
    tabulate_gaps,
    tabulate_rates,
    tabulate_values,
)
from mbsd.derivatives.free.step_errors import refined_to_error
from mbsd.derivatives.smooth.smooth_motion import STEPS_OF_METHOD
from mbsd.dynamics.events.arrays import (
    BEFORE_AND_AFTER,
    CLOSED,
    GAP,
    KIND,
    LOGGED,
    PAUSES,
    PENDING,
    RESTITUTION,
    ROW,
    SCALE,
    TOUCHING,
    WHICH,
)
from mbsd.dynamics.events.jumps import strike
from mbsd.dynamics.events.loop import FOUND, JUMPED, OVER, run_events
from mbsd.dynamics.events.users import ACTION, GROUP
from mbsd.dynamics.formulation import has_same_rates
from mbsd.dynamics.integrators.kind import Integrator
from mbsd.dynamics.state import ACCEPTED, REACHED, TIME, Settings, State, copied, output_for, start_state

MANY = 10**8
"""Steps of an integrator in one call."""
NOWHERE = np.zeros(0)


@dataclass(frozen=True)
class Run:
    """A run of a formulation from a state that its constraints allow."""

    method: Integrator
    """One that steps any formulation (``general``)."""
    formulation: Any
    """With ``per_size``; of its arrays, events switch those that they switch in any run."""
    scratch: Any
    """Copied, as ``start`` and ``contacts`` are."""
    settings: Settings
    start: State
    """y (2, 3 + n)"""
    velocities: int
    """k: entries of v behind the idle ones; later ones stay zero."""
    contacts: Any = None
    """mbsd.dynamics.events.arrays.Contacts at the start, where there are events."""


@dataclass(frozen=True)
class Parameter:
    """A number p of a formulation or of its start."""

    name: str
    q: np.ndarray
    """(n,) how coordinates at the start change with it."""
    v: np.ndarray
    """(k,) the same of velocities."""
    below: Any = None
    """The formulation at p - step, which shares arrays that events switch with that of the run; None where it stays."""
    above: Any = None
    """The same at p + step."""
    step: float = 1.0
    contacts: tuple[Any, Any] | None = None
    """Contacts at p - step and p + step, where restitutions or events of the user change."""
    size: float = 1.0
    """By how much p changes when all of it changes."""


@dataclass(frozen=True)
class RunEvent:
    """An event at which a contact was struck, or one of the user that happened."""

    t: float
    """s"""
    row: int
    """Row of Contacts; behind these are events of the user."""
    moved: np.ndarray
    """(P,) how its time changes (s by the numbers)."""


@dataclass(frozen=True)
class RunTangents:
    """A run at T output times and its changes with P numbers there."""

    t: np.ndarray
    """(T,) s"""
    y: np.ndarray
    """(T, 2, 3 + n)"""
    q: np.ndarray
    """(P, T, n) changes of coordinates at fixed times."""
    v: np.ndarray
    """(P, T, k) changes of velocities."""
    end: State
    """Where the run ended."""
    end_q: np.ndarray
    """(P, n) changes of coordinates there; where an event ended it, those of the state at its moving time."""
    end_v: np.ndarray
    """(P, k)"""
    events: list[RunEvent]
    error: float
    """Estimate of the largest error, as part of the largest change."""


def run_tangents(
    run: Run, end: float, times: Sequence[float] | np.ndarray, parameters: Sequence[Parameter]
) -> RunTangents:
    """Return a run until ``end`` (s), and its changes with ``parameters`` at output ``times`` (T,) (s).

    Raises ModelError where there is no derivative, or for events whose derivatives are unknown.
    """
    return _March(run, end, np.asarray(times, float), parameters).tangents()


def _copied(part: Any) -> Any:
    """Return arrays in named tuples copied, and those that are only read as they are."""
    if isinstance(part, np.ndarray):
        return part.copy() if part.flags.writeable else part
    return type(part)(*map(_copied, part)) if isinstance(part, tuple) else part


Jump = Callable[[float, np.ndarray, Any, Any], np.ndarray]
"""Gives velocities (3 + n,) after an event at t (s) and a state (2, 3 + n), of a formulation and its contacts."""


@dataclass
class _Outputs:
    """Outputs of the stretches so far."""

    t: list[np.ndarray] = field(default_factory=list)
    y: list[np.ndarray] = field(default_factory=list)
    changes: list[np.ndarray] = field(default_factory=list)
    """(R, n + k, P)"""


class _March:
    """The march along one run; ``change`` (2, P, 3 + n) is that of the state where it stands."""

    def __init__(self, run: Run, end: float, times: np.ndarray, parameters: Sequence[Parameter]) -> None:
        self.run, self.end, self.times, self.dyn = run, end, times, run.formulation
        self.parameters = parameters
        self.name = type(run.formulation).__name__
        self.scratch, self.own = _copied(run.scratch), _copied(run.scratch)
        """For the loop, and for evaluations between its steps."""
        self.state, self.contacts = copied(run.start), _copied(run.contacts)
        self.width, self.k = run.start.y.shape[1], run.velocities
        self.n, self.rows = self.width - IDLE, len(run.start.lam)
        self.size = 1.0 / self.dyn.per_size
        """(3 + n,) sizes of coordinates, and with ``fastest`` of velocities."""
        self.fastest = self._fastest(run.start.y)
        self.change = np.zeros((2, len(parameters), self.width))
        for p, parameter in enumerate(parameters):
            self.change[0, p, IDLE:] = parameter.q
            self.change[1, p, IDLE : IDLE + self.k] = parameter.v
        self.outputs, self.events, self.error = _Outputs(), list[RunEvent](), 0.0
        self.ended = False
        """True if an event of the user ended the run."""

    def tangents(self) -> RunTangents:
        """Return the run and its tangents."""
        if self.contacts is None:
            self._advance_whole()
        else:
            self._refuse_unknown()
            self._begin()
            while not self.ended and self._go_to_event():
                self._pass_event()
        changes = np.concatenate([np.zeros((0, self.n + self.k, len(self.parameters))), *self.outputs.changes])
        q, v = changes[:, : self.n], changes[:, self.n :]
        return RunTangents(
            np.concatenate([NOWHERE, *self.outputs.t]),
            np.concatenate([np.zeros((0, 2, self.width)), *self.outputs.y]),
            np.moveaxis(q, 2, 0),
            np.moveaxis(v, 2, 0),
            self.state,
            self.change[0, :, IDLE:],
            self.change[1, :, IDLE : IDLE + self.k],
            self.events,
            self.error,
        )

    # -- from event to event ------------------------------------------------------------------------------------------

    def _advance_whole(self) -> None:
        first, out = copied(self.state), output_for(NOWHERE, self.width, self.rows)
        settings = self.run.settings
        status = self.run.method.advance(self.dyn, self.scratch, self.state, out, settings, self.end, MANY)
        self._check(status, REACHED)
        self._march(first)

    def _refuse_unknown(self) -> None:
        contacts = self.contacts
        if len(contacts.friction.gap) or len(contacts.sticks.joint) or (contacts.place[:, KIND] != GAP).any():
            raise ModelError(
                f"{self.name}: derivatives with friction of contacts, joints that stick or one-way clutches are not "
                "known in added formulations"
            )
        if len(contacts.repeated.place):
            raise ModelError(f"{self.name}: derivatives with joints that repeat others are not known")

    def _call(self) -> int:
        return run_events(
            self.dyn, self.scratch, self.state, self.run.settings, self.contacts,
            output_for(NOWHERE, self.width, self.rows), self.end, MANY, NOWHERE, NOWHERE,
        )  # fmt: skip

    def _begin(self) -> None:
        """Close contacts at the start. Raises ModelError if they strike, or if a number opens them."""
        self.contacts.clock[PAUSES] = BEFORE_AND_AFTER
        self._check(self._call(), JUMPED)
        if np.abs(self.state.y - self.run.start.y).max() > ALIKE * max(1.0, np.abs(self.state.y).max()):
            raise ModelError(f"{self.name}: derivatives of a run that begins with an impact are not known")
        t = float(self.state.clock[TIME])
        for row in np.flatnonzero(self.contacts.number[:, CLOSED] > 0.0).tolist():
            along, by_number = self._guard_changes(row, t, self.state.y, self.change)
            for parameter, slopes in zip(self.parameters, (along + by_number).T, strict=True):
                scale = self.contacts.number[row, SCALE] * parameter.size
                if (np.abs(slopes) * scale > ALIKE * np.array([1.0, self.fastest])).any():
                    raise ModelError(
                        f"{self.name}: no derivative by '{parameter.name}': it opens contact {row}, which is closed at "
                        "the start, to one side and drives it in to the other. Begin a little apart"
                    )

    def _go_to_event(self) -> bool:
        """March to the next event; returns False where the run ends before it."""
        if self.contacts.clock[PENDING] != 0.0:
            return True
        first = copied(self.state)
        status = self._call()
        self._check(status, REACHED, FOUND)
        self._march(first)
        return status == FOUND

    def _pass_event(self) -> None:
        """Let the event happen at which the run stands, and tangents jump."""
        before, kept, met = copied(self.state), _copied(self.contacts), int(self.contacts.clock[PENDING]) - 1
        users = met - len(kept.place)
        if users >= 0 and (kept.events.release[:, GROUP] == users).any():
            raise ModelError(f"{self.name}: derivatives beyond the joints that event {users} releases are not known")
        status = self._call()
        self._check(status, JUMPED, OVER)
        opens, passes = users < 0 and kept.number[met, CLOSED] > 0.0, users >= 0 and self.contacts.clock[WHICH] == 0.0
        if opens or passes:  # a contact opens, or a value passes zero the other way
            return
        t = float(before.clock[TIME])
        moved = self._times_moved(met, t, before)
        self.events.append(RunEvent(t, met, moved))
        if status == OVER:
            self.change += before.dy[:, None] * moved[:, None]
            self.ended = True
            return
        jump = self._jump(kept, met)
        if jump is not None:
            total = self.change + before.dy[:, None] * moved[:, None]
            total[1] = self._mapped(jump, t, before.y, total, moved)
            self.change = total - self.state.dy[:, None] * moved[:, None]

    def _check(self, status: int, *allowed: int) -> None:
        if status not in allowed:
            raise SimulationError(
                f"{self.name}: the run stops at t = {self.state.clock[TIME]:.9g} s with status {status}, so that there "
                "are no derivatives; mbsd/dynamics/state.py and events/loop.py say what it means"
            )

    # -- stretches ----------------------------------------------------------------------------------------------------

    def _march(self, first: State) -> None:
        """Carry tangents from a state to that where the run stands."""
        begin, end = float(first.clock[TIME]), float(self.state.clock[TIME])
        last = end >= self.end
        inside = self.times[(self.times >= begin) & ((self.times <= end) if last else (self.times < end))]
        if end <= begin:
            return
        begun = np.concatenate([self.change[0, :, IDLE:], self.change[1, :, IDLE : IDLE + self.k]], axis=1).T
        steps = int(self.state.count[ACCEPTED] - first.count[ACCEPTED])
        parts = max(1, int(np.ceil(STEPS_OF_METHOD * steps)))
        edges = np.linspace(begin, end, (min(parts, USUAL) if self.run.method.fixed_step else parts) + 1)

        def way(edges: np.ndarray) -> tuple[np.ndarray, Any]:
            nodes = nodes_of(edges, NOWHERE)
            every = np.union1d(nodes, inside)
            y = self._repeated(first.y, every, end)
            line = self._carried(nodes, y[np.searchsorted(every, nodes)], begun)
            return line.errors_of(inside), lambda: (line, y[np.searchsorted(every, inside)])

        (line, y), error = refined_to_error(way, edges, False, self.name)
        self.error = max(self.error, error)
        self.outputs.t.append(inside)
        self.outputs.y.append(y)
        self.outputs.changes.append(line.at(inside) if len(inside) else line.y[:0])
        self.change[0, :, IDLE:], self.change[1, :, IDLE : IDLE + self.k] = np.split(line.y[-1].T, [self.n], axis=1)

    def _repeated(self, y: np.ndarray, times: np.ndarray, end: float) -> np.ndarray:
        """Return states (T, 2, 3 + n) at times of a stretch that begins with y (2, 3 + n)."""
        state = start_state(y, self.rows, float(times[0]))
        out = output_for(times, self.width, self.rows)
        status = self.run.method.advance(self.dyn, self.own, state, out, self.run.settings, end, MANY)
        self._check(status, REACHED)
        return out.y

    def _carried(self, t: np.ndarray, y: np.ndarray, begun: np.ndarray) -> Carried:
        """Return changes along nodes t (T,) (s), where states are y (T, 2, 3 + n), from ``begun`` (n + k, P)."""
        n, k = self.n, self.k
        self.fastest = max(self.fastest, self._fastest(y))
        matrix, right = np.zeros((len(t), n + k, n + k)), np.zeros((len(t), n + k, len(self.parameters)))
        step = REACH * np.stack([self.size, self.fastest * self.size])
        scratch = np.zeros((2, self.width)), np.zeros((2, 2, self.width)), np.zeros(self.rows)
        differentiate_rates(self.dyn, self.own, t, y, step, k, *scratch, matrix)
        for p, parameter in enumerate(self.parameters):
            if parameter.above is not None:
                slope = self._rates(parameter.above, t, y) - self._rates(parameter.below, t, y)
                slope /= 2.0 * parameter.step
                right[:, :n, p], right[:, n:, p] = slope[:, 0, IDLE:], slope[:, 1, IDLE : IDLE + k]
        size, per = self.size[IDLE:], np.array([1.0 / parameter.size for parameter in self.parameters])
        slight = SLIGHT * np.concatenate([size, self.fastest * size[:k]])[:, None] * per
        flow, by_time = self._flow(t, y)
        if n == k and has_same_rates(type(self.dyn)):
            kinematics = SAME_RATES
        else:
            kinematics = own_rates(matrix[:, :n], np.append(right[:, :n], np.zeros((len(t), n, 1)), axis=2))
        return carried(t, matrix[:, n:], right[:, n:], begun, slight, kinematics, flow, by_time)

    def _flow(self, t: np.ndarray, y: np.ndarray) -> tuple[np.ndarray, ByTime]:
        """Return rates (T, n + k) of the run at nodes t (T,) (s), and how time alone changes v'."""
        n, k = self.n, self.k
        rates = self._rates(self.dyn, t, y)
        stencil = stencil_at(t, t, find_toggles(t, rates[:, 1, IDLE : IDLE + k]))
        moved = [self._rates(self.dyn, times, y)[:, 1, IDLE : IDLE + k] for times in stencil.times]
        slope = np.einsum("it,itk->tk", stencil.weights, np.array(moved))
        flow = np.concatenate([rates[:, 0, IDLE : IDLE + n], rates[:, 1, IDLE : IDLE + k]], axis=1)
        return flow, ByTime(slope, stencil.passing)

    def _rates(self, dyn: Any, t: np.ndarray, y: np.ndarray) -> np.ndarray:
        """Return q' and v' (T, 2, 3 + n) of a formulation."""
        out = np.zeros_like(y)
        tabulate_rates(dyn, self.own, t, y, np.zeros(self.rows), out)
        return out

    def _fastest(self, y: np.ndarray) -> float:
        """Return the fastest speed (1/s) in sizes of states y (..., 2, 3 + n)."""
        return float(np.abs(y[..., 1, :] / self.size).max()) or 1.0

    # -- events -------------------------------------------------------------------------------------------------------

    def _steps(self, change: np.ndarray) -> np.ndarray:
        """Return steps (P,) at which changes (2, P, 3 + n) of states go as far as REACH."""
        far = np.maximum(
            np.abs(change[0] / self.size).max(axis=1), np.abs(change[1] / self.size).max(axis=1) / self.fastest
        )
        return REACH / np.where(far > 0.0, far, 1.0)

    def _guard(self, row: int, t: np.ndarray, y: np.ndarray, dyn: Any, contacts: Any) -> np.ndarray:
        """Return a guard (2, T) at states y (T, 2, 3 + n): a contact's gap and J v, or twice a value of the user."""
        out = np.zeros((2, len(t)))
        if row < len(contacts.place):
            tabulate_gaps(dyn, self.own, int(contacts.place[row, ROW]), t, y, out)
        else:
            tabulate_values(contacts.events, row - len(contacts.place), t, y, out[0])
            out[1] = out[0]
        return out

    def _guard_changes(self, row: int, t: float, y: np.ndarray, change: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return changes (2, P) of a guard along changes (2, P, 3 + n) of a state, and with the parameters."""
        h = self._steps(change)
        away = np.moveaxis(h[:, None] * change, 1, 0)
        beside = np.concatenate([y + away, y - away])
        values = self._guard(row, np.full(len(beside), t), beside, self.dyn, self.contacts)
        ahead, behind = np.split(values, 2, axis=1)
        along, by_number = (ahead - behind) / (2.0 * h), np.zeros_like(ahead)
        for p, parameter in enumerate(self.parameters):
            if parameter.above is not None or parameter.contacts is not None:
                low, high = (self._guard(row, np.array([t]), y[None], *side)[:, 0] for side in self._sides(parameter))
                by_number[:, p] = (high - low) / (2.0 * parameter.step)
        return along, by_number

    def _times_moved(self, row: int, t: float, before: State) -> np.ndarray:
        """Return changes (P,) of the time of an event."""
        dt = REACH / self.fastest
        ahead, behind = (before.y + sign * dt * before.dy for sign in (1.0, -1.0))
        later, sooner = self._guard(
            row, np.array([t + dt, t - dt]), np.array([ahead, behind]), self.dyn, self.contacts
        )[0]
        pace = (later - sooner) / (2.0 * dt)
        scale = self.contacts.number[row, SCALE] if row < len(self.contacts.place) else 0.0
        if not abs(pace) * scale > GRAZING * self.fastest and (scale or pace == 0.0):
            raise ModelError(
                f"{self.name}: at t = {t:.6g} s guard {row} is met without speed, so that a small change may leave it "
                "out: there is no derivative beyond it"
            )
        along, by_number = self._guard_changes(row, t, before.y, self.change)
        return -(along + by_number)[0] / pace

    def _jump(self, kept: Any, met: int) -> Jump | None:
        """Return what changes velocities at an event, if anything does."""
        users, logged = met - len(kept.place), int(self.contacts.clock[LOGGED])
        struck = self.contacts.log[:logged, 0].astype(int).tolist()
        if users >= 0:
            if kept.events.table[users, ACTION] == 0:
                return None
            if struck:
                raise ModelError(
                    f"{self.name}: derivatives beyond event {users} of the user are not known: what its action does "
                    f"makes contact {struck[0]} strike"
                )
            return partial(self._acted, kept, users)
        struck = sorted({met, *struck})
        also = [row for row in struck if row != met and kept.number[row, CLOSED] == 0.0]
        if also:
            raise ModelError(
                f"{self.name}: at t = {self.state.clock[TIME]:.6g} s contacts {met} and {also[0]} are met at one time: "
                "there is no derivative beyond it. Begin a little apart from there"
            )
        return partial(self._struck, kept, struck)

    def _mapped(self, jump: Jump, t: float, y: np.ndarray, total: np.ndarray, moved: np.ndarray) -> np.ndarray:
        """Return changes (P, 3 + n) of velocities after a jump, along changes ``total`` of the state y."""
        out = np.zeros_like(total[1])
        for p, (h, parameter) in enumerate(zip(self._steps(total), self.parameters, strict=True)):
            ahead, behind = (
                jump(t + s * h * moved[p], y + s * h * total[:, p], self.dyn, self.contacts) for s in (1.0, -1.0)
            )
            out[p] = (ahead - behind) / (2.0 * h)
            if parameter.above is not None or parameter.contacts is not None:
                low, high = (jump(t, y, *side) for side in self._sides(parameter))
                out[p] += (high - low) / (2.0 * parameter.step)
        return out

    def _sides(self, parameter: Parameter) -> list[tuple[Any, Any]]:
        """Return formulation and contacts at p - step, and at p + step."""
        formulations = (self.dyn, self.dyn) if parameter.above is None else (parameter.below, parameter.above)
        return list(zip(formulations, parameter.contacts or (self.contacts, self.contacts), strict=True))

    def _struck(self, kept: Any, struck: list[int], t: float, y: np.ndarray, dyn: Any, contacts: Any) -> np.ndarray:
        """Return velocities (3 + n,) after an impact at a state y (2, 3 + n)."""
        own, y = _copied(kept), y.copy()
        own.chosen[TOUCHING] = 0
        own.chosen[TOUCHING, struck] = 1
        own.number[:, RESTITUTION] = contacts.number[:, RESTITUTION]
        if not strike(dyn, self.own, own, t, y):
            raise SimulationError(f"{self.name}: at t = {t:.6g} s no impulses of contacts are possible")
        return y[1]

    def _acted(self, kept: Any, users: int, t: float, y: np.ndarray, dyn: Any, contacts: Any) -> np.ndarray:
        """Return velocities (3 + n,) after an action of the user at a state y (2, 3 + n)."""
        y = y.copy()
        let_act(dyn, self.own, kept, contacts.events, users, t, y)
        return y[1]
