"""A mechanism that is ready for forward dynamics, as data: arrays, independent rows, elimination sequence, start."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property, partial
from typing import Any

import numpy as np

from mbsd.arrays.packing import Packed
from mbsd.base.errors import ModelError
from mbsd.compiling.jit import Often
from mbsd.dynamics import state as run_state
from mbsd.dynamics.integrators.kind import Integrator
from mbsd.dynamics.prepare.approaches import Approaches
from mbsd.dynamics.prepare.following import Following
from mbsd.dynamics.prepare.stops import Stops, stops_of
from mbsd.dynamics.reference.arrays import Dynamics, Scratch, scratch_for
from mbsd.dynamics.rows.joint_sticks import JointStick
from mbsd.dynamics.rows.switches import Switches
from mbsd.kinematics.pose.initial import Initial
from mbsd.results.mobility import Mobility

SMALLEST_STEP = 1e-13
"""Part of the longest step at which a run gives up."""
OUTPUTS_LONGEST = 25
"""A step covers this part of the duration at most, so that short loads are not stepped over."""
UNKNOWN = object()
"""Not looked for yet."""


@dataclass
class PreparedDynamics:
    """A mechanism that can be simulated over and over."""

    packed: Packed
    dynamics: Dynamics
    initial: Initial
    start: float
    end: float
    mobility: Mobility
    switches: Switches
    """The contacts and joints whose rows are released and held."""
    sticks: list[JointStick]
    """Joints that stick by events."""
    masses_apart: bool = False
    """Whether masses of connected bodies are so far apart that the equations of motion are solved several times."""
    advancing: dict[tuple[str, type], Often] = field(default_factory=dict)
    """The loops of integrators by name and formulation."""
    dropped: tuple[int, ...] = ()
    """Rows left out because they repeat others."""
    independent: Any = UNKNOWN
    """The mechanism in independent coordinates that suit its start, None where there are none.

    See independent/embedding.py.
    """

    def advance(self, method: Integrator, arrays: Any, *rest: Any) -> int:
        """Go on with ``method`` in reference coordinates (arrays: Dynamics) or in independent ones (Embedding)."""
        key = method.name, type(arrays)
        if key not in self.advancing:
            self.advancing[key] = Often(method.advance)
        advancing: Any = self.advancing[key]
        if self.approaches:
            advancing = partial(self.approaches.through, advancing)
        return self.stops.through(advancing, arrays, *rest)

    @property
    def is_switched(self) -> bool:
        """True if steps are looked at one by one: rows of J come and go, or points and wheels are followed."""
        return bool(self.switches.contacts or self.sticks or self.switches.spare or self.following)

    @cached_property
    def _sizes(self) -> np.ndarray:
        """(3 nb,) of a unit step of each coordinate."""
        return np.concatenate([np.ones(3), self.packed.column_scale()])

    @cached_property
    def following(self) -> Following:
        """The points on curves that cross themselves."""
        return Following(self.packed)

    @cached_property
    def approaches(self) -> Approaches:
        """How fast contacts approached when they began."""
        return Approaches(self.dynamics.loads)

    @cached_property
    def stops(self) -> Stops:
        """Where steps end because loads or laws jump or are short there."""
        loads, laws, initial = self.dynamics.loads, self.dynamics.laws, self.initial
        return stops_of(self.packed, loads, laws, self.start, self.end, initial.q, initial.v)

    def begun(self, times: np.ndarray) -> tuple[run_state.State, run_state.Output]:
        """A run at its consistent start, and room for its outputs."""
        self.following.settle(self.initial.q, self.initial.v)
        rows = len(self.packed.ws.phi)
        state = run_state.start_state(np.stack([self.initial.q, self.initial.v]), rows, float(times[0]))
        return state, run_state.output_for(times, len(self.initial.q), rows)

    def scratch(self, method: Integrator) -> Scratch:
        """Scratch for one run in reference coordinates."""
        return scratch_for(self.dynamics, self.packed.ws, len(self.packed.motions), method.stages, method.matrices)

    def refuse_method(self, method: Integrator) -> None:
        """Raise ModelError where the method cannot simulate this mechanism."""
        refusal = method.why_refused(self.dynamics)
        if refusal is not None:
            raise ModelError(f"{self.packed.name}: {refusal}")
        if self.approaches and not method.meets_switches:
            names = [
                force.name
                for force in self.packed.forces
                if any(interaction.remembers for interaction in force.kind.interactions(force, self.packed.masses))
            ]
            raise ModelError(
                f"{self.packed.name}: the damping of contact '{names[0]}' depends on how fast it approaches when it "
                f"begins, and the steps of '{method.name}' do not end there; take method='dop853', or damping= instead "
                "of restitution="
            )

    def settings(
        self, method: Integrator, tolerance: float, step: float, duration: float, options: Mapping[str, float]
    ) -> run_state.Settings:
        """Tolerances in the mechanism's own sizes. Raises ModelError for options that the method does not have."""
        allowed = self._sizes * tolerance
        numbers = method.numbers(self.packed.name, options)
        shortest = [force.params.get("shortest") for force in self.packed.forces if "function" in force.params]
        longest = min([float(duration) / OUTPUTS_LONGEST, *(length for length in shortest if length)])
        growing = np.full((2, len(allowed)), tolerance)
        growing[0, 2::3] = 0.0
        return run_state.Settings(
            np.array([allowed, allowed]),
            float(tolerance),
            growing,
            longest,
            SMALLEST_STEP * longest,
            float(step),
            numbers,
        )
