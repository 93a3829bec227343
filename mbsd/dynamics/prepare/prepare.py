"""A mechanism made ready for forward dynamics: arrays, independent rows, elimination sequence, consistent start."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import cached_property, partial
from typing import TYPE_CHECKING, Any

import numpy as np

from mbsd.arrays.laws import compiled_laws
from mbsd.arrays.loads import pack_loads
from mbsd.arrays.packing import Packed, pack
from mbsd.base.errors import MobilityError, ModelError
from mbsd.compiling.jit import Often
from mbsd.dynamics import state as run_state
from mbsd.dynamics.integrators.kind import Integrator
from mbsd.dynamics.prepare.dependent import refuse_singular_start
from mbsd.dynamics.prepare.stops import Stops, stops_of
from mbsd.dynamics.reference.acceleration import derivative
from mbsd.dynamics.reference.arrays import Dynamics, Scratch, scratch_for
from mbsd.dynamics.reference.schur import plan_schur
from mbsd.dynamics.reference.sliding import sliding_for
from mbsd.dynamics.rows.joint_sticks import JointStick, joint_sticks, stuck_rows
from mbsd.dynamics.rows.switches import Switches
from mbsd.dynamics.runs.following import Following
from mbsd.dynamics.runs.run import AUTO, Run
from mbsd.dynamics.start.large import MANY_COORDINATES, blocks_of, consistent_large, independent_large
from mbsd.kinematics.contact_rows import all_contacts, with_contacts
from mbsd.kinematics.pose.initial import Initial, consistent
from mbsd.kinematics.pose.mobility import independent_rows, joint_mobility, scaled_jacobian
from mbsd.kinematics.prepared import refuse_bad_laws
from mbsd.model.mechanism import Model
from mbsd.results.mobility import Mobility

if TYPE_CHECKING:
    from mbsd.dynamics.runs.embed import Embedded

LIFT = 1e-7
"""Inertia given to coordinates without any, as part of a usual one, and refined away."""
REFINEMENTS = 4
"""Passes that solve the equations of motion where inertia was lifted."""
BALANCED = 1e-8
"""Part of the largest load that may stay unbalanced at the start; more means a massless body that nothing holds."""
SLIGHT = 1e-6
"""Accelerations below this (sizes per s^2) are no load."""
SMALLEST_STEP = 1e-13
"""Part of the longest step at which a run gives up."""
OUTPUTS_LONGEST = 25
"""A step covers this part of the duration at most, so that short loads are not stepped over."""


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
    """Contacts and joints whose rows are let go and taken up."""
    sticks: list[JointStick]
    """Joints that stick by events."""
    advancing: dict[tuple[str, type], Often] = field(default_factory=dict)
    """The loops of integrators by name and formulation."""
    dropped: tuple[int, ...] = ()
    """Rows left out because they repeat others."""

    def run(
        self,
        method: Integrator,
        times: np.ndarray,
        tolerance: float,
        step: float,
        progress: Callable[[float], None] | None = None,
        options: Mapping[str, float] | None = None,
        formulation: str = AUTO,
    ) -> tuple[run_state.State, run_state.Output]:
        """Integrate to the last of ``times`` (s), which begin with the start; no events. Raises SimulationError."""
        state, out = self.begun(times)
        run = Run(self, method, tolerance, step, float(times[-1] - times[0]), options or {}, formulation)
        run.to_end(state, out, progress)
        return state, out

    def advance(self, method: Integrator, arrays: Any, *rest: Any) -> int:
        """Go on with ``method`` in reference coordinates (arrays: Dynamics) or in independent ones (Embedding)."""
        key = method.name, type(arrays)
        if key not in self.advancing:
            chosen = method.advance if isinstance(arrays, Dynamics) else method.independent
            assert chosen is not None, method.name
            self.advancing[key] = Often(chosen)
        advancing = self.advancing[key]
        if self.following and isinstance(arrays, Dynamics):
            return self.following.through(partial(self.stops.through, advancing), arrays, *rest)
        return self.stops.through(advancing, arrays, *rest)

    @cached_property
    def following(self) -> Following:
        """The points on curves that cross themselves."""
        return Following(self.packed)

    @cached_property
    def stops(self) -> Stops:
        """Where steps end because loads or laws jump or are short there."""
        loads, laws, initial = self.dynamics.loads, self.dynamics.laws, self.initial
        return stops_of(self.packed, loads, laws, self.start, self.end, initial.q, initial.v)

    @cached_property
    def embedded(self) -> Embedded | None:
        """The mechanism in independent coordinates that suit its start, or None where there are none."""
        from mbsd.dynamics.runs.embed import can_embed, embed

        return None if can_embed(self) else embed(self, self.initial.q, self.initial.v, self.start)

    def begun(self, times: np.ndarray) -> tuple[run_state.State, run_state.Output]:
        """A run at its consistent start, and room for its outputs."""
        self.following.settle(self.initial.q, self.initial.v)
        rows = len(self.packed.ws.phi)
        state = run_state.start_state(np.stack([self.initial.q, self.initial.v]), rows, float(times[0]))
        return state, run_state.output_for(times, len(self.initial.q), rows)

    def scratch(self, method: Integrator) -> Scratch:
        """Scratch for one run. Raises ModelError where the method cannot simulate this mechanism."""
        refusal = method.refusal(self.dynamics)
        if refusal is not None:
            raise ModelError(f"{self.packed.name}: {refusal}")
        return scratch_for(self.dynamics, self.packed.ws, len(self.packed.motions), method.stages, method.matrices)

    def settings(
        self, method: Integrator, tolerance: float, step: float, duration: float, options: Mapping[str, float]
    ) -> run_state.Settings:
        """Tolerances in the mechanism's own sizes. Raises ModelError for options that the method does not have."""
        one = np.concatenate([np.ones(3), self.packed.column_scale()]) * tolerance
        numbers = method.numbers(self.packed.name, options)
        shortest = [force.params.get("shortest") for force in self.packed.forces if "function" in force.params]
        longest = min([float(duration) / OUTPUTS_LONGEST, *(length for length in shortest if length)])
        growing = np.stack([np.where(np.arange(len(one)) % 3 == 2, 0.0, tolerance), np.full(len(one), tolerance)])
        return run_state.Settings(
            np.stack([one, one]), float(tolerance), growing, longest, SMALLEST_STEP * longest, float(step), numbers
        )


