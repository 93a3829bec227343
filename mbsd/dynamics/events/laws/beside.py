"""Friction of joints that slide beside others at rest, where these share what holds them.

The rows that hold say what the motion is, and with it the friction of joints that slide. What is at rest may carry
otherwise than they say, and then presses the sliding joints otherwise. Whether it holds is therefore asked with the
friction that belongs to the forces by which it holds,

    T_raw(x) = T_raw + Y (x - x_0),   G_rr Y = - J_r a_x        r: rows that hold

x (f,) normal forces of all joints with friction, x_0 those of the rows that hold; a_x (n, f) accelerations by the
friction of joints that slide under unit normal forces. All is linear in x.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from mbsd.arrays.friction_along import friction_under, normals_along
from mbsd.dynamics.events.laws.compliance import Compliance


class Beside(NamedTuple):
    """What changes with normal forces x (f,) of sliding joints, whose friction is ``start`` (f,) in the motion."""

    start: np.ndarray
    a: np.ndarray
    """(n, f)"""
    lam: np.ndarray
    """(m, f) of joints and drivers."""


def beside(at: Compliance, v: np.ndarray, lam: np.ndarray) -> Beside | None:
    """What the friction of joints that slide at v (3 nb,) adds; lam (m,) of the motion. None where none acts on any."""
    loads = at.dynamics.loads
    count = len(loads.friction)
    if not count:
        return None
    q, rates = np.tile(at.q, (count + 1, 1)), np.tile(v, (count + 1, 1))
    friction = friction_under(at.packed, loads, q, rates, np.eye(count + 1, count))
    unit = friction[:count] - friction[count]
    if not unit.any():
        return None
    a, lam_of = at.answers(np.ascontiguousarray(unit[:, 3:].T))
    return Beside(normals_along(at.packed, loads, at.q[None], at.compact[None], lam[None])[0], a, lam_of)


def raw_of(beside: Beside, directions: np.ndarray, compliance: np.ndarray, held: np.ndarray) -> np.ndarray:
    """Y (k, f), zero for rows that do not hold; ``directions`` (n, k), ``compliance`` (k, k), ``held`` (k,)."""
    out = np.zeros((len(held), beside.a.shape[1]))
    rows = np.flatnonzero(held)
    out[rows] = -np.linalg.solve(compliance[np.ix_(rows, rows)], directions[:, rows].T @ beside.a)
    return out


def pressed_anew(
    beside: Beside | None, change: np.ndarray | None, normal: np.ndarray, raw: np.ndarray, lam: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Forces ``raw`` (k,) and multipliers lam (m,) as normal forces (f,) change them; ``change`` is Y."""
    if beside is None or change is None:
        return raw, lam
    more = normal - beside.start
    return raw + change @ more, lam + beside.lam @ more
