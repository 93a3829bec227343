"""Consistent start, independent rows and mobility of large mechanisms, in time proportional to their size.

Dense rank decisions and least-norm steps grow with the cube of the unknowns; here the same is done with the Schur
complement of the dynamics, which follows the mechanism's graph:

    pose         q -= W J^T (J W J^T)^-1 Phi, repeated with limited steps
    velocities   the projection of the given ones; what was given weighs HEAVY times more than what was not
                 (given values that contradict each other share the change, instead of the first one winning)
    rows         a row whose pivot elimination reduces to nearly nothing repeats the others, and is left out

Source: Haug 1989, ch. 6; the pivots are those of a Cholesky factor of J W J^T, so a row counts as dependent where less
than the square root of DEPENDENT of it is new.
"""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from mbsd.arrays.inertias import inertia_of, usual_inertia
from mbsd.arrays.laws import pack_laws
from mbsd.arrays.loads import pack_loads
from mbsd.arrays.packing import Packed, pack
from mbsd.arrays.starts import copied, take_force_phases
from mbsd.base.errors import AssemblyError
from mbsd.dynamics.reference.arrays import Dynamics, scratch_for
from mbsd.dynamics.reference.projection import factor_at, project
from mbsd.dynamics.reference.schur import plan_schur
from mbsd.dynamics.reference.sliding import sliding_for
from mbsd.kinematics.pose.close import (
    CLOSED,
    LONGEST_STEP,
    assemble,
    given_coordinates,
    nearest_turn,
    rough_pose,
    unwind_angles,
    why_open,
)
from mbsd.kinematics.pose.ideal_joints import closed_ideally
from mbsd.kinematics.pose.initial import Initial, given_velocities, tell_coordinates
from mbsd.kinematics.pose.mobility import joint_mobility
from mbsd.kinematics.pose.phases import active_rows, let_phases_go, refuse_impossible, take_decided, take_phases
from mbsd.model.mechanism import Model
from mbsd.results.views import Mobility

MANY_COORDINATES = 600
"""From here on a mechanism counts as large."""
NEGLIGIBLE = 1e-7
"""Part of a usual inertia that coordinates without any weigh."""
HEAVY = 1e8
"""How much more a given coordinate weighs than a free one."""
DEPENDENT = 1e-13
"""Least part of a squared row that must be new."""
MOST_STEPS = 60
NEARBY = 0.02
"""How far poses near the start are moved before they are closed (sizes, rad)."""


def blocks_of(packed: Packed, kept: set[int]) -> np.ndarray:
    """(B, 2) kept rows in pairs of one joint; -1 where there is no second."""
    blocks = []
    for joint in range(len(packed.joints)):
        rows = [row for row in packed.rows_of(joint) if row in kept]
        blocks += [(rows[k], rows[k + 1] if k + 1 < len(rows) else -1) for k in range(0, len(rows), 2)]
    return np.array(blocks, np.int64).reshape(-1, 2)


def consistent_large(m: Model, packed: Packed, time: float) -> Initial:
    """As mbsd.kinematics.pose.initial.consistent. Raises AssemblyError."""
    inertia = inertia_of(packed)
    inverse = 1.0 / np.where(inertia > 0.0, inertia, NEGLIGIBLE * usual_inertia(packed))
    inverse[:3] = 0.0
    initial, _ = closed_ideally(m, packed, lambda own, whole: _consistent(own, whole, time, inverse))
    take_force_phases(packed, initial.q)
    return initial


def _consistent(m: Model, packed: Packed, time: float, inverse: np.ndarray) -> Initial:
    """The same of a mechanism whose joints are all there."""
    drive = packed.drives(np.array([time]))[0]
    rough = rough_pose(m, packed, drive, 0)
    unwind_angles(packed, rough)
    given = given_coordinates(m, packed)
    size = np.concatenate([np.ones(3), packed.column_scale()])
    light = size**2
    light[:3] = 0.0
    let_phases_go(packed)
    weights = _weighed(light, [c for c, _ in given])
    q = _close(m, packed, time, rough, weights, light)
    refuse_impossible(packed, q)
    if take_phases(packed, q, drive):
        q = _close(m, packed, time, q, weights, light)
    deviations = tell_coordinates(packed, q, [(c, nearest_turn(q, c, value)) for c, value in given])
    rows, values, names = given_velocities(m, packed, q)
    v = _velocities(packed, time, q, inverse, rows, values)
    fastest = max(float(np.abs(values).max(initial=0.0)), float(np.abs(drive[:, 1]).max(initial=0.0)), 1e-300)
    slips = [
        f"{name} is {value_now:.6g} {unit}, not {value:.6g}"
        for value_now, value, (name, unit) in zip(_along(rows, v), values, names, strict=True)
        if abs(value_now - value) > 1e-6 * fastest
    ]
    return Initial(q, v, tuple(deviations), tuple(slips))


def _along(rows: list[dict[int, float]], v: np.ndarray) -> list[float]:
    return [sum(factor * v[c] for c, factor in row.items()) for row in rows]


def _weighed(inverse: np.ndarray, heavy: list[int]) -> np.ndarray:
    out = inverse.copy()
    out[heavy] /= HEAVY
    return out


def _projector(packed: Packed, time: float, inverse: np.ndarray) -> Dynamics:
    """All rows that take part, with ``inverse`` as metric."""
    schur, _ = plan_schur(packed.system.row_body, blocks_of(packed, active_rows(packed)))
    laws = pack_laws([law.compiled(time, time) for law in packed.motions])
    size = np.concatenate([np.ones(3), packed.column_scale()])
    nothing = np.zeros_like(inverse)
    return Dynamics(
        system=packed.system,
        laws=laws,
        loads=pack_loads(packed),
        schur=schur,
        sliding=sliding_for(np.zeros((0, 2)), len(inverse), len(packed.ws.phi)),
        inertia=nothing,
        inverse=inverse,
        metric=inverse,
        weight=nothing,
        passes=1,
        baumgarte=np.zeros(2),
        per_size=1.0 / size,
    )


