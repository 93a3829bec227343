"""A mechanism made ready for forward dynamics: arrays, independent rows, elimination sequence, consistent start.

States of forces start with given values, else with those of a steady state, as the kind of force says. A force whose
states do not follow from the motion alone, as the pressures behind a closed valve, carries what is there to be carried:
the effort e at which what it measures would not accelerate,

    x''(e) = 0     for all such forces at once;  x'' is linear in e, so one evaluation for each and one more tell it
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from mbsd.arrays.chambers import check_pistons
from mbsd.arrays.inertias import inertia_of, usual_inertia, weight_of
from mbsd.arrays.laws import compiled_laws, law_values, refuse_bad_laws
from mbsd.arrays.loads import pack_loads
from mbsd.arrays.packing import Packed, pack
from mbsd.arrays.states import columns_of, ones_of, widened, with_states
from mbsd.base.errors import MobilityError, ModelError
from mbsd.base.quantity import counted
from mbsd.dynamics.prepare.inertia import as_heavy_as_ground, lift_inertia, passes_for
from mbsd.dynamics.prepare.large import MANY_COORDINATES, blocks_of, consistent_large, independent_large
from mbsd.dynamics.prepare.prepared import PreparedDynamics
from mbsd.dynamics.prepare.refusals import refuse_pressed, refuse_singular_start, refuse_unheld
from mbsd.dynamics.reference.arrays import Dynamics
from mbsd.dynamics.reference.pins import with_pins
from mbsd.dynamics.reference.schur import elimination_sequence
from mbsd.dynamics.reference.sliding import sliding_for
from mbsd.dynamics.switches import Switches, friction_rows, joint_sticks, stuck_rows
from mbsd.kinematics.limits.contacts import all_contacts, with_contacts
from mbsd.kinematics.pose.initial import Initial, consistent
from mbsd.kinematics.pose.mobility import choose_clear_rows, joint_mobility, rows_at
from mbsd.model.mechanism import Model
from mbsd.results.measured import measured, measured_rate
from mbsd.results.views import Mobility

if TYPE_CHECKING:
    from mbsd.model.force import Element, Force, States

MOMENT = 1e-5
"""Step of the differences that give x'' (s)."""
USUAL = 10.0
"""An effort (N or N m) that is no rounding, for each kg of the mechanism."""
FAINT = 1e-9
"""Part of the largest change of x'' by an effort below which an effort moves nothing."""


def take_start_states(ready: PreparedDynamics) -> None:
    """Write the states at the start into its velocities."""
    holders = _holders(ready)
    count = len(holders)
    none = _measured_accelerations(ready, holders, np.zeros(count))
    usual = max(1.0, USUAL * float(ready.packed.system.mass.sum()))
    effects = np.array([_measured_accelerations(ready, holders, usual * unit) - none for unit in np.eye(count)]).T
    efforts = np.zeros(count)
    if np.isfinite(none).all() and np.isfinite(effects).all():
        efforts = usual * np.linalg.lstsq(effects, -none, rcond=FAINT)[0]
    _write(ready, holders, efforts)


class _Holder:
    """A force with states, and how it stands at the start."""

    def __init__(self, ready: PreparedDynamics, force: Force, i: int, j: int) -> None:
        assert force.kind.states is not None
        assert force.kind.along is not None
        self.force, self.i, self.j = force, i, j
        self.states: States = force.kind.states
        self.element: Element = force.kind.along(force)
        q, v = ready.initial.q[None], ready.initial.v[None]
        self.value = float(measured(ready.packed, self.element, i, j, q)[0])
        self.rate = float(measured_rate(ready.packed, self.element, i, j, q, v)[0])
        self.model = ready.packed.name
        values = law_values(ready.packed, ready.dynamics.laws, force, np.array([ready.start]))
        self.laws = {name: float(value[0]) for name, value in values.items()}

    def at(self, effort: float) -> list[float]:
        """The states under this effort."""
        return list(self.states.start(self.model, self.force, self.laws, self.value, self.rate, effort))


def _holders(ready: PreparedDynamics) -> list[_Holder]:
    packed = ready.packed
    return [
        _Holder(ready, force, int(i), int(j))
        for force, (i, j) in zip(packed.forces, packed.force_markers, strict=True)
        if force.kind.states is not None
    ]


def _write(ready: PreparedDynamics, holders: list[_Holder], efforts: np.ndarray) -> None:
    states = [value for holder, effort in zip(holders, efforts, strict=True) for value in holder.at(float(effort))]
    ready.initial.v[columns_of(ready.packed)] = np.array(states) / ones_of(ready.packed)


def _measured_accelerations(ready: PreparedDynamics, holders: list[_Holder], efforts: np.ndarray) -> np.ndarray:
    """(n,) x'' of what each holder measures, at the start, under their efforts (n,)."""
    packed = ready.packed
    _write(ready, holders, efforts)
    acceleration = ready.evaluate_start()[0][1]
    steps = MOMENT * np.array([-1.0, 1.0])[:, None]
    q = ready.initial.q + steps * ready.initial.v + 0.5 * steps**2 * acceleration
    v = ready.initial.v + steps * acceleration
    return np.array(
        [
            np.diff(measured_rate(packed, holder.element, holder.i, holder.j, q, v))[0] / (2.0 * MOMENT)
            for holder in holders
        ]
    )


REFINEMENTS = 3
"""Passes at least where inertia was lifted: the second takes off the lift, the third what rounding it enlarged."""


def prepare_dynamics(m: Model, start: float, end: float, contacts: bool = False) -> PreparedDynamics:
    """Check the model and find consistent initial conditions for a simulation from ``start`` to ``end`` (s).

    Without ``contacts``, contacts and limits are left out.
    """
    if len(m.bodies) < 2:
        raise ModelError(f"{m.name}: there is no body beside ground; add one with m.bar(...) or m.body(...)")
    packed = pack(m)
    packed.settle_laws(start, end)
    refuse_bad_laws(packed, start, end)
    inertia, usual = inertia_of(packed), usual_inertia(packed)
    large = packed.coordinates > MANY_COORDINATES
    initial = _initial(m, packed, start)
    kept, mobility = independent_large(packed, start, initial.q) if large else _rows(packed, initial.q)
    still = _still(packed, mobility) & (not m.events)  # their actions may release a joint
    per_size = 1.0 / np.concatenate([np.ones(3), packed.column_scale()])
    weights = as_heavy_as_ground(inertia, still, per_size)
    metric = np.where(still, usual, lift_inertia(packed, kept, initial.q, start, usual))
    lifted = np.where(still, np.maximum(usual, weights), metric)
    light = (inertia == 0) & ~still
    _refuse_superfluous_drivers(packed, mobility)
    switched = [*all_contacts(m, packed, initial.q), *stuck_rows(packed)] if contacts else []
    if switched:
        packed = with_contacts(m, packed, switched, initial.q)
    apart = passes_for(packed, start, initial.q, weights, per_size, still)
    weight = weight_of(packed)
    packed = with_states(packed)
    if packed.states:
        initial = replace(initial, q=widened(packed, initial.q), v=widened(packed, initial.v))
        weight, none = widened(packed, weight), np.ones(3 * packed.states)
        inertia, lifted, metric, usual = (np.concatenate([part, none]) for part in (inertia, lifted, metric, usual))
        light = np.concatenate([light, none == 0.0])
        per_size = 1.0 / np.concatenate([np.ones(3), packed.column_scale()])
    always = packed.contact_rows
    spare = set() if large else set(range(always)) - set(kept)
    planned = {*kept, *spare, *range(always, len(packed.ws.phi))}
    schur = elimination_sequence(packed.system.row_body, blocks_of(packed, planned))
    loads = pack_loads(packed)
    passes = max(apart, REFINEMENTS if light[3:].any() else 1)
    if not (spare or len(loads.friction) or passes > 1 or m.events):
        schur = with_pins(schur, packed.system, len(packed.system.row_body))
    sliding = sliding_for(friction_rows(packed), len(inertia), len(packed.ws.phi))
    switches = Switches(packed, schur.rows, spare)
    dynamics = Dynamics(
        system=packed.system,
        laws=compiled_laws(packed, start, end),
        loads=loads,
        schur=schur,
        sliding=sliding,
        inertia=inertia,
        inverse=_inverse(lifted),
        metric=_inverse(metric),
        weight=weight,
        passes=passes,
        baumgarte=np.zeros(2),
        per_size=per_size,
    )
    ready = PreparedDynamics(
        packed, dynamics, initial, start, end, mobility, switches, joint_sticks(packed, loads), masses_apart=apart > 1
    )
    refuse_singular_start(ready, list(kept), always)
    if light[3:].any():
        check_pistons(packed, np.array([start]), initial.q[None], tell=False)
        refuse_unheld(ready, usual)
    if packed.states:
        take_start_states(ready)
    refuse_pressed(m, start, end, prepare_dynamics)
    return ready


def started(m: Model, start: float, end: float, packed: Packed | None = None) -> tuple[Packed, Initial]:
    """A model that was prepared before, with other numbers: as arrays without contacts, and its start alone.

    ``packed``: the model as arrays without contacts, where they are known, with its laws settled.
    """
    if packed is None:
        packed = pack(m)
        packed.settle_laws(start, end)
    return packed, _initial(m, packed, start)


def _initial(m: Model, packed: Packed, start: float) -> Initial:
    return (consistent_large if packed.coordinates > MANY_COORDINATES else consistent)(m, packed, start)


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
    return choose_clear_rows(packed, q, rows_at(packed, q)), mobility


def _refuse_superfluous_drivers(packed: Packed, mobility: Mobility) -> None:
    drivers = len(packed.ws.phi) - packed.driver_rows
    if drivers > mobility.dof:
        raise MobilityError(
            f"{packed.name}: {counted(drivers, 'driver')} for {counted(mobility.dof, 'degree')} of freedom; "
            "remove a driver or free a joint"
        )
