"""A mechanism made ready for forward dynamics: arrays, independent rows, elimination sequence, consistent start."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from mbsd.arrays.chambers import check_pistons
from mbsd.arrays.driver_laws import refuse_bad_laws
from mbsd.arrays.inertias import inertia_of, usual_inertia
from mbsd.arrays.laws import compiled_laws
from mbsd.arrays.loads import pack_loads
from mbsd.arrays.packing import Packed, pack
from mbsd.arrays.states import widened, with_states
from mbsd.base.errors import MobilityError, ModelError
from mbsd.base.kept import Kept
from mbsd.dynamics.prepare.dependent import refuse_singular_start
from mbsd.dynamics.prepare.lent_inertia import lift_inertia
from mbsd.dynamics.prepare.mass_ratio import as_heavy_as_ground, passes_for
from mbsd.dynamics.prepare.prepared import PreparedDynamics
from mbsd.dynamics.prepare.pressed import refuse_pressed
from mbsd.dynamics.prepare.start_states import take_start_states
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
from mbsd.equations.assembly import residual_and_jacobian
from mbsd.kinematics.limits.contact_rows import all_contacts, with_contacts
from mbsd.kinematics.pose.initial import Initial, consistent
from mbsd.kinematics.pose.mobility import joint_mobility, rows_at
from mbsd.model.mechanism import Model
from mbsd.results.mobility import Mobility

REFINEMENTS = 3
"""Passes at least where inertia was lifted: the second takes off the lift, the third what rounding it enlarged."""
MOST_BLOCKS = 200
"""Up to so many pairs of rows their sequence is kept for the next simulation."""
LOOSE = 1e-9
"""Singular values of the scaled Jacobian below this part of the largest are zero."""
SHARE = 1e-3
"""Share of a coordinate in a motion of unit length; less is rounding."""
BALANCED = 1e-8
"""Part of the loads of joints on a coordinate without inertia that may stay unbalanced at the start; more means that
nothing holds it."""
SLIGHT = 1e-6
"""Accelerations of usual inertias below this (sizes or rad per s^2) are no load."""


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
        packed = with_contacts(m, packed, switched)
    apart = passes_for(packed, start, initial.q, weights, per_size, still)
    weight = (inertia.reshape(-1, 3) * [*packed.system.gravity, 0.0]).ravel()
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
    schur = _sequence(packed.system.row_body, blocks_of(packed, planned))
    loads = pack_loads(packed)
    passes = max(apart, REFINEMENTS if light[3:].any() else 1)
    if not (spare or len(loads.friction) or passes > 1 or m.events):
        schur = with_pins(schur, packed.system, len(packed.system.row_body))
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
        weight=weight,
        passes=passes,
        baumgarte=np.zeros(2),
        per_size=per_size,
    )
    ready = PreparedDynamics(
        packed,
        dynamics,
        initial,
        start,
        end,
        mobility,
        switches,
        joint_sticks(packed, loads, held),
        masses_apart=apart > 1,
    )
    refuse_singular_start(ready, list(kept), always)
    if light[3:].any():
        check_pistons(packed, np.array([start]), initial.q[None], tell=False)
        _refuse_unheld(ready, usual)
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


_SEQUENCES: Kept[Schur] = Kept()


def _sequence(row_body: np.ndarray, blocks: np.ndarray) -> Schur:
    """That of plan_schur, with rows of its own, as events change them."""
    key = row_body.tobytes(), blocks.tobytes()
    sequence = _SEQUENCES.get(key, lambda: plan_schur(row_body, blocks)[0]) if len(blocks) < MOST_BLOCKS else None
    return plan_schur(row_body, blocks)[0] if sequence is None else sequence._replace(rows=sequence.rows.copy())


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


def _refuse_unheld(ready: PreparedDynamics, reference: np.ndarray) -> None:
    """A coordinate without inertia that neither joints nor springs hold cannot balance its load.

    ``reference`` (3 nb,): inertias of usual size, to tell loads from rounding.
    """
    dynamics, packed = ready.dynamics, ready.packed
    _refuse_massless(packed, ready.mobility, ready.start, ready.initial.q)
    state = np.stack([ready.initial.q, ready.initial.v])
    out, lam = np.zeros_like(state), np.zeros(len(packed.ws.phi))
    scratch = scratch_for(dynamics, packed.ws, len(packed.motions), 1)
    derivative(dynamics, scratch, ready.start, state, out, lam)
    packed.specials.check()
    finite = np.isfinite(scratch.force[3:])
    if not finite.all():
        name = packed.body_names[1 + int(np.argmin(finite)) // 3]
        raise ModelError(
            f"{packed.name}: at t = {ready.start:.6g} s the load on body '{name}' is no finite number: look at the "
            "forces on it, and at where it starts"
        )
    left = np.abs(scratch.force - dynamics.inertia * out[1])
    carried = np.zeros_like(left)
    columns = 3 * packed.system.row_body[..., None] + np.arange(3)
    np.add.at(carried, columns, np.abs(packed.ws.jac.reshape(-1, 2, 3) * lam[:, None, None]))
    allowed = np.maximum(BALANCED * carried, SLIGHT * reference / dynamics.per_size)
    over = np.where(np.isfinite(left), left, np.inf) / np.where(allowed > 0.0, allowed, np.inf)
    if not np.isfinite(out).all() or (over[3:] > 1.0).any():
        worst = 3 + int(np.argmax(over[3:]))
        raise MobilityError(
            f"{packed.name}: body '{packed.body_names[worst // 3]}' has no inertia in "
            f"{('x', 'y', 'angle')[worst % 3]}, and nothing holds it there against a load of {left[worst]:.3g} "
            "(N or N m). Give it a mass and an inertia, or another joint."
        )


def _refuse_massless(packed: Packed, mobility: Mobility, start: float, q: np.ndarray) -> None:
    """Bodies without mass and inertia that can move while all that has any rests: no load tells how.

    Rows of contacts count as if they held, and the turning of point masses is none of theirs.
    """
    bare = np.flatnonzero((packed.system.mass == 0) & (packed.system.inertia == 0))
    free = [int(b) for b in bare if b > 0 and packed.body_names[b] in mobility.free_bodies]
    if not free or packed.coordinates > MANY_COORDINATES:
        return
    residual_and_jacobian(packed.system, q, packed.drives(np.array([start]))[0], packed.ws)
    scaled = packed.jacobian() * packed.row_scale()[:, None] * packed.column_scale()
    columns = np.concatenate([3 * (b - 1) + np.arange(3) for b in free])
    _u, size, basis = np.linalg.svd(scaled[:, columns])
    rank = int((size > LOOSE * max(1.0, float(size.max(initial=0.0)))).sum())
    moved = np.abs(basis[rank:]).max(axis=0, initial=0.0).reshape(-1, 3)
    loose = [packed.body_names[b] for b, most in zip(free, moved.max(axis=1), strict=True) if most > SHARE]
    if not loose:
        return
    names = " and ".join(f"'{name}'" for name in loose[:3]) + (f" and {len(loose) - 3} more" if len(loose) > 3 else "")
    has, it = ("have", "them") if len(loose) > 1 else ("has", "it")
    raise MobilityError(
        f"{packed.name}: {names} {has} neither mass nor inertia, and can move in {len(columns) - rank} "
        f"way{'s' * (len(columns) - rank > 1)} while all that has any rests, so that no load tells how. Give {it} a "
        f"mass and an inertia, m.change('{loose[0]}', mass=...), or hold {it} by a joint or a driver"
    )
