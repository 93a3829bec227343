"""Inverse dynamics along a known motion: multipliers, reactions, efforts, and how exact the motion is.

    J^T lam = Q - M a                  Q: gravity and forces
    reaction on body b = -J_b^T lam, given at the joint's second marker: fx, fy, torque
    effort of a driver = -lam of its row;  power = effort f'

M is constant and diagonal because q holds centres of mass. Where joints are redundant the loads share in many ways;
the multipliers of least norm are taken. Friction of joints joins Q and depends on lam: both are found by repetition.
Source: Haug 1989, ch. 6.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import partial

import numpy as np

from mbsd.arrays.friction_along import with_friction
from mbsd.arrays.inertias import inertia_of, weight_of
from mbsd.arrays.laws import compiled_laws
from mbsd.arrays.loads import approached_along, loads_along, pack_loads
from mbsd.arrays.packing import Packed
from mbsd.arrays.reactions import times_compact, wrenches
from mbsd.base.errors import SingularPoseError
from mbsd.equations.assembly import tabulate
from mbsd.kinematics.elimination import ALL_SOLVED, multipliers_along
from mbsd.kinematics.prepared import Prepared

JACOBIAN_NUMBERS = 4_000_000
"""Largest number of entries of Jacobians held at once."""
DENSE = 36
"""Number of unknowns up to which a dense solve is as fast as one that follows the zeros of J."""
JUMPED = 1e-6
"""Part of the largest acceleration that is open where an output is taken for one on a jump."""
BESIDE = 1e-9
"""Distance of the poses looked at beside it, in sizes and rad."""


@dataclass
class Efforts:
    """Over the times of a motion."""

    lam: np.ndarray
    """(T, m) multipliers."""
    wrench: np.ndarray
    """(T, joints, 3) fx, fy, torque on the second body at its marker."""
    residuals: np.ndarray
    """(4,) largest |Phi|, |J v - nu|, |J a - gamma| and |d(T + V)/dt - power of the drivers|."""
    approached: np.ndarray | None = None
    """(T, n) how fast the contact of each interaction approached when it began (m/s); None where none asks."""


def inverse_dynamics(
    ready: Prepared,
    times: np.ndarray,
    drives: np.ndarray,
    q: np.ndarray,
    v: np.ndarray,
    a: np.ndarray,
    states: np.ndarray | None = None,
) -> Efforts:
    """Solve for the multipliers of the motion q, v, a (T, 3 nb) and check it against its equations.

    ``states`` (T, n): those of forces (SI), where any has some.
    """
    packed = ready.packed
    count, rows = len(q), len(packed.ws.phi)
    loads, packed_loads, approached = weight_of(packed) - inertia_of(packed) * a, None, None
    if packed.forces:
        laws = compiled_laws(packed, float(times[0]), float(times[-1]))
        packed_loads = pack_loads(packed)
        approached = approached_along(packed, packed_loads, laws, times, q, v)
        loads += loads_along(packed, packed_loads, laws, times, q, v, approached, states)
    driven, nu = packed.driver_rows, drives[:, 1:, 1]
    out = Efforts(np.zeros((count, rows)), np.zeros((count, len(packed.joints), 3)), np.zeros(4), approached)
    for at in _chunks(packed, count):
        phi, compact, gamma = _tabulated(packed, drives[at], q[at], v[at])
        jac = packed.spread(compact)
        lam = out.lam[at]
        if packed_loads is None:
            lam[:] = _multipliers(ready, times[at], compact, jac, loads[at])
        else:
            motion = times[at], q[at], v[at]
            solved = partial(_multipliers, ready, times[at], compact, jac)
            applied = loads[at].copy()
            [efforts], friction = with_friction(
                packed, packed_loads, motion, compact, lambda f, solve=solved, q=applied: (solve(q + f),)
            )
            lam[:] = efforts
            loads[at] += friction
        out.wrench[at] = wrenches(packed, compact, q[at], lam)
        rate, bend = times_compact(packed, compact, v[at]), times_compact(packed, compact, a[at]) - gamma
        rate[:, driven:] -= nu[at]
        _take_nearer_side(packed, drives[at], q[at], v[at], a[at], bend)
        power = np.einsum("tc,tc->t", loads[at], v[at]) - np.einsum("tr,tr->t", lam[:, driven:], nu[at])
        worst = [np.abs(error).max(initial=0.0) for error in (phi, rate, bend, power)]
        out.residuals = np.maximum(out.residuals, worst)
    return out


def singularity_margin(packed: Packed, rows: np.ndarray, drives: np.ndarray, q: np.ndarray) -> np.ndarray:
    """Return (T,) smallest over largest singular value of scaled rows (n,) of J along q (T, 3 nb)."""
    kept, margin = rows.astype(np.int64), np.zeros(len(q))
    scale = packed.row_scale()[kept, None] * packed.column_scale()
    for at in _chunks(packed, len(q)):
        _, compact, _ = _tabulated(packed, drives[at], q[at], np.zeros_like(q[at]))
        singular = np.linalg.svd(packed.spread(compact)[:, kept] * scale, compute_uv=False)
        margin[at] = singular[:, -1] / singular[:, 0]
    return margin


def _chunks(packed: Packed, count: int) -> Iterator[slice]:
    """Return chunks of the outputs, so that not too many Jacobians are held at once."""
    size = max(1, JACOBIAN_NUMBERS // max(1, len(packed.ws.phi) * packed.coordinates))
    return (slice(start, min(start + size, count)) for start in range(0, count, size))


def _tabulated(
    packed: Packed, drives: np.ndarray, q: np.ndarray, v: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return Phi (T, m), compact J (T, m, 6) and gamma (T, m) along a motion."""
    count, rows = len(q), len(packed.ws.phi)
    phi, gamma = np.zeros((2, count, rows))
    compact = np.zeros((count, rows, 6))
    tabulate(packed.system, drives, q, v, packed.ws, phi, compact, gamma)
    return phi, compact, gamma


