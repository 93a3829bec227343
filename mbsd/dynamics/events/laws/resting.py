"""Joints at rest that hold each other: what each carries, and how near they are to giving way.

One set of rows holds them, and its multipliers carry all. The friction is shared among all joints at rest (sharing.py);
their limits depend on reactions, which change with the shares, so it is shared again until both agree. Contacts that
are closed react, so that their gaps stay closed, and with them the friction of those that slide:

    G = G_t - G_th G_h^-1 G_ht        h: rows of contacts that hold; the gap of one that slides pushes along its way too

What contacts hold by themselves no joint needs to.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from mbsd.arrays.friction_along import normals_along
from mbsd.dynamics.events.bounds import AGREED, PASSES
from mbsd.dynamics.events.laws.complementarity import gives_way
from mbsd.dynamics.events.laws.compliance import Compliance
from mbsd.dynamics.events.laws.sharing import share
from mbsd.dynamics.rows.held import STICKS
from mbsd.dynamics.rows.joint_sticks import JointStick
from mbsd.dynamics.rows.switches import RunContact, Switches


def carried(
    at: Compliance, sticks: Sequence[JointStick], switches: Switches, lam: np.ndarray
) -> tuple[np.ndarray, float]:
    """Multipliers (m,) with the friction shared, and the part s of their limits that the joints need; lam (m,)."""
    resting = [stick for stick in sticks if stick.state == STICKS]
    ways = [stick.way for stick in resting]
    directions = at.generalised(ways)
    dv, lam_of = at.answers(directions)
    compliance, start, part = directions.T @ dv, -lam[ways], 0.0
    held = switches.held()
    pushing = [(row, contact) for contact in switches.contacts for row in _rows(contact) if held[row]]
    moved = np.arange(len(ways))
    if pushing:
        compliance, lam_of = _reacting(at, pushing, directions, compliance, dv, lam_of)
        moved = np.array([k for k, way in enumerate(ways) if gives_way(at, way, compliance[k, k])], np.int64)
        compliance = compliance[np.ix_(moved, moved)]
    forces, out = start, lam
    for _ in range(PASSES):
        normal = normals_along(at.packed, at.dynamics.loads, at.q[None], at.compact[None], out[None])[0]
        limits = np.array([resting[k].limit(normal) for k in moved])
        shared = start.copy()
        if len(moved):
            shared[moved], part = share(compliance, start[moved], limits, not pushing)
        change = float(np.abs(shared - forces).max())
        forces, out = shared, lam + lam_of @ (shared - start)
        out[ways] = -shared
        if change <= AGREED * float(np.abs(shared).max()):
            break
    return out, part


def _rows(contact: RunContact) -> list[int]:
    return [contact.gap] if contact.way is None else [contact.gap, contact.way]


def _reacting(
    at: Compliance,
    pushing: Sequence[tuple[int, RunContact]],
    directions: np.ndarray,
    compliance: np.ndarray,
    dv: np.ndarray,
    lam_of: np.ndarray,
) -> tuple[np.ndarray, np.ndarray]:
    """G (k, k) and multipliers (m, k) of unit friction of joints, where rows of contacts hold and react."""
    rows = [row for row, _ in pushing]
    across = at.generalised(rows)
    pushed, factors = across.copy(), np.zeros(len(rows))
    for k, (row, contact) in enumerate(pushing):
        if row == contact.gap and contact.way is not None and contact.sign:
            factors[k] = contact.friction * contact.sign
            pushed[:, k] -= factors[k] * at.generalised([contact.way])[:, 0]
    answers, lam_by = at.answers(pushed)
    forces = -np.linalg.solve(across.T @ answers, across.T @ dv)
    lam_of = lam_of + lam_by @ forces
    for k, (row, contact) in enumerate(pushing):
        lam_of[row] -= forces[k]
        if factors[k]:
            lam_of[contact.way or 0] += factors[k] * forces[k]
    return compliance + directions.T @ answers @ forces, lam_of
