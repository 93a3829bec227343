"""What closed contacts and joints that stick by events do from now on: open, slide or stick.

For contacts that do not separate and joints at rest, in accelerations (complementarity.py):

    0 <= N complementary to g'' >= 0;   sliding: T = -mu N sign(s');   s' = 0: |T| <= L, s'' = 0 or against T

L = mu_s N of a contact, mu_s (N + N_0) of a joint, whose N is the size of a reaction and no unknown of that problem: it
is solved again with the N of the joints that it gives, until both agree, by the iteration of joint_friction.py. T that
several joints at rest can share is shared (sharing.py).
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from mbsd.arrays.friction_along import REMEDY, friction_under, jam, normals_along
from mbsd.base.errors import SimulationError
from mbsd.dynamics.events.bounds import AT_LIMIT, AT_LIMIT_BEYOND, BEGINS, GRAZING, HAIR, PATIENCE, ROUNDING, UNSURE
from mbsd.dynamics.events.laws.complementarity import alone, complementarity, gives_way
from mbsd.dynamics.events.laws.compliance import Compliance
from mbsd.dynamics.events.laws.least_part import PULLED
from mbsd.dynamics.events.laws.sharing import share
from mbsd.dynamics.events.laws.together import divided
from mbsd.dynamics.rows.held import RELEASED, SLIDES
from mbsd.dynamics.rows.joint_sticks import JointStick
from mbsd.dynamics.rows.switches import RunContact
from mbsd.equations.joint_friction import FAINT, MOST_PASSES, SETTLED, X


@dataclass
class Decision:
    """What a closed contact does from now on."""

    contact: RunContact
    normal: float
    """N (N or N m); 0: it opens."""
    sliding: float
    """Sign of the way's rate; 0 where it sticks or has no friction."""


@dataclass
class Verdict:
    """States of all contacts that may stay closed; signs of sliding of all joints that may stick, 0 if one sticks."""

    contacts: list[Decision]
    joints: dict[str, float]


@dataclass
class Case:
    """What is known: velocities (3 nb,), rates below ``still`` (m,) are zero."""

    closed: Sequence[RunContact]
    sticks: Sequence[JointStick]
    v: np.ndarray
    still: np.ndarray
    forced: Mapping[str, float]
    """Contacts by name that leave a sticking point with the sign of their sliding, or come to it (0)."""
    halted: str | None = None
    """The joint that has just come to rest."""
    slipping: bool = False
    """Joints at rest, or all that is at rest together, have just come to the limit of their friction."""
    touched: str | None = None
    """The contact that has just closed without an impact."""
    one_by_one: bool = False
    """Whether contacts come to their limits one by one; see together.py."""


def decide(at: Compliance, case: Case) -> Verdict:
    """For contacts that neither approach nor separate. Raises SimulationError where nothing is possible."""
    sticks = [stick for stick in case.sticks if stick.state != RELEASED]
    if not case.closed and not sticks:
        return Verdict([], {})
    return _Moment(at, case, sticks).verdict()