def _take_nearer_side(
    packed: Packed, drives: np.ndarray, q: np.ndarray, v: np.ndarray, a: np.ndarray, bend: np.ndarray
) -> None:
    """Correct bend (T, m) to the side that a follows where accelerations jump.

    They jump as a Geneva's pin enters its slot; either side is right.

    Rounding decides on which side of the jump an output on it is.
    """
    if not len(packed.system.special):
        return
    odd = np.flatnonzero(np.abs(bend).max(axis=1, initial=0.0) > JUMPED * np.abs(a).max(initial=0.0))
    for k in odd:
        reach = BESIDE / max(float(np.abs(v[k, 3:] / packed.column_scale()).max()), 1e-300)
        near = q[k] + np.outer([-reach, reach], v[k])
        _, compact, gamma = _tabulated(packed, np.stack([drives[k], drives[k]]), near, np.stack([v[k], v[k]]))
        sides = np.einsum("trc,c->tr", packed.spread(compact), a[k, 3:]) - gamma
        for side in sides:
            if np.abs(side).max() < np.abs(bend[k]).max():
                bend[k] = side


def _multipliers(
    ready: Prepared, times: np.ndarray, compact: np.ndarray, jac: np.ndarray, loads: np.ndarray
) -> np.ndarray:
    """Return (T, m) of J, compact (T, m, 6) and spread (T, m, n), and loads (T, 3 nb)."""
    if ready.mobility.redundant_rows:
        return np.array(
            [np.linalg.lstsq(matrix.T, load[3:], rcond=1e-9)[0] for matrix, load in zip(jac, loads, strict=True)]
        )
    if jac.shape[1] <= DENSE:
        try:
            return np.linalg.solve(jac.transpose(0, 2, 1), loads[:, 3:, None])[..., 0]
        except np.linalg.LinAlgError:
            singular = int(np.argmin(np.abs(np.linalg.det(jac))))
            raise _undetermined(ready, float(times[singular])) from None
    lam = np.zeros(jac.shape[:2])
    singular = multipliers_along(ready.sequence, ready.factors, compact, np.ascontiguousarray(loads), lam)
    if singular != ALL_SOLVED:
        raise _undetermined(ready, float(times[singular]))
    return lam


def _undetermined(ready: Prepared, time: float) -> SingularPoseError:
    return SingularPoseError(
        f"{ready.packed.name}: the pose at t = {time:.9g} s is singular, so that nothing determines the reactions "
        "there. Choose times that do not fall on it, or add a link that decides how the motion goes on."
    )