def prepare_dynamics(m: Model, start: float, end: float, contacts: bool = False) -> PreparedDynamics:
    """Check the model and find consistent initial conditions for a simulation from ``start`` to ``end`` (s).

    Without ``contacts``, contacts and limits are left out.
    """
    if len(m.bodies) < 2:
        raise ModelError(f"{m.name}: there is no body beside ground; add one with m.bar(...) or m.body(...)")
    packed = pack(m)
    packed.settle_laws(start, end)
    refuse_bad_laws(packed, start, end)
    inertia, lifted, metric = _inertias(packed)
    large = packed.coordinates > MANY_COORDINATES
    initial = (consistent_large if large else consistent)(m, packed, start, _inverse(metric))
    kept, mobility = independent_large(packed, start, initial.q) if large else _rows(packed, initial.q)
    if not m.events:  # their actions may release a joint
        still = _still(packed, mobility)
        lifted = np.where(still, metric, lifted)
        light = (inertia == 0) & ~still
    else:
        light = inertia == 0
    _refuse_superfluous_drivers(packed, mobility)
    switched = [*all_contacts(m, packed, initial.q), *stuck_rows(packed)] if contacts else []
    if switched:
        packed = with_contacts(m, packed, switched)
    always = packed.contact_rows
    spare = set() if large else set(range(always)) - set(kept)
    planned = {*kept, *spare, *range(always, len(packed.ws.phi))}
    schur, _ = plan_schur(packed.system.row_body, blocks_of(packed, planned))
    switches = Switches(packed, schur, spare)
    loads = pack_loads(packed)
    dynamics = Dynamics(
        system=packed.system,
        laws=compiled_laws(packed, start, end),
        loads=loads,
        schur=schur,
        sliding=sliding_for(switches.friction_rows, len(inertia), len(packed.ws.phi)),
        inertia=inertia,
        inverse=_inverse(lifted),
        metric=_inverse(metric),
        weight=inertia * np.tile([*packed.system.gravity, 0.0], len(packed.body_names)),
        passes=REFINEMENTS if light[3:].any() else 1,
        baumgarte=np.zeros(2),
        per_size=1.0 / np.concatenate([np.ones(3), packed.column_scale()]),
    )
    ready = PreparedDynamics(packed, dynamics, initial, start, end, mobility, switches, joint_sticks(packed, loads))
    refuse_singular_start(ready, list(kept), always)
    _refuse_unheld(ready)
    return ready


