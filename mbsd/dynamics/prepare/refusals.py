"""Coordinates without inertia that neither joints nor drivers hold: no equation says how they move.

A motion z of coordinates without inertia alone, J z = 0, has no kinetic energy. Where anything acts along it, z^T Q or
a row of a contact, its acceleration has no bound: it is an error. Where nothing ever does, as on the turning of point
masses, nothing changes it.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NoReturn

import numpy as np

from mbsd.arrays.friction_along import friction_under
from mbsd.arrays.loads import pack_loads
from mbsd.arrays.loads_along import loads_along
from mbsd.arrays.packing import Packed
from mbsd.base.errors import MobilityError, ModelError
from mbsd.dynamics.reference.acceleration import derivative
from mbsd.dynamics.reference.arrays import scratch_for
from mbsd.equations.assembly import residual_and_jacobian
from mbsd.results.mobility import Mobility

if TYPE_CHECKING:
    from mbsd.dynamics.prepare.prepared import PreparedDynamics

LOOSE = 1e-9
"""Singular values of the scaled Jacobian below this part of the largest are zero."""
SHARE = 1e-3
"""Share of a coordinate in a motion of unit length; less is rounding."""
BALANCED = 1e-8
"""Part of the loads of joints on a coordinate without inertia that may stay unbalanced at the start; more means that
nothing holds it."""
SLIGHT = 1e-6
"""Accelerations of usual inertias below this (sizes or rad per s^2) are no load."""
MANY_COORDINATES = 600
"""Up to so many coordinates are looked at, by full matrices."""
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
