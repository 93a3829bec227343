"""Friction of joints along a known motion, found together with the multipliers at all times at once.

The iteration is that of joint_friction.py, with a weight for each time.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy as np

from mbsd.base.errors import SimulationError
from mbsd.base.quantity import written
from mbsd.equations.joint_friction import FAINT, MOST_PASSES, SETTLED, tabulate_friction, tabulate_normals

if TYPE_CHECKING:
    from mbsd.arrays.packing import Packed
    from mbsd.equations.loads import Loads

REMEDY = (
    "Lower the friction or the radius of the pins, guide sliders over a longer length, or keep links from lying nearly "
    "in one line"
)
"""Remedy for joints that jam."""


def friction_along(
    packed: Packed, loads: Loads, q: np.ndarray, v: np.ndarray, compact: np.ndarray, lam: np.ndarray
) -> np.ndarray:
    """Return (T, 3 nb) friction of joints along q, v (T, 3 nb) with multipliers lam (T, m).

    It is zero for ground.
    """
    normal = normals_along(packed, loads, q, compact, lam)
    return friction_under(packed, loads, q, v, normal)


def normals_along(packed: Packed, loads: Loads, q: np.ndarray, compact: np.ndarray, lam: np.ndarray) -> np.ndarray:
    """Return (T, f) normal forces of the joints with friction (N)."""
    out = np.zeros((len(q), len(loads.friction)))
    if len(loads.friction):
        tabulate_normals(packed.system, loads, q, np.ascontiguousarray(compact), lam, packed.ws, out)
    return out


def friction_under(packed: Packed, loads: Loads, q: np.ndarray, v: np.ndarray, normal: np.ndarray) -> np.ndarray:
    """Return (T, 3 nb) friction of joints under normal forces (T, f); zero for ground."""
    out = np.zeros_like(q)
    if len(loads.friction):
        tabulate_friction(packed.system, loads, q, v, normal, packed.ws, out, np.zeros(len(q)))
        out[:, :3] = 0.0
    return out


def with_friction(
    packed: Packed,
    loads: Loads,
    motion: tuple[np.ndarray, np.ndarray, np.ndarray],
    compact: np.ndarray,
    solve: Callable[[np.ndarray], tuple[np.ndarray, ...]],
) -> tuple[tuple[np.ndarray, ...], np.ndarray]:
    """Return the result of ``solve`` under consistent friction, and that friction (T, 3 nb).

    Consistent friction belongs to the multipliers of the result.

    motion: t (T,), q and v (T, 3 nb); compact J (T, m, 6). ``solve`` takes friction (T, 3 nb) and gives multipliers
    (T, m) first. Raises SimulationError where joints jam.
    """
    t, q, v = motion
    friction = np.zeros_like(q)
    solved = solve(friction)
    if not len(loads.friction):
        return solved, friction
    x = np.zeros((len(q), len(loads.friction)))
    last, weight = np.zeros_like(x), np.ones(len(x))
    for passes in range(MOST_PASSES):
        friction = friction_under(packed, loads, q, v, x)
        solved = solve(friction)
        normal_forces = normals_along(packed, loads, q, compact, solved[0])
        gap = normal_forces - x
        open_ = ~(
            np.abs(gap).max(axis=1) <= SETTLED * np.maximum(normal_forces.max(axis=1), FAINT * normal_forces.max())
        )
        if not open_.any():
            return solved, friction
        bend = gap - last
        square = (bend**2).sum(axis=1)
        step = -weight * (last * bend).sum(axis=1) / np.where(square > 0, square, 1.0)
        weight = np.where((square > 0) & (passes > 0), np.clip(step, -10.0, 10.0), 1.0)
        last = gap
        x = np.where(open_[:, None], np.maximum(x + weight[:, None] * gap, 0.0), x)
    worst = int(np.argmax(open_))
    raise SimulationError(f"{packed.name}: at t = {t[worst]:.6g} s {jam(packed, x[worst])}. {REMEDY}.")


def jam(packed: Packed, normal: np.ndarray) -> str:
    """Return the error text where friction and the reactions that it raises find no balance.

    It names the joint with the largest of ``normal`` (f,), in N, the last that were tried; where none of them is
    finite, all joints with friction.
    """
    joints = [force.params["joint"] for force in packed.forces if force.kind.of_reactions]
    sizes = np.where(np.isfinite(normal), np.abs(normal), 0.0)
    k = int(np.argmax(sizes))
    largest = f"'{joints[k]}' with the largest normal force (above {written(sizes[k], 'N')})"
    among = "among " + ", ".join(f"'{joint}'" for joint in joints)
    words = largest if sizes[k] > 0.0 else among
    return f"friction and reactions of the joints do not agree; joints jam, {words}"