def _close(
    m: Model, packed: Packed, time: float, rough: np.ndarray, weights: np.ndarray, light: np.ndarray
) -> np.ndarray:
    """A closed pose near ``rough``, by ``weights``; given values that contradict each other stall it, and ``light``,
    which weighs all alike, takes over."""
    q = rough
    for metric in (weights, light):
        nearer, worst = _nearer(packed, time, q, metric)
        if worst <= CLOSED:
            return nearer
        q = nearer if np.isfinite(nearer).all() else q
    raise AssemblyError(why_open(m, packed, q, packed.drives(np.array([time]))[0], time))


def _nearer(packed: Packed, time: float, rough: np.ndarray, inverse: np.ndarray) -> tuple[np.ndarray, float]:
    """The last pose of the search, and its largest residual (dimensionless)."""
    projector = _projector(packed, time, inverse)
    scratch = scratch_for(projector, packed.ws, len(packed.motions), 1)
    state = np.stack([rough, np.zeros_like(rough)])
    scale = packed.row_scale()
    worst = math.inf
    for _ in range(MOST_STEPS):
        moved = state.copy()
        project(projector, scratch, time, moved, 1)
        worst = float(np.abs(packed.ws.phi * scale).max(initial=0.0))  # of the pose before this step
        if worst <= CLOSED * 1e-3 or not math.isfinite(worst):
            break
        longest = float(scratch.report[2])
        state[0] += (moved[0] - state[0]) * min(1.0, LONGEST_STEP / longest if longest > 0 else 1.0)
    return state[0], worst


def _velocities(
    packed: Packed, time: float, q: np.ndarray, inverse: np.ndarray, rows: list[dict[int, float]], values: np.ndarray
) -> np.ndarray:
    """Projected velocities; the gaps to the given values are added again until they vanish or no longer shrink.

    At last all weigh alike: what given values that contradict each other left over goes.
    """
    projector = _projector(packed, time, _weighed(inverse, sorted({c for row in rows for c in row})))
    scratch = scratch_for(projector, packed.ws, len(packed.motions), 1)
    wish = np.zeros_like(q)
    state = np.stack([q, wish])
    last = math.inf
    for _ in range(8):
        for row, value, now in zip(rows, values, _along(rows, state[1]), strict=True):
            own = next(iter(row))
            wish[own] += value - now
        state = np.stack([q, wish])
        project(projector, scratch, time, state, 1)
        gap = float(np.abs(np.array(_along(rows, state[1])) - values).max(initial=0.0))
        if gap == 0.0 or not gap < 0.5 * last:
            break
        last = gap
        wish = state[1].copy()
    projector = _projector(packed, time, inverse)
    project(projector, scratch_for(projector, packed.ws, len(packed.motions), 1), time, state, 2)
    return state[1]


def independent_large(packed: Packed, time: float, q: np.ndarray) -> tuple[list[int], Mobility]:
    """Independent rows at a closed pose q (3 nb,), and the mobility they leave."""
    size = np.concatenate([np.zeros(3), packed.column_scale()])
    projector = _projector(packed, time, size**2)
    scratch = scratch_for(projector, packed.ws, len(packed.motions), 1)
    rows = projector.schur.rows
    dropped: list[int] = []
    while True:
        factor_at(projector, scratch, time, np.stack([q, np.zeros_like(q)]))
        new = scratch.factors.low[: len(rows), 1:3]
        weak = np.argwhere(~(new > DEPENDENT) & (rows >= 0))
        if not len(weak):
            break
        k, s = weak[0]
        dropped.append(int(rows[k, s]))
        rows[k, s] = -1
    kept = sorted(set(range(len(packed.ws.phi))) - set(dropped))
    lost = [row for row in dropped if row < packed.driver_rows]
    nominal = packed.coordinates - packed.driver_rows
    names = tuple(dict.fromkeys(packed.joint_of_row(row).name for row in sorted(lost)))
    moving = tuple(packed.body_names[1:]) if nominal + len(lost) > 0 else ()
    return kept, Mobility(nominal, nominal + len(lost), len(lost), names, False, moving)


def mobility_large(m: Model, packed: Packed) -> Mobility:
    """As mbsd.kinematics.pose.mobility.mobility: at the start, and at closed poses near it without the drivers."""
    light = np.concatenate([np.zeros(3), packed.column_scale() ** 2])
    q = consistent_large(m, packed, 0.0).q
    free = copied(m)
    free.drivers = {}
    joints = pack(free)
    take_decided(joints, packed)
    mobility = independent_large(joints, 0.0, q)[1]
    random = np.random.default_rng(1)
    for k in range(12):
        if k > 1 and not (mobility.singular and mobility.redundant_rows):
            break  # more are tried where branches of other rank meet at the start
        moved = q.copy()
        moved[3:] += NEARBY * packed.column_scale() * random.standard_normal(packed.coordinates)
        moved, worst = _nearer(joints, 0.0, moved, light)
        if worst <= CLOSED:
            there = independent_large(joints, 0.0, moved)[1]
            if there.dof < mobility.dof:
                mobility = replace(there, singular=True)
    return mobility


def mobility(m: Model) -> Mobility:
    """Mobility of the joints of ``m`` at its start; raises AssemblyError if it does not close."""
    packed = pack(m)
    if packed.coordinates > MANY_COORDINATES:
        return mobility_large(m, packed)
    q = assemble(m, packed, 0.0)
    return joint_mobility(packed, q)
