"""A run: an integrator with its tolerances over a prepared mechanism, and what it records.

It is made of steps: in reference coordinates (steps.py), in independent ones or carried by these across singular poses
(motion.py), or from event to event (mbsd/dynamics/events/).
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property, partial
from typing import Any

import numpy as np

from mbsd.base.errors import ModelError
from mbsd.dynamics.integrators.kind import INTEGRATORS, Integrator
from mbsd.dynamics.prepare.prepare import prepare_dynamics
from mbsd.dynamics.prepare.prepared import Approaches, PreparedDynamics
from mbsd.dynamics.reference.arrays import Scratch, scratch_for
from mbsd.dynamics.state import Output, Settings
from mbsd.model.event import Happening
from mbsd.model.mechanism import Model


@dataclass
class Snapshot:
    """A state with all that events had changed, from which a run can go on."""

    y: np.ndarray
    """(2, 3 nb)"""
    time: float
    work: float
    held: tuple[np.ndarray, ...] = ()
    """Arrays that events change."""
    released: frozenset[int] = frozenset()
    """Rows of joints that are released for good."""


@dataclass
class Recording:
    """The outputs of a run and what belongs to them."""

    out: Output
    held: np.ndarray
    """(T, m) which rows held at each output."""
    steps: int
    happenings: list[Happening] = field(default_factory=list)
    snapshots: list[Snapshot] = field(default_factory=list)
    approaches: Approaches | None = None
    """How fast contacts approached; None where none asks."""
    independent: bool = False
    """Integrated in independent coordinates; multipliers and margins are still to be found."""
    pairs: np.ndarray | None = None
    """(T, o) pairs of outlines at each output, codes by rows of ``pair_rows``; None without outlines."""

    def only(self, outputs: np.ndarray) -> Recording:
        """The same with some of its outputs alone, by a mask (T,): those from which a run may go on."""
        pairs = None if self.pairs is None else self.pairs[outputs]
        out = Output(*(part[outputs] for part in self.out))
        return replace(self, out=out, held=self.held[outputs], pairs=pairs)


AUTO, REFERENCE, INDEPENDENT = FORMULATIONS = "auto", "reference", "independent"
"""Coordinates that are integrated; "auto" takes independent ones where it can."""
STEPS_AT_ONCE = 2000
"""Between two looks, of small mechanisms."""
WORK_AT_ONCE = 3e6
"""Coordinates times evaluations between two looks: a fraction of a second."""
SMALLEST_STEP = 1e-13
"""Part of the longest step at which a run gives up."""
OUTPUTS_LONGEST = 25
"""A step covers this part of the duration at most, so that short loads are not stepped over."""
EVALUATIONS = 12
"""Number of evaluations of a step."""


def steps_at_once(coordinates: int, matrices: bool) -> int:
    """Steps for one call of a compiled loop, so that it comes back within a second or so."""
    work = max(coordinates, 1) * (EVALUATIONS + (6 * coordinates if matrices else 0))
    return int(min(max(WORK_AT_ONCE / work, 1), STEPS_AT_ONCE))


@dataclass(frozen=True)
class Request:
    """How a mechanism is simulated; see :func:`mbsd.dynamics.simulate.request_for`."""

    times: np.ndarray
    """(T,) s."""
    integrator: Integrator
    tolerance: float
    step: float | None
    formulation: str
    options: Mapping[str, float]


class Run:
    """Everything that the steps of a run share."""

    def __init__(
        self,
        ready: PreparedDynamics,
        method: Integrator,
        tolerance: float,
        step: float,
        duration: float,
        options: Mapping[str, float],
        formulation: str = AUTO,
    ) -> None:
        self.ready = ready
        self.formulation = formulation
        self.method = method
        self.tolerance = tolerance
        self.steps_at_once = steps_at_once(ready.packed.coordinates, method.matrices[0] > 0)
        self.contacts: Any = None
        """Arrays of contacts and events for the loop, once it has met some; the same ones whenever the run goes on."""
        self._refuse_method()
        self.settings = self._settings(step, duration, options)

    @cached_property
    def passing(self) -> Run:
        """This run, or where its method knows no independent coordinates one that passes singular poses."""
        if self.method.independent:
            return self
        settings = self.settings
        duration = OUTPUTS_LONGEST * settings.longest
        return Run(self.ready, INTEGRATORS["dop853"], self.tolerance, settings.step, duration, {})

    @cached_property
    def scratch(self) -> Scratch:
        """Scratch in reference coordinates."""
        packed = self.ready.packed
        return scratch_for(
            self.ready.dynamics, packed.ws, len(packed.motions), self.method.stages, self.method.matrices
        )

    def advance(self, arrays: Any, *rest: Any) -> int:
        """Go on in reference coordinates (arrays: Dynamics) or in independent ones (Embedding); return a status."""
        ready = self.ready
        advancing: Any = ready.loop((self.method.name, type(arrays)), self.method.advance)
        if ready.approaches:
            advancing = partial(ready.approaches.through, advancing)
        return ready.stops.through(advancing, arrays, *rest)

    def _refuse_method(self) -> None:
        """Raise ModelError where the method cannot simulate this mechanism."""
        method, packed = self.method, self.ready.packed
        refusal = method.why_refused(self.ready.dynamics)
        if refusal is not None:
            raise ModelError(f"{packed.name}: {refusal}")
        if self.ready.approaches and not method.meets_switches:
            names = [
                force.name
                for force in packed.forces
                if any(interaction.remembers for interaction in force.kind.interactions(force, packed.masses))
            ]
            raise ModelError(
                f"{packed.name}: the damping of contact '{names[0]}' depends on how fast it approaches when it "
                f"begins, and the steps of '{method.name}' do not end there; take method='dop853', or damping= instead "
                "of restitution="
            )

    def _settings(self, step: float, duration: float, options: Mapping[str, float]) -> Settings:
        """Return tolerances in the mechanism's own sizes. Raises ModelError for options that the method lacks."""
        packed = self.ready.packed
        allowed = np.concatenate([np.ones(3), packed.column_scale()]) * self.tolerance
        shortest = [force.params.get("shortest") for force in packed.forces if "function" in force.params]
        longest = min([float(duration) / OUTPUTS_LONGEST, *(length for length in shortest if length)])
        growing = np.full((2, len(allowed)), self.tolerance)
        growing[0, 2::3] = 0.0
        return Settings(
            np.array([allowed, allowed]), float(self.tolerance), growing, longest, SMALLEST_STEP * longest, float(step),
            self.method.numbers(packed.name, options),
        )  # fmt: skip


def run_of(m: Model, request: Request, ready: PreparedDynamics | None = None) -> Run:
    """Return the run of a mechanism that is made ready for it, if it is not yet. Raises what ``simulate`` raises."""
    times, formulation = request.times, request.formulation
    start, end = float(times[0]), float(times[-1])
    ready = ready or prepare_dynamics(m, start, end, contacts=True)
    longest = request.step or float(np.diff(times).max())
    run = Run(ready, request.integrator, request.tolerance, longest, end - start, request.options, formulation)
    if formulation == INDEPENDENT and (m.events or ready.switches.contacts or ready.sticks):
        raise ModelError(
            f"{m.name}: formulation='independent' does not know events, contacts, limits and joints that stick"
        )
    return run