class _Moment:
    """One event: gaps (c,) and ways at rest (k,), those of contacts first."""

    def __init__(self, at: Compliance, case: Case, sticks: Sequence[JointStick]) -> None:
        self.at, self.case = at, case
        closed, v, still = case.closed, case.v, case.still
        self.gamma = at.gamma(v)
        self.loads = at.loads(v)
        self.gaps = [contact.gap for contact in closed]
        rates = self._rates(sticks)
        self.sliding = np.zeros(len(closed))
        for k, contact in enumerate(closed):
            if contact.way is not None:
                rate = rates[contact.way]
                self.sliding[k] = case.forced.get(
                    contact.name, np.sign(rate) if abs(rate) > still[contact.way] else 0.0
                )
        self.rough = [k for k, contact in enumerate(closed) if contact.way is not None and self.sliding[k] == 0.0]
        self.signs: dict[str, float] = {}
        self.resting = []
        for stick in sticks:
            sign = self._moving(stick, rates[stick.way]) if stick.holds else stick.sign or 1.0
            if sign == 0.0:
                self.resting.append(stick)
            else:
                self.signs[stick.name] = sign
            stick.set(SLIDES, sign)
        self.ways = [closed[k].way or 0 for k in self.rough] + [stick.way for stick in self.resting]
        directions = at.generalised([*self.gaps, *self.ways])
        pushed = directions.copy()
        for k, contact in enumerate(closed):
            if self.sliding[k] != 0.0:
                pushed[:, k] -= contact.friction * self.sliding[k] * at.generalised([contact.way or 0])[:, 0]
        self.directions = directions
        dv, self.lam_of = at.answers(pushed)
        self.compliance = directions.T @ dv
        self.free = np.zeros(len(self.compliance))
        """(c + k,) accelerations of gaps and ways without N and T."""

    def _rates(self, sticks: Sequence[JointStick]) -> dict[int, float]:
        """Rates of all ways by row, those at rest taken to be so exactly: others may be at rest with them."""
        case, at = self.case, self.at
        rows = {contact.way: contact.name for contact in case.closed if contact.way is not None}
        rows |= {stick.way: stick.name for stick in sticks if stick.holds}
        ways = np.array([*rows], np.int64)
        halted = np.array([name == case.halted or case.forced.get(name) == 0.0 for name in rows.values()], bool)
        moved, rates = np.array([self._gives(way) for way in ways], bool), at.rates(ways, case.v)
        resting, known = moved & (halted | (np.abs(rates) <= case.still[ways])), np.zeros_like(halted)
        while not np.array_equal(resting, known):
            known = resting
            rates = at.rates(ways, at.stopped(ways[resting], case.v))
            resting = resting | moved & (np.abs(rates) <= case.still[ways])
        return dict(zip(rows, np.where(halted, 0.0, rates).tolist(), strict=True))

    def _gives(self, way: int) -> bool:
        """False for a way that joints and drivers alone move, or at a turning point of it."""
        direction = self.at.generalised([way])
        return gives_way(self.at, way, float((direction.T @ self.at.answer(direction))[0, 0]))

    def _moving(self, stick: JointStick, rate: float) -> float:
        """The sign of the sliding of a joint, 0 where forces decide it.

        One that they do not move keeps its sign, or has just passed a turning point.
        """
        if abs(rate) > self.case.still[stick.way]:
            return float(np.sign(rate))
        if self._gives(stick.way):
            return 0.0
        return -stick.sign if stick.name == self.case.halted else stick.sign or 1.0

    def verdict(self) -> Verdict:
        closed, rough, c = self.case.closed, self.rough, len(self.gaps)
        pick = np.zeros((len(self.ways), c))
        pick[np.arange(len(rough)), rough] = [closed[k].static_friction for k in rough]
        forces, limits, largest = self._agreed(pick)
        normal, along = forces[:c], forces[c:]
        limits = self._hair * pick @ normal + limits
        left = self._left(forces, limits)
        contacts = []
        for k, contact in enumerate(closed):
            holds = normal[k] > 1e-12 * largest
            direction = self.sliding[k]
            if not holds and contact.name == self.case.touched and self._begins(k, forces):
                if k in rough:
                    direction = float(np.sign(left[rough.index(k)]))
                contacts.append(Decision(contact, BEGINS, direction))
                continue
            if k in rough and holds:
                w = rough.index(k)
                if abs(along[w]) >= limits[w] * (1.0 - AT_LIMIT) and (left[w] or self.case.one_by_one):
                    direction = -float(np.sign(along[w]))
            contacts.append(Decision(contact, float(normal[k]) if holds else 0.0, direction))
        breaking = {
            decision.contact.name: decision.sliding
            for k, decision in enumerate(contacts)
            if k in rough and decision.sliding != 0.0 and decision.contact.static_friction > decision.contact.friction
        }
        if breaking:
            return decide(self.at, replace(self.case, forced={**self.case.forced, **breaking}))
        for w, stick in enumerate(self.resting, len(rough)):
            self.signs[stick.name] = float(np.sign(left[w]))
        return Verdict(contacts, self.signs)

    def _begins(self, k: int, forces: np.ndarray) -> bool:
        """Whether gap k neither opens nor needs a push yet: it closes because its push begins now.

        So it is where the load of a box passes over its middle foot, from one outer foot to the other.
        """
        acting = np.append(self.compliance[k] * forces, self.free[k])
        return abs(float(acting.sum())) <= GRAZING * float(np.abs(acting).max())

    def _left(self, forces: np.ndarray, limits: np.ndarray) -> np.ndarray:
        """(k,) accelerations of the ways under N and T (c + k,), zero where friction up to ``limits`` (k,) holds."""
        c = len(self.gaps)
        left, own = (self.compliance @ forces + self.free)[c:], np.diag(self.compliance)[c:]
        others = np.abs(left - own * forces[c:])
        rounding = AT_LIMIT_BEYOND if self.case.slipping else AT_LIMIT
        zero = np.maximum(rounding * np.maximum(own * limits, others), UNSURE * np.abs(self.free[c:]))
        return np.where(np.abs(left) <= zero, 0.0, left)

    def _agreed(self, pick: np.ndarray) -> tuple[np.ndarray, np.ndarray, float]:
        """N and T (c + k,), the limits (k,) of joints at rest under them, and the largest load."""
        moving = np.zeros(len(self.ways))
        pushing = np.zeros(len(self.gaps), bool)

        def decided(limits: np.ndarray) -> np.ndarray:
            at, closed, rates = self.at, self.case.closed, self.free
            both = complementarity(at, closed, self.ways, self.compliance, rates, self._hair * pick, limits)
            forces = self._shared(np.concatenate(both), self._hair * pick, limits)
            left = self._left(forces, self._hair * pick @ both[0] + limits)
            if left.any():
                moving[:], pushing[:] = np.sign(left), both[0] > 0.0
            return forces

        try:
            return self._repeated(decided)
        except SimulationError:
            if not self.case.slipping or not moving.any():
                raise
            given = self._given_way(self._hair * pick, moving, pushing)
            if given is None:
                raise
            return given

    def _given_way(
        self, pick: np.ndarray, moving: np.ndarray, pushing: np.ndarray
    ) -> tuple[np.ndarray, np.ndarray, float] | None:
        """The same where ways with signs ``moving`` (k,) give way and gaps ``pushing`` (c,) stay closed, if they do so.

        What is at rest may hold each other by forces that no longer act once they move: with those they are pressed as
        if they moved they could hold, and the other way round. Where nothing holds them under its own forces they move.
        """
        c = len(self.gaps)
        rows = np.concatenate([np.flatnonzero(pushing), c + np.flatnonzero(moving == 0.0)])
        spread = np.zeros((c + len(moving), len(rows)))
        spread[rows, np.arange(len(rows))] = 1.0
        spread[c:] -= moving[:, None] * (pick @ spread[:c])

        def solved(limits: np.ndarray) -> np.ndarray:
            given = np.concatenate([np.zeros(c), -moving * limits])
            needed = -(self.free + self.compliance @ given)[rows]
            return given + spread @ np.linalg.lstsq(self.compliance[rows] @ spread, needed, rcond=1e-12)[0]

        try:
            forces, limits, largest = self._repeated(solved)
        except SimulationError:
            return None
        bends = self.compliance @ forces + self.free
        most = pick @ forces[:c] + limits
        left = self._left(forces, most)
        opening = bends[:c][~pushing] >= 0.0
        agrees = (np.sign(left) == moving).all() and (forces[:c] >= 0.0).all() and opening.all()
        return (forces, limits, largest) if agrees and (np.abs(forces[c:]) <= most * (1.0 + AT_LIMIT)).all() else None

    def _repeated(self, solve: Callable[[np.ndarray], np.ndarray]) -> tuple[np.ndarray, np.ndarray, float]:
        """N and T that ``solve`` gives for limits (k,) of joints, until the normal forces of joints agree."""
        at, v = self.at, self.case.v
        packed, loads = at.packed, at.dynamics.loads
        x = np.nan_to_num(loads.normal[X].copy())
        last, weight = np.zeros_like(x), 1.0
        for passes in range(MOST_PASSES):
            load = self.loads + friction_under(packed, loads, at.q[None], v[None], x[None])[0]
            a, lam = at.accelerations(load, self.gamma)
            self.free = self.directions.T @ a - self.gamma[[*self.gaps, *self.ways]]
            limits = np.array([0.0] * len(self.rough) + [self._hair * stick.limit(x) for stick in self.resting])
            forces = solve(limits)
            normal_forces = normals_along(
                packed, loads, at.q[None], at.compact[None], (lam + self.lam_of @ forces)[None]
            )[0]
            gap = normal_forces - x
            largest = float(np.abs(load[3:]).max(initial=0.0))
            part = SETTLED if passes < PATIENCE else ROUNDING
            if not len(x) or np.abs(gap).max() <= part * max(normal_forces.max(), FAINT * largest):
                return forces, limits, largest
            bend = gap - last
            square = float(bend @ bend)
            weight = float(np.clip(-weight * (last @ bend) / square, -10.0, 10.0)) if passes and square else 1.0
            last = gap
            x = np.maximum(x + weight * gap, 0.0)
        raise SimulationError(f"{packed.name}: at t = {at.time:.6g} s {jam(packed, x)}. {REMEDY}.")

    @property
    def _hair(self) -> float:
        return 1.0 - HAIR if self.case.slipping else 1.0

    def _shared(self, forces: np.ndarray, pick: np.ndarray, limits: np.ndarray) -> np.ndarray:
        """T of joints that stay at rest, shared where that changes no motion; with contacts that stick N, too.

        ``pick`` (k, c) N and ``limits`` (k,) are what friction may be.
        """
        c = len(self.gaps)
        still = np.flatnonzero(self._left(forces, pick @ forces[:c] + limits) == 0.0)
        within = still[still >= len(self.rough)]
        pushing = np.flatnonzero(forces[:c] > 0.0)
        sticking = [w for w in still[still < len(self.rough)] if self.rough[w] in pushing]
        out = forces.copy()
        if sticking and len(within):
            members = np.array([*sticking, *within])
            rows = np.array([*pushing, *(c + members)])
            unit = 1.0 / np.sqrt(alone(self.at, [[*self.gaps, *self.ways][row] for row in rows]))
            g, part = self.compliance[np.ix_(rows, rows)], np.ix_(members, pushing)
            shares, needed = divided(g, forces[rows], unit, pick[part], limits[members], np.ones(len(rows)))
            if needed != PULLED:
                out[rows] = shares
        elif len(within) > 1:
            rows = c + within
            out[rows] = share(self.compliance[np.ix_(rows, rows)], forces[rows], limits[within])[0]
        return out
