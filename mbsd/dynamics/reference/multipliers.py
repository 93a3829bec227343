"""Multipliers and margins along a motion that was found without them: that of independent coordinates.

    S lam = J W^-1 Q - gamma, refined as in acceleration.py, step for step, so that both give the same numbers

J and gamma are tabulated beforehand, because the results need them in any case, and Q by its own kernel.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from mbsd.arrays.curve_branches import tabulate_along
from mbsd.compiling.jit import kernel
from mbsd.dynamics.reference.refinement import solve_balanced
from mbsd.dynamics.reference.schur import factor_schur, schur_factors
from mbsd.equations.laws import tabulate_law
from mbsd.equations.loads import stretches, tabulate_loads

if TYPE_CHECKING:
    from mbsd.arrays.packing import Packed
    from mbsd.dynamics.reference.arrays import Dynamics

NEGLIGIBLE = 1e-9
"""Singular values of J below this part of the largest are zero."""
CHUNK = 2_000_000
"""Numbers of Jacobians that are held at once."""


@kernel
def tabulate_multipliers(schur, factors, inverse, inertia, passes, jacobians, gamma, force, pose, a, lam, margin):
    """Fill lam (T, m) and margin (T,) from compact J (T, m, 6), gamma (T, m) and Q (T, 3 nb), which is used up.

    ``pose`` and ``a`` (3 nb,): scratch.
    """
    for i in range(gamma.shape[0]):
        margin[i] = factor_schur(schur, inverse, jacobians[i], factors, 0.0)
        solve_balanced(schur, factors, inverse, inertia, passes, force[i], gamma[i], 1.0, pose, a, lam[i])


def multipliers_along(
    packed: Packed,
    dynamics: Dynamics,
    motion: tuple[np.ndarray, np.ndarray, np.ndarray],
    jacobians: np.ndarray,
    gamma: np.ndarray,
    approached: np.ndarray | None = None,
) -> tuple[np.ndarray, np.ndarray]:
    """Multipliers (T, m) and margins (T,) along t (T,), q and v (T, 3 nb) with compact J (T, m, 6) and gamma (T, m).

    Joints are without friction, contacts without sliding. Raises ModelError where a function of the user fails.
    """
    t, q, v = motion
    if packed.motions:  # loops read laws in their compiled form, which may differ in the last digit
        _, jacobians, gamma = _tabulated(packed, _drives(packed, dynamics, t), q, v)
    force = np.repeat(dynamics.weight[None], len(t), axis=0)
    if dynamics.loads.total:
        power = np.zeros(len(t))
        for at in stretches(dynamics.loads, approached, len(t)):
            rows = t[at], q[at], v[at], packed.ws, force[at], power[at]
            tabulate_loads(packed.system, dynamics.loads, dynamics.laws, *rows)
        packed.specials.check()
    lam, margin, (pose, a) = np.zeros_like(gamma), np.zeros(len(t)), np.zeros((2, len(dynamics.weight)))
    tabulate_multipliers(
        dynamics.schur, schur_factors(dynamics.schur), dynamics.inverse, dynamics.inertia, dynamics.passes,
        jacobians, gamma, force, pose, a, lam, margin,
    )  # fmt: skip
    return lam, margin


def fill_multipliers(
    packed: Packed, dynamics: Dynamics, times: np.ndarray, y: np.ndarray, lam: np.ndarray, margin: np.ndarray
) -> None:
    """Fill lam (T, m) and margin (T,) of states y (T, 2, 3 nb) at times (T,); see :func:`multipliers_along`."""
    size = max(1, CHUNK // max(1, 6 * lam.shape[1]))
    for start in range(0, len(times), size):
        at = slice(start, start + size)
        t, q, v = times[at], np.ascontiguousarray(y[at, 0]), np.ascontiguousarray(y[at, 1])
        _, jacobians, gamma = _tabulated(packed, _drives(packed, dynamics, t), q, v)
        lam[at], margin[at] = multipliers_along(packed, dynamics, (t, q, v), jacobians, gamma)


def _tabulated(
    packed: Packed, drives: np.ndarray, q: np.ndarray, v: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    phi, gamma = np.zeros((2, len(q), len(packed.ws.phi)))
    jacobians = np.zeros((*phi.shape, 6))
    tabulate_along(packed, drives, q, v, phi, jacobians, gamma)
    return phi, jacobians, gamma


def _drives(packed: Packed, dynamics: Dynamics, times: np.ndarray) -> np.ndarray:
    """(T, drivers + 1, 3) values, rates and accelerations of the compiled laws."""
    out = np.zeros((len(packed.motions) + 1, len(times), 3))
    for k in range(1, len(out)):
        tabulate_law(dynamics.laws, k, times, out[k])
    return np.ascontiguousarray(out.swapaxes(0, 1))


def least_norm(packed: Packed, jacobians: np.ndarray, lam: np.ndarray, held: np.ndarray) -> np.ndarray:
    """Return the multipliers (T, m) of least norm of joints that share loads in many ways, which lam (T, m) divides.

    ``jacobians`` (T, m, 6) are compact; ``held`` (T, m) tells which rows hold.
    """
    out, joints = lam.copy(), slice(0, packed.contact_rows)
    for k, j in enumerate(packed.spread(jacobians * held[..., None])[:, joints]):
        out[k, joints] = np.linalg.lstsq(j.T, j.T @ lam[k, joints], rcond=NEGLIGIBLE)[0] * held[k, joints]
    return out
