"""A mechanism made ready for forward dynamics: arrays, independent rows, elimination sequence, consistent start."""

from __future__ import annotations

import numpy as np

from mbsd.arrays.laws import compiled_laws
from mbsd.arrays.loads import pack_loads
from mbsd.arrays.packing import Packed, pack
from mbsd.base.errors import MobilityError, ModelError
from mbsd.base.kept import Kept
from mbsd.dynamics.prepare.dependent import refuse_singular_start
from mbsd.dynamics.prepare.prepared import PreparedDynamics
from mbsd.dynamics.reference.acceleration import derivative
from mbsd.dynamics.reference.arrays import Dynamics, scratch_for
from mbsd.dynamics.reference.pins import with_pins
from mbsd.dynamics.reference.schur import Schur
from mbsd.dynamics.reference.sequence import plan_schur
from mbsd.dynamics.reference.sliding import sliding_for
from mbsd.dynamics.rows.held import Held
from mbsd.dynamics.rows.joint_sticks import joint_sticks, stuck_rows
from mbsd.dynamics.rows.switches import Switches, friction_rows
from mbsd.dynamics.start.large import MANY_COORDINATES, blocks_of, consistent_large, independent_large
from mbsd.kinematics.limits.contact_rows import all_contacts, with_contacts
from mbsd.kinematics.pose.initial import consistent
from mbsd.kinematics.pose.mobility import joint_mobility, rows_at
from mbsd.kinematics.prepared import refuse_bad_laws
from mbsd.model.mechanism import Model
from mbsd.results.mobility import Mobility

LIFT = 1e-7
"""Inertia given to coordinates without any, as part of a usual one, and refined away."""
REFINEMENTS = 4
"""Passes that solve the equations of motion where inertia was lifted."""
BALANCED = 1e-8
"""Part of the largest load that may stay unbalanced at the start; more means a massless body that nothing holds."""
MOST_BLOCKS = 200
"""Up to so many pairs of rows their sequence is kept for the next simulation."""
SLIGHT = 1e-6
"""Accelerations below this (sizes per s^2) are no load."""


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
    schur = _sequence(packed.system.row_body, blocks_of(packed, planned))
    loads = pack_loads(packed)
    if not (spare or len(loads.friction) or light[3:].any() or m.events):
        schur = with_pins(schur, packed.system)
    sliding = sliding_for(friction_rows(packed), len(inertia), len(packed.ws.phi))
    held = Held.of(schur, packed.ws, sliding, loads)
    switches = Switches(packed, held, spare)
    dynamics = Dynamics(
        system=packed.system,
        laws=compiled_laws(packed, start, end),
        loads=loads,
        schur=schur,
        sliding=sliding,
        inertia=inertia,
        inverse=_inverse(lifted),
        metric=_inverse(metric),
        weight=(inertia.reshape(-1, 3) * [*packed.system.gravity, 0.0]).ravel(),
        passes=REFINEMENTS if light[3:].any() else 1,
        baumgarte=np.zeros(2),
        per_size=1.0 / np.concatenate([np.ones(3), packed.column_scale()]),
    )
    ready = PreparedDynamics(
        packed, dynamics, initial, start, end, mobility, switches, joint_sticks(packed, loads, held)
    )
    refuse_singular_start(ready, list(kept), always)
    _refuse_unheld(ready)
    return ready


_SEQUENCES: Kept[Schur] = Kept()


def _sequence(row_body: np.ndarray, blocks: np.ndarray) -> Schur:
    """That of plan_schur, with rows of its own, as events change them."""
    key = row_body.tobytes(), blocks.tobytes()
    found = _SEQUENCES.get(key, lambda: plan_schur(row_body, blocks)[0]) if len(blocks) < MOST_BLOCKS else None
    return plan_schur(row_body, blocks)[0] if found is None else found._replace(rows=found.rows.copy())


def _inertias(packed: Packed) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """(3 nb,) M; M lifted a little where it is zero; M with a usual inertia there."""
    system = packed.system
    inertia = system.mass.repeat(3)
    inertia[2::3] = system.inertia
    mass = float(system.mass.max()) or 1.0
    usual = np.full(len(inertia), mass)
    usual[2::3] = mass * packed.size**2
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
    return rows_at(packed, q), mobility


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