def _inertias(packed: Packed) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """(3 nb,) M; M lifted a little where it is zero; M with a usual inertia there."""
    system = packed.system
    inertia = np.stack([system.mass, system.mass, system.inertia], axis=1).ravel()
    mass = float(system.mass.max()) or 1.0
    usual = np.tile([mass, mass, mass * packed.size**2], len(system.mass))
    return inertia, np.where(inertia > 0, inertia, LIFT * usual), np.where(inertia > 0, inertia, usual)


def _still(packed: Packed, mobility: Mobility) -> np.ndarray:
    """(3 nb,) coordinates of bodies that joints hold to ground: any inertia serves there, as they do not accelerate."""
    still = [name not in mobility.free_bodies for name in packed.body_names]
    return np.repeat(still, 3)


def _inverse(inertia: np.ndarray) -> np.ndarray:
    out = 1.0 / inertia
    out[:3] = 0.0
    return out


def _rows(packed: Packed, q: np.ndarray) -> tuple[list[int], Mobility]:
    """Independent rows, those of joints before those of drivers."""
    mobility = joint_mobility(packed, q)
    return independent_rows(scaled_jacobian(packed, q)), mobility


def _refuse_superfluous_drivers(packed: Packed, mobility: Mobility) -> None:
    drivers = len(packed.ws.phi) - packed.driver_rows
    if drivers > mobility.dof:
        raise MobilityError(
            f"{packed.name}: {drivers} drivers for {mobility.dof} degree{'s' * (mobility.dof != 1)} of freedom; "
            "remove a driver or free a joint"
        )


def _refuse_unheld(ready: PreparedDynamics) -> None:
    """A coordinate without inertia that neither joints nor springs hold cannot balance its load."""
    dynamics, packed = ready.dynamics, ready.packed
    if dynamics.passes == 1:
        return
    state = np.stack([ready.initial.q, ready.initial.v])
    out, lam = np.zeros_like(state), np.zeros(len(packed.ws.phi))
    scratch = scratch_for(dynamics, packed.ws, len(packed.motions), 1)
    derivative(dynamics, scratch, ready.start, state, out, lam)
    packed.specials.check()
    left = np.abs(scratch.force - dynamics.inertia * out[1])[3:]
    faint = SLIGHT * (float(packed.system.mass.max()) or 1.0) * packed.size
    largest = max(float(np.abs(dynamics.weight[3:]).max()), float(np.abs(dynamics.inertia * out[1]).max()), faint)
    if not np.isfinite(out).all() or (left > BALANCED * largest * packed.size).any():
        worst = int(np.nanargmax(np.where(np.isfinite(left), left, np.inf)))
        raise MobilityError(
            f"{packed.name}: body '{packed.body_names[1 + worst // 3]}' has no inertia in "
            f"{('x', 'y', 'angle')[worst % 3]}, and nothing holds it there against a load of {left[worst]:.3g} "
            "(N or N m). Give it a mass and an inertia, or another joint."
        )
