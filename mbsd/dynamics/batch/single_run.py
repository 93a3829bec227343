"""One simulation prepared up to its first step, as arguments of the compiled loop; or why it cannot go there."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from mbsd.arrays.chambers import check_pistons
from mbsd.arrays.packing import Packed
from mbsd.arrays.states import states_of
from mbsd.base.errors import MechanismError
from mbsd.dynamics.batch.block import Layout, kind_of, laid_out
from mbsd.dynamics.events.arrays import Contacts
from mbsd.dynamics.events.packing import contacts_of
from mbsd.dynamics.events.users import packing as users_packing
from mbsd.dynamics.genevas.arrays import Genevas
from mbsd.dynamics.genevas.packing import no_genevas
from mbsd.dynamics.independent.arrays import KEPT_SIZE
from mbsd.dynamics.independent.coordinates import Coordinate
from mbsd.dynamics.independent.embedding import embedded_at_start
from mbsd.dynamics.integrators.advance import number_of
from mbsd.dynamics.integrators.kind import Integrator
from mbsd.dynamics.prepare.prepare import prepare_dynamics
from mbsd.dynamics.prepare.prepared import PreparedDynamics
from mbsd.dynamics.repeated_rows import packing as repeated_packing
from mbsd.dynamics.runs.motion import NEAR, IndependentSteps, can_carry, independent_steps
from mbsd.dynamics.runs.run import INDEPENDENT, REFERENCE, Run
from mbsd.dynamics.state import State
from mbsd.equations.interactions.switching import SWITCHING
from mbsd.kinematics.limits.joints import limits_of
from mbsd.model.body import Marker
from mbsd.model.event import Event
from mbsd.model.mechanism import Model
from mbsd.results.states import check_states


def has_cylinders(packed: Packed) -> bool:
    """Whether there is a force that says after a simulation whether that can be."""
    return any(force.kind.chamber is not None or force.kind.states is not None for force in packed.forces)


def can_be(packed: Packed, t: np.ndarray, y: np.ndarray) -> bool:
    """Whether cylinders can be as they are along y (T, 2, 3 nb) at times (T,) (s)."""
    q = np.ascontiguousarray(y[:, 0])
    try:
        check_pistons(packed, t, q, tell=False)
        check_states(packed, t, q, states_of(packed, y[:, 1]))
    except MechanismError:
        return False
    return True


@dataclass(frozen=True)
class Asked:
    """How each is simulated, as ``simulate`` takes it."""

    times: np.ndarray
    """(T,) s."""
    integrator: Integrator
    tolerance: float
    step: float | None
    formulation: str
    options: Mapping[str, float]


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
    """Those of the user."""

    @property
    def steps_at_once(self) -> int:
        """Steps between which a single simulation looks at something."""
        one_by_one = bool(self.ready.approaches) or self.near > 0.0
        return 1 if one_by_one else self.run.steps_at_once

    @cached_property
    def kind(self) -> tuple[Any, ...]:
        """What runs that share a block have in common."""
        stops, dynamics = self.ready.stops, (self.ready.dynamics,)
        return (
            kind_of(self.arguments),
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
        """Whether what it starts with decides of which whole turn limits of angles are."""
        return bool(self.ready.switches.contacts) and any(limit.angular for limit in limits_of(self.ready.packed))

    @property
    def failed(self) -> bool:
        """Whether a function of the user failed in this thread."""
        return any(callback.failed for callback in self.ready.packed.specials.callbacks)

    def forget(self) -> None:
        """That it did."""
        for callback in self.ready.packed.specials.callbacks:
            callback.forget()

    @cached_property
    def outputs_count(self) -> bool:
        """Whether forces at outputs count in later steps: friction goes on from the last one, others may remember."""
        loads, sliding = self.ready.dynamics.loads, self.ready.dynamics.sliding
        switches = bool(loads.switch[0, SWITCHING] > 0.0)
        return switches or len(loads.friction) + len(loads.user) + len(sliding.rows) > 0

    @cached_property
    def outputs_alone(self) -> bool:
        """Whether nobody but measures reads outputs, and no evaluation goes on from that of an output.

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
    def arguments(self) -> tuple[Any, ...]:
        """dyn, scratch, state and settings of the integrator's loop, contacts, and Genevas."""
        if self.independent is not None:
            own = self.independent
            return own.arrays, own.scratch, own.own, own.settings, self.contacts, self.genevas
        return self.ready.dynamics, self.run.scratch, self.state, self.run.settings, self.contacts, self.genevas

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


@dataclass
class Base:
    """A run laid out in a block, which all others of its kind share."""

    run: SingleRun
    arguments: tuple[Any, ...]
    block: np.ndarray
    layout: Layout
    kind: tuple[Any, ...]
    fresh: np.ndarray
    """(1, N) the block before the first step."""


def based_on(run: SingleRun) -> Base:
    """Lay out a run that has not begun."""
    arguments, block, layout = laid_out(run.arguments)
    return Base(run, arguments, block, layout, run.kind, block[None].copy())


def single_run(m: Model, asked: Asked, reactive: bool = False) -> SingleRun:
    """Prepare it as ``simulate`` does; ``reactive``: measures read reactions, too.

    Raises what ``simulate`` raises, and NotCompiled.
    """
    if number_of(asked.integrator) is None:
        raise NotCompiled(f"method '{asked.integrator.name}' has no loop over many")
    times, events = asked.times, list(m.events.values())
    if events and asked.formulation == INDEPENDENT:
        raise NotCompiled("formulation='independent' does not know events")
    ready = prepare_dynamics(m, float(times[0]), float(times[-1]), contacts=True)
    if asked.formulation == INDEPENDENT and (ready.switches.contacts or ready.sticks):
        raise NotCompiled("formulation='independent' does not know contacts, limits and joints that stick")
    _refuse(ready)
    if reactive and ready.approaches:
        raise NotCompiled("reactions where the damping of a contact remembers how fast it approached")
    if reactive and ready.following.rows:
        raise NotCompiled("reactions where points are on curves that cross themselves")
    longest = asked.step or float(np.diff(times).max())
    run = Run(
        ready, asked.integrator, asked.tolerance, longest, float(times[-1] - times[0]), asked.options, asked.formulation
    )
    why = users_packing.why_not(events, run.settings.longest)
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
    why = repeated_packing.why_not(ready)
    if why is not None:
        raise NotCompiled(why)
    slow = [callback.what for callback in packed.specials.callbacks if not callback.compiled]
    if slow:
        raise NotCompiled(f"{slow[0]}: the function is one of Python; compile it with numba.njit")
    if ready.initial.velocities:
        raise NotCompiled("the start was made consistent: " + "; ".join(ready.initial.velocities))
