"""Starts and models that cannot be simulated, each refused by the name of what is to be changed.

Unheld coordinates: a motion z of coordinates without inertia alone, J z = 0, has no kinetic energy. Where anything acts
along it, z^T Q or a row of a contact, its acceleration has no bound: it is an error. Where nothing ever does, as on the
turning of point masses, nothing changes it.

Pressed journals: a pin with play that starts ``start`` away from its bearing's middle (model/forces/clearance_joint.py)
may stand in its wall as deep as its load presses it, N = K d^n. What it carries is the reaction of the pin without
play, at the same start; a journal that is pressed in many times harder was put there by mistake, and would be shot out.

Dependent rows: dynamics works on independent rows alone. A row left out as redundant must close wherever the others
close: that is tried at poses beside the start. If it opens there, the start pose is singular (a toggle, a change point,
a stretched chain): rows depend on each other only in it, and the equations do not say how the links go on.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import NoReturn

import numpy as np

from mbsd.arrays.friction_along import friction_under
from mbsd.arrays.loads import loads_along, pack_loads
from mbsd.arrays.packing import Packed
from mbsd.base.errors import MechanismError, MobilityError, ModelError, SimulationError, SingularPoseError
from mbsd.dynamics.prepare.large import MANY_COORDINATES
from mbsd.dynamics.prepare.prepared import PreparedDynamics
from mbsd.dynamics.reference.arrays import scratch_for
from mbsd.dynamics.reference.projection import OPENED_BY, project
from mbsd.equations.assembly import residual_and_jacobian
from mbsd.kinematics.pose.ideal_joints import with_ideal_joints
from mbsd.model.force import Press
from mbsd.model.mechanism import Model
from mbsd.results.views import Mobility

LOOSE = 1e-9
"""Singular values of the scaled Jacobian below this part of the largest are zero."""
SHARE = 1e-3
"""Share of a coordinate in a motion of unit length; less is rounding."""
BALANCED = 1e-8
"""Part of the loads of joints on a coordinate without inertia that may stay unbalanced at the start; more means that
nothing holds it."""
SLIGHT = 1e-6
"""Accelerations of usual inertias below this (sizes or rad per s^2) are no load."""
NEAR = 0.02
"""How far poses near the start are (sizes, rad), and how fast they move (per s)."""
ACTS = 1e-9
"""Part of all loads, or of a row of a contact, that is no rounding."""
NEARBY = 2
"""Poses near the start at which loads and contacts are looked at."""


def refuse_unheld(ready: PreparedDynamics, reference: np.ndarray) -> None:
    """Raise MobilityError where a coordinate without inertia is not held, at the start or later.

    ``reference`` (3 nb,): inertias of usual size, to tell loads from rounding. Raises ModelError for a load that is no
    finite number.
    """
    dynamics, packed = ready.dynamics, ready.packed
    _refuse_massless(packed, ready.mobility, ready.start, ready.initial.q)
    _refuse_loaded(ready)
    out, lam, scratch = ready.evaluate_start()
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
    ways = _null_space(scaled[:, columns])
    moved = np.abs(ways).max(axis=0, initial=0.0).reshape(-1, 3)
    loose = [packed.body_names[b] for b, most in zip(free, moved.max(axis=1), strict=True) if most > SHARE]
    if not loose:
        return
    names = " and ".join(f"'{name}'" for name in loose[:3]) + (f" and {len(loose) - 3} more" if len(loose) > 3 else "")
    has, it = ("have", "them") if len(loose) > 1 else ("has", "it")
    raise MobilityError(
        f"{packed.name}: {names} {has} neither mass nor inertia, and can move in {len(ways)} "
        f"way{'s' * (len(ways) > 1)} while all that has any rests, so that no load tells how. Give {it} a "
        f"mass and an inertia, m.change('{loose[0]}', mass=...), or hold {it} by a joint or a driver"
    )


def _refuse_loaded(ready: PreparedDynamics) -> None:
    """Raise MobilityError where loads or contacts act along a motion of coordinates without inertia alone."""
    packed = ready.packed
    light = np.flatnonzero(ready.dynamics.inertia[3:] == 0.0)
    if packed.coordinates > MANY_COORDINATES:
        return
    random = np.random.default_rng(5)
    size, rows, drive = packed.column_scale(), packed.row_scale(), packed.drives(np.array([ready.start]))[0]
    for _ in range(NEARBY):
        q, v = ready.initial.q.copy(), ready.initial.v.copy()
        q[3:] += NEAR * size * random.standard_normal(len(size))
        v[3:] += NEAR * size * random.standard_normal(len(size))
        residual_and_jacobian(packed.system, q, drive, packed.ws)
        scaled = (packed.jacobian() * rows[:, None] * size)[:, light]
        ways = _null_space(scaled[: packed.contact_rows])
        if not len(ways):
            return
        rates = np.abs(scaled[packed.contact_rows :] @ ways.T).max(axis=0, initial=0.0)
        loads = _loads_at(ready, q, v)[3:] * size
        acting = (rates > ACTS) | (np.abs(ways @ loads[light]) > ACTS * np.abs(loads).max())
        if acting.any():
            _tell_loaded(packed, 3 + int(light[np.argmax(np.abs(ways[np.argmax(acting)]))]))


def _loads_at(ready: PreparedDynamics, q: np.ndarray, v: np.ndarray) -> np.ndarray:
    """(3 nb,) all loads but weight at a state, friction under normal forces of 1; zero where a function fails there."""
    packed, laws = ready.packed, ready.dynamics.laws
    loads = pack_loads(packed)
    try:
        out = loads_along(packed, loads, laws, np.array([ready.start]), q[None], v[None])
    except ModelError:
        return np.zeros_like(q)
    return (out + friction_under(packed, loads, q[None], v[None], np.ones((1, len(loads.friction)))))[0]


def _tell_loaded(packed: Packed, column: int) -> NoReturn:
    name, what = packed.body_names[column // 3], ("x", "y", "angle")[column % 3]
    body = packed.body_names.index(name)
    joints = [*zip(packed.joints, packed.markers, strict=True)][len(packed.joints) - packed.contacts :]
    parts = [*joints, *zip(packed.forces, packed.force_markers, strict=True)]
    acting = [part.name for part, ends in parts if body in packed.system.marker_body[np.asarray(ends)]]
    by = " or ".join(f"'{other}'" for other in dict.fromkeys(acting)) or "a force"
    raise MobilityError(
        f"{packed.name}: body '{name}' has no inertia in {what}, joints connect it to nothing that has any, and {by} "
        "acts on it: its acceleration has no bound. Give it an inertia, "
        f"m.change('{name}', inertia=...), or hold it by a joint or a driver"
    )


def _null_space(matrix: np.ndarray) -> np.ndarray:
    """(k, n) orthonormal rows that ``matrix`` (m, n), dimensionless, takes to zero."""
    _u, size, basis = np.linalg.svd(matrix)
    return basis[int((size > LOOSE * max(1.0, float(size.max(initial=0.0)))).sum()) :]


SHALLOW = 0.01
"""Part of the clearance by which any journal may start in its wall."""
HARDER = 10.0
"""Times its load by which it may start pressed in: a load may grow right after the start."""


def presses(m: Model) -> dict[str, Press]:
    """By name, those journals of a mechanism that start in their walls by more than slightly."""
    own = {name: force.kind.press(force) for name, force in m.forces.items() if force.kind.press is not None}
    return {name: press for name, press in own.items() if press is not None and press.depth > SHALLOW * press.room}


def refuse_pressed(m: Model, start: float, end: float, prepared: Callable[..., PreparedDynamics]) -> None:
    """Raise SimulationError for a journal that starts pressed into its bearing, from ``start`` to ``end`` (s).

    ``prepared`` makes a mechanism ready for its dynamics.
    """
    deep = presses(m)
    if not deep:
        return
    joined = with_ideal_joints(m)
    assert joined is not None, "what starts as a pin does is one then"
    try:
        ideal = prepared(joined, start, end)
    except MechanismError:
        return  # without play it cannot move: what it carries is not known
    for name, press in deep.items():
        load = _reaction(ideal, name)
        if press.force > HARDER * load:
            raise SimulationError(
                f"{m.name}: force '{name}' starts with its journal {press.depth:.3g} m deep in the bearing's wall, "
                f"pressed in by {press.force:.3g} N, where a pin without play carries {load:.3g} N. Give start= within "
                f"its clearance of {press.room:g} m, or as deep as its load presses it; start=None leaves it where "
                "start_near puts it"
            )


def _reaction(ready: PreparedDynamics, name: str) -> float:
    """The force (N) that the pin ``name`` carries at the start."""
    return math.hypot(*ready.evaluate_start()[1][ready.packed.rows_of(name)].tolist())


BESIDE = (0.003, 0.001)
"""How far beside the start is looked, in sizes and rad; nearer where the links do not close, or a row opens: from afar
they may have closed on another branch."""
CLOSED = 1e-9
"""Residuals (sizes, rad) of rows that hold."""
PASSES = 30


def refuse_singular_start(ready: PreparedDynamics, kept: list[int], rows: int) -> None:
    """Note the rows left out of the first ``rows``; raises SingularPoseError if they only seem redundant."""
    packed = ready.packed
    ready.dropped = tuple(sorted(set(range(rows)) - set(kept)))
    if not ready.dropped:
        return
    scratch = scratch_for(ready.dynamics, packed.ws, len(packed.motions), 1)
    scale = packed.row_scale()
    random = np.random.default_rng(3)
    for _ in range(3):
        away = np.concatenate([np.zeros(3), packed.column_scale() * random.standard_normal(packed.coordinates)])
        opened = None
        for part in BESIDE:
            state = np.stack([ready.initial.q + part * away, ready.initial.v])
            project(ready.dynamics, scratch, ready.start, state, PASSES)
            packed.specials.check()
            gaps = np.abs(packed.ws.phi * scale)
            if gaps[kept].max(initial=0.0) <= CLOSED:
                opened = [row for row in ready.dropped if not gaps[row] <= OPENED_BY]
                if not opened:
                    break
        if opened:
            _refuse(ready, opened)


def _refuse(ready: PreparedDynamics, opened: list[int]) -> None:
    packed = ready.packed
    names = ", ".join(dict.fromkeys(f"'{packed.joint_of_row(row).name}'" for row in opened))
    raise SingularPoseError(
        f"{packed.name}: the start pose at t = {ready.start:.6g} s is singular (a toggle, a change point or a "
        f"stretched chain): only there {names} {'repeat' if ',' in names else 'repeats'} what others hold, and how the "
        "links go on is not determined. Start a little beside it with start_near; if nothing can move there, free a "
        "joint."
    )


def refuse_opened(ready: PreparedDynamics, times: np.ndarray, phi: np.ndarray) -> None:
    """Raise SingularPoseError if a row left out as redundant opens at residuals phi (T, m) of ``times`` (T,)."""
    if not ready.dropped:
        return
    packed, rows = ready.packed, np.array(ready.dropped)
    gaps = np.abs(phi[:, rows] * packed.row_scale()[rows])
    late = np.flatnonzero(~(gaps.max(axis=1) <= OPENED_BY))
    if len(late):
        k = int(late[0])
        row = int(rows[np.argmax(gaps[k])])
        raise SingularPoseError(
            f"{packed.name}: by t = {times[k]:.6g} s joint '{packed.joint_of_row(row).name}', left out as redundant, "
            f"is open by {abs(phi[k, row]):.3g} (m or rad): the links passed a change point on another branch, "
            "lengths do not agree there, or an event released the joint that it repeats. Correct the lengths, end "
            "before it, or leave out another joint."
        )
