"""What contacts that stick and joints at rest carry together, and how near they are to giving way.

One set of rows holds them, which says nothing of what each carries: where a ball lies between floor and face of a
slider that sticks in its guide, any of the three may stick less. Of all forces that keep them at rest those are found
that need the smallest part s of what Coulomb's law allows (holding.py); limits of joints depend on reactions, so it is
done again until both agree. They hold while s <= 1, whatever rows hold them.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from mbsd.arrays.friction_along import normals_along
from mbsd.dynamics.events.bounds import AGREED_TOGETHER, PASSES
from mbsd.dynamics.events.laws.beside import Beside, beside, pressed_anew, raw_of
from mbsd.dynamics.events.laws.complementarity import alone
from mbsd.dynamics.events.laws.compliance import Compliance
from mbsd.dynamics.events.laws.least_part import FORCE, OWN, PULLED, RAW, UNIT, least_part, together_of
from mbsd.dynamics.rows.held import OPEN, STICKS
from mbsd.dynamics.rows.joint_sticks import JointStick
from mbsd.dynamics.rows.switches import RunContact, Switches


def one_by_one(contacts: Sequence[RunContact], sticks: Sequence[JointStick]) -> bool:
    """Whether contacts may come to their limits one by one: none of them loses friction by that, and no joint sticks.

    What one at its limit lacks the others carry, and nothing moves before all of them are there.
    """
    return not sticks and all(contact.static_friction <= contact.friction for contact in contacts)


def shares_contacts(switches: Switches, sticks: Sequence[JointStick], held: np.ndarray, by_turns: bool) -> bool:
    """Whether contacts that stick hold with others, so that rows ``held`` (m,) do not say what each carries.

    Not where they come to their limits ``by_turns``.
    """
    sticking = [contact for contact in switches.contacts if contact.state == STICKS]
    if not sticking or by_turns:
        return False
    ways = [contact.way or 0 for contact in sticking] + [stick.way for stick in sticks if stick.state == STICKS]
    return not held[ways].all()


def held_together(
    at: Compliance, sticks: Sequence[JointStick], switches: Switches, v: np.ndarray, lam: np.ndarray
) -> tuple[np.ndarray, float]:
    """Multipliers (m,) with which all hold, and the part s of their limits that they need; v (3 nb,), lam (m,).

    The multipliers are those of the motion, s that under the friction of sliding joints that belongs to what holds.
    """
    closed = [contact for contact in switches.contacts if contact.state != OPEN]
    rough = [k for k, contact in enumerate(closed) if contact.state == STICKS]
    resting = [stick for stick in sticks if stick.state == STICKS]
    gaps, ways = [c.gap for c in closed], [closed[k].way or 0 for k in rough] + [stick.way for stick in resting]
    rows = np.array(gaps + ways)
    held = switches.held()[rows]
    directions = at.generalised(rows)
    dv, lam_of = at.answers(_pushed(at, closed, directions))
    raw = np.where(held, -lam[rows], 0.0)
    compliance, unit = directions.T @ dv, 1.0 / np.sqrt(alone(at, rows.tolist()))
    pick = np.zeros((len(ways), len(gaps)))
    pick[np.arange(len(rough)), rough] = [closed[k].static_friction for k in rough]

    def agreed(begin: np.ndarray, pressed: Beside | None) -> tuple[np.ndarray, float]:
        force, part, out = raw, 1.0, begin
        change = None if pressed is None else raw_of(pressed, directions, compliance, held)
        for _ in range(PASSES):
            normal = normals_along(at.packed, at.dynamics.loads, at.q[None], at.compact[None], out[None])[0]
            own = np.array([0.0] * len(rough) + [stick.limit(normal) for stick in resting])
            before = force
            unshared, base = pressed_anew(pressed, change, normal, raw, lam)
            force, part = divided(compliance, unshared, unit, pick, own, held)
            out = _multipliers(base + lam_of @ (force - raw), closed, rows, force)
            if part == PULLED or np.abs(force - before).max() <= AGREED_TOGETHER * np.abs(force).max(initial=0.0):
                break
        return out, part

    out, part = agreed(lam, None)
    pressed = beside(at, v, lam)
    return (out, part) if pressed is None else (out, agreed(out, pressed)[1])


def divided(
    compliance: np.ndarray, raw: np.ndarray, unit: np.ndarray, pick: np.ndarray, own: np.ndarray, held: np.ndarray
) -> tuple[np.ndarray, float]:
    """N and T (n,) that move nothing differently than ``raw``, and the smallest part s; PULLED: no N >= 0 does.

    ``compliance`` (n, n), ``unit`` (n,) makes it dimensionless; what friction may be is ``pick`` (k, c) N + ``own``
    (k,); ``held`` (n,): which accelerations count.
    """
    k, c = pick.shape
    work = together_of(c + k)
    work.compliance[...], work.held[...] = compliance, held
    work.number[RAW], work.number[UNIT], work.number[OWN, :k] = raw, unit, own
    work.pick[:k, :c] = pick
    part = float(least_part(work, c, k, 1.0))
    return work.number[FORCE].copy(), part


def _pushed(at: Compliance, closed: Sequence[RunContact], directions: np.ndarray) -> np.ndarray:
    """``directions`` (n, c + k), where gaps of contacts that slide push with their friction."""
    pushed = directions.copy()
    for k, contact in enumerate(closed):
        if contact.way is not None and contact.sign:
            pushed[:, k] -= contact.friction * contact.sign * at.generalised([contact.way])[:, 0]
    return pushed


def _multipliers(out: np.ndarray, closed: Sequence[RunContact], rows: np.ndarray, force: np.ndarray) -> np.ndarray:
    """Multipliers of joints and drivers ``out`` (m,), with those of N and T (c + k,) put in."""
    out[rows] = -force
    for k, contact in enumerate(closed):
        if contact.way is not None and contact.sign:
            out[contact.way] = contact.friction * contact.sign * force[k]
    return out
