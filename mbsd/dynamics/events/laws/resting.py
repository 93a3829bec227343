"""Joints at rest that hold each other: what each carries, and how near they are to giving way.

One set of rows holds them, and its multipliers carry all. The friction is shared among all joints at rest (sharing.py);
their limits depend on reactions, which change with the shares, so it is shared again until both agree. Contacts that
are closed react, so that their gaps stay closed, and with them the friction of those that slide:

    V = V_t - V_h G_h^-1 G_ht,   G = J_t V     h: rows of contacts that hold; the gap of one that slides pushes along
                                               its way too

V (n, k) are accelerations by unit friction T. What contacts hold by themselves no joint needs to. Where contacts slide,
G is not symmetric, and two questions part:

    V d = 0     T may change by d: nothing moves differently. As  V^T M V d = 0  it is one of a symmetric compliance
    G d = 0     joints stay at rest, though what else moves may move differently, as the contacts press more or less

The first is how friction is shared, the second how near joints are to giving way: Coulomb's law asks no more of them.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from mbsd.arrays.friction_along import normals_along
from mbsd.dynamics.events.bounds import AGREED, PASSES
from mbsd.dynamics.events.laws.beside import Beside, beside, pressed_anew, raw_of
from mbsd.dynamics.events.laws.complementarity import gives_way
from mbsd.dynamics.events.laws.compliance import Compliance
from mbsd.dynamics.events.laws.sharing import share, share_any
from mbsd.dynamics.rows.held import STICKS
from mbsd.dynamics.rows.joint_sticks import JointStick
from mbsd.dynamics.rows.switches import RunContact, Switches


def carried(
    at: Compliance, sticks: Sequence[JointStick], switches: Switches, v: np.ndarray, lam: np.ndarray
) -> tuple[np.ndarray, float]:
    """Multipliers (m,) with the friction shared, and the part s of their limits that the joints need.

    ``v`` (3 nb,), ``lam`` (m,). The multipliers are those of the motion, s is what the friction of sliding joints asks
    for that belongs to what holds.
    """
    resting = [stick for stick in sticks if stick.state == STICKS]
    ways = [stick.way for stick in resting]
    directions = at.generalised(ways)
    dv, lam_of = at.answers(directions)
    compliance, start = directions.T @ dv, -lam[ways]
    held, whole = switches.held(), compliance
    pushing = [(row, contact) for contact in switches.contacts for row in _rows(contact) if held[row]]
    pressed = beside(at, v, lam)
    moved, sharing = np.arange(len(ways)), compliance
    sliding = any(contact.way is not None and contact.sign for _, contact in pushing)
    if pushing:
        dv, lam_of = _reacting(at, pushing, dv, lam_of)
        if pressed is not None:
            pressed = Beside(pressed.start, *_reacting(at, pushing, pressed.a, pressed.lam))
        compliance = sharing = directions.T @ dv
        if sliding:
            sharing = dv.T @ (dv / at.dynamics.inverse[3:, None])
        moved = np.array([k for k, way in enumerate(ways) if gives_way(at, way, compliance[k, k])], np.int64)
        whole = compliance
        compliance, sharing = compliance[np.ix_(moved, moved)], sharing[np.ix_(moved, moved)]

    def agreed(begin: np.ndarray, pressed: Beside | None) -> tuple[np.ndarray, float]:
        forces, part, out = start, 0.0, begin
        change = None if pressed is None else raw_of(pressed, directions, whole, held[ways])
        for _ in range(PASSES):
            normal = normals_along(at.packed, at.dynamics.loads, at.q[None], at.compact[None], out[None])[0]
            limits = np.array([resting[k].limit(normal) for k in moved])
            unshared, base = pressed_anew(pressed, change, normal, start, lam)
            shared = unshared.copy()
            if len(moved):
                shared[moved], part = share(sharing, unshared[moved], limits)
                if sliding:
                    part = share_any(compliance, unshared[moved], limits)[1]
            moving = float(np.abs(shared - forces).max())
            forces, out = shared, base + lam_of @ (shared - start)
            out[ways] = -shared
            if moving <= AGREED * float(np.abs(shared).max()):
                break
        return out, part

    out, part = agreed(lam, None)
    return (out, part) if pressed is None else (out, agreed(out, pressed)[1])


def _rows(contact: RunContact) -> list[int]:
    return [contact.gap] if contact.way is None else [contact.gap, contact.way]


def _reacting(
    at: Compliance,
    pushing: Sequence[tuple[int, RunContact]],
    dv: np.ndarray,
    lam_of: np.ndarray,
) -> tuple[np.ndarray, np.ndarray]:
    """V (n, k) and multipliers (m, k) of unit forces, where rows of contacts hold and react."""
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
    return dv + answers @ forces, lam_of
