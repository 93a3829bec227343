"""One simulation prepared up to its first step, as arguments of the compiled loop; or why it cannot go there."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property
from operator import attrgetter
from typing import Any, NamedTuple

import numpy as np

from mbsd.arrays.packing import Packed
from mbsd.dynamics.batch.block import content, kind_of, laid_out
from mbsd.dynamics.batch.rows import Numbers
from mbsd.dynamics.events.arrays import Contacts
from mbsd.dynamics.events.packing import contacts_of, why_not_compiled, why_too_large
from mbsd.dynamics.genevas import Genevas, no_genevas
from mbsd.dynamics.independent.block import KEPT_SIZE
from mbsd.dynamics.independent.coordinates import Coordinate
from mbsd.dynamics.integrators.advance import number_of
from mbsd.dynamics.prepare.prepare import prepare_dynamics
from mbsd.dynamics.prepare.prepared import PreparedDynamics
from mbsd.dynamics.runs.embedding import embedded_at_start
from mbsd.dynamics.runs.motion import NEAR, IndependentSteps, can_carry, independent_steps
from mbsd.dynamics.runs.run import REFERENCE, Request, Run, run_of
from mbsd.dynamics.state import State
from mbsd.equations.interactions.switching import SWITCHING
from mbsd.kinematics.limits.joints import limits_of
from mbsd.model.body import Marker
from mbsd.model.event import Event
from mbsd.model.mechanism import Model


def has_cylinders(packed: Packed) -> bool:
    """Return True if gas or oil must be checked after a simulation."""
    return any(force.kind.chamber is not None or force.kind.states is not None for force in packed.forces)


class Parts(NamedTuple):
    """Arrays that the loop reads and overwrites."""

    dyn: Any
    """Dynamics or Embedding."""
    scratch: Any
    state: Any
    settings: Any
    contacts: Contacts
    genevas: Genevas


class NotCompiled(Exception):
    """Why a simulation does not go in the compiled loop; the text says what it has."""


@dataclass
class SingleRun:
    """A run before its first step."""

    ready: PreparedDynamics
    run: Run
    state: State
    independent: IndependentSteps | None
    coordinates: list[Coordinate]
    """Independent ones, if it has some."""
    traces: dict[str, Marker]
    """Traced points as they are now."""
    events: list[Event]
    """Events of the user."""

    @property
    def steps_at_once(self) -> int:
        """Steps between which a single simulation looks at something."""
        one_by_one = bool(self.ready.approaches) or self.near > 0.0
        return 1 if one_by_one else self.run.steps_at_once

    @cached_property
    def kind(self) -> tuple[Any, ...]:
        """Return all that runs which share a block have in common."""
        stops, dynamics = self.ready.stops, (self.ready.dynamics,)
        return (
            kind_of(self.parts),
            None if self.independent is None else kind_of(dynamics),  # multipliers are found from it
            self.ready.mobility.redundant_rows,
            tuple((name, marker.body.name) for name, marker in self.traces.items()),
            stops.before.tobytes(),
            stops.after.tobytes(),
            self.steps_at_once,
            self.near,
        )

    @property
    def counts_turns(self) -> bool:
        """Return True if limits of angles are counted from the turn of its start."""
        return bool(self.ready.switches.contacts) and any(limit.angular for limit in limits_of(self.ready.packed))

    @property
    def failed(self) -> bool:
        """Return True if a function of the user failed in this thread."""
        return any(callback.failed for callback in self.ready.packed.specials.callbacks)

    def forget_failures(self) -> None:
        """Clear recorded failures of functions of the user."""
        for callback in self.ready.packed.specials.callbacks:
            callback.forget()

    @cached_property
    def outputs_count(self) -> bool:
        """Return True if forces at outputs count later: friction goes on from the last one, others may remember."""
        loads, sliding = self.ready.dynamics.loads, self.ready.dynamics.sliding
        switches = bool(loads.switch[0, SWITCHING] > 0.0)
        return switches or len(loads.friction) + len(loads.user) + len(sliding.rows) > 0

    @cached_property
    def outputs_alone(self) -> bool:
        """Return True if outputs do not influence later steps and only measures read them.

        That is so of closed forms: Newton-Raphson begins where the last evaluation ended, and moves last digits.
        """
        held, own = self.contacts, self.independent
        if own is None or own.arrays.block[KEPT_SIZE] or self.outputs_count or has_cylinders(self.ready.packed):
            return False
        parts = held.place, held.wheels.markers, held.curves.place, held.events.table, held.repeated.place
        return not any(len(part) for part in (*parts, self.genevas.body))

    @cached_property
    def near(self) -> float:
        """Part of the largest margin below which steps are carried across a nearly singular pose; 0 where none are."""
        reference = self.independent is None and self.run.formulation == REFERENCE
        carried = reference and not self.events and can_carry(self.run)
        return NEAR if carried else 0.0

    @property
    def parts(self) -> Parts:
        """Return the arrays that the loop reads and overwrites."""
        if self.independent is not None:
            own = self.independent
            return Parts(own.arrays, own.scratch, own.own, own.settings, self.contacts, self.genevas)
        return Parts(self.ready.dynamics, self.run.scratch, self.state, self.run.settings, self.contacts, self.genevas)

    @cached_property
    def contacts(self) -> Contacts:
        """Contacts and joints that stick, which the loop meets, and wheels that it looks at step by step."""
        state = self.state if self.independent is None else self.independent.own
        return contacts_of(self.ready, state, self.events, self.run.settings.longest, self.run.method)

    @cached_property
    def genevas(self) -> Genevas:
        """Genevas at whose jumps steps end."""
        own = self.independent
        if own is None or own.genevas is None:
            return no_genevas(self.state if own is None else own.own)
        return own.genevas


class Base:
    """A run before its first step, laid out in a block of numbers, which all others of its kind share."""

    def __init__(self, run: SingleRun, parts_of: Callable[[SingleRun], Any] = attrgetter("parts")) -> None:
        """``parts_of`` gives what is laid out of a run."""
        self.run, self._parts_of = run, parts_of
        self.parts, self.block, self.layout = laid_out(parts_of(run))
        self.fresh = self.block[None].copy()
        """(1, N) the block before the first step."""

    def alike(self, runs: Sequence[SingleRun]) -> Numbers:
        """Return the numbers of runs of this kind that were prepared."""
        fresh = np.array([content(self._parts_of(run)) for run in runs])
        return Numbers(self.block, fresh, np.zeros(0, np.int64), np.zeros((1, 0)))

    def with_values(self, place: np.ndarray, value: np.ndarray) -> Numbers:
        """Return the numbers of rows that differ from this run by ``value`` (R, k) at ``place`` (k,)."""
        return Numbers(self.block, self.fresh, place, value)


def single_run(m: Model, asked: Request, reactive: bool = False) -> SingleRun:
    """Prepare it as ``simulate`` does; ``reactive``: measures read reactions, too.

    Raises what ``simulate`` raises, and NotCompiled.
    """
    if number_of(asked.integrator) is None:
        raise NotCompiled(f"method '{asked.integrator.name}' has no loop over many")
    times, events = asked.times, list(m.events.values())
    ready = prepare_dynamics(m, float(times[0]), float(times[-1]), contacts=True)
    _refuse(ready)
    if reactive and ready.approaches:
        raise NotCompiled("reactions where the damping of a contact remembers how fast it approached")
    if reactive and ready.following.rows:
        raise NotCompiled("reactions where points are on curves that cross themselves")
    run = run_of(m, asked, ready)
    why = why_not_compiled(events, run.settings.longest)
    if why is not None:
        raise NotCompiled(why)
    state, _ = ready.begun(times)
    ready.approaches.forget()
    independent = None if events else independent_steps(run, state)
    made = None if independent is None else embedded_at_start(ready)
    return SingleRun(ready, run, state, independent, [] if made is None else made.coordinates, {**m.traces}, events)


def _refuse(ready: PreparedDynamics) -> None:
    """Raise NotCompiled for what Python decides between steps, and what it looks at after a simulation."""
    packed = ready.packed
    why = why_too_large(ready)
    if why is not None:
        raise NotCompiled(why)
    slow = [callback.what for callback in packed.specials.callbacks if not callback.compiled]
    if slow:
        raise NotCompiled(f"{slow[0]}: the function is one of Python; compile it with numba.njit")
    if ready.initial.velocities:
        raise NotCompiled("the start was made consistent: " + "; ".join(ready.initial.velocities))
