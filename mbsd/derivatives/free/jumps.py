"""Jumps of a tangent at an event: its time moves, velocities jump, and accelerations differ before and after.

    t' = -(dg + g_p) / (dg/dt)                   of the scalar g that falls through zero (guards.py)
    y_-' + f_- t'   is mapped by the event's own law, R,  to   y_+' + f_+ t'

Impacts are mapped by differences of the law that the simulation itself uses, in states beside the one before; contacts
that rest before and after it stay at rest. Where a contact begins to stick or to slide, turns round, or comes to the
end of an outline's face, velocities go on and accelerations jump. What opens as its force vanishes, or is only noted,
has neither a jump of velocities nor of accelerations. Source: Bernard, Bentsman, Int. J. Control 63 (1996);
Leine, Nijmeijer, Dynamics and Bifurcations of Non-Smooth Mechanical Systems (2004) (saltation).
"""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import dataclass, field, replace
from typing import Any, Protocol

import numpy as np

from mbsd.base.errors import ModelError
from mbsd.derivatives.driven.tangents import per_scales
from mbsd.derivatives.free.guards import USER, End, Guard, guards_of, times_moved
from mbsd.derivatives.free.guards import contacts_of as packed_contacts
from mbsd.derivatives.free.indexing import is_index
from mbsd.derivatives.numbers.terms import Along, Terms
from mbsd.derivatives.numbers.variants import Variant, Variants, Variation
from mbsd.dynamics.events.arrays import TOUCHING
from mbsd.dynamics.events.jumps import strike
from mbsd.dynamics.events.packing import contacts_of
from mbsd.dynamics.prepare.prepare import prepare_dynamics
from mbsd.dynamics.prepare.prepared import PreparedDynamics
from mbsd.dynamics.reference.arrays import scratch_for
from mbsd.dynamics.state import start_state
from mbsd.numbers.names import with_value
from mbsd.results.solution import Solution

REACH = 1e-6
"""Reach of the differences of an impact, in sizes, rad, and parts of the fastest speed."""


class Whole(Protocol):
    """The simulation that the events are of; see simulations.py."""

    terms: Terms
    variation: Variation
    span: tuple[float, float]

    @property
    def variants(self) -> list[Variants]:
        """The mechanism with other values of each number."""
        ...

    def ready(self) -> PreparedDynamics:
        """The mechanism as a simulation begins with it."""
        ...

    def stretch_rows(self, along: Along, k: int) -> np.ndarray:
        """Independent rows that hold at node k."""
        ...


@dataclass
class Plain:
    """An impact of one contact without friction."""

    joint: int
    row: int
    rows: np.ndarray
    """Independent rows that hold."""
    restitution: float
    """Zero where it does not bounce."""


@dataclass
class Jump:
    """One event, between row ``before`` of a simulation and the next."""

    whole: Whole
    along: Along
    before: int
    impacts: list[str]
    guards: list[Guard]
    ends: bool
    plain: Plain | None = None
    by_numbers: dict[int, np.ndarray] = field(default_factory=dict)
    """(3 nb,) how velocities after the impact change with some numbers, at the held state before it."""

    def across(self, tangent: End) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """q', v' (P, 3 nb) after it, and how its time changes (P,) (s by the numbers); from those before it."""
        k, along = self.before, self.along
        after = k if self.ends else k + 1
        moved = times_moved(self.whole.terms, self.whole.variants, along, k, self.guards, tangent)[:, None]
        total_q, total_v = tangent.q + along.v[k] * moved, tangent.v + along.a[k] * moved
        if self.impacts:
            total_v = self._struck(total_q, total_v, moved[:, 0])
        return total_q - along.v[after] * moved, total_v - along.a[after] * moved, moved[:, 0]

    # -- impacts -----------------------------------------------------------------------------------------------------

    def _struck(self, dq: np.ndarray, dv: np.ndarray, dt: np.ndarray) -> np.ndarray:
        """(P, 3 nb) how velocities after the impact change."""
        along, k, whole = self.along, self.before, self.whole
        per_size, per_speed = per_scales(whole.terms, along)
        far = np.maximum(np.abs(dq * per_size).max(axis=1), np.abs(dv * per_size).max(axis=1) * per_speed)
        h = (REACH / np.where(far > 0.0, far, 1.0))[:, None]
        t, q, v, plain = along.t[k] + 0.0 * dt, along.q[k], along.v[k], self.plain
        both = []
        for sign in (1.0, -1.0):
            state = t + sign * h[:, 0] * dt, q + sign * h * dq, v + sign * h * dv
            if plain is None:
                both.append(
                    np.array([self._after(whole.ready(), whole.terms, *each) for each in zip(*state, strict=True)])
                )
            else:
                both.append(bounced(whole.terms, plain, *state, plain.restitution))
        out = (both[0] - both[1]) / (2 * h)
        for p, variants in enumerate(whole.variants):
            if p in self.by_numbers:
                out[p] += self.by_numbers[p]
            elif plain is None and self.changes_with(variants):
                out[p] += self._by_number(variants, float(t[0]), q, v)
        return out

    def changes_with(self, variants: Variants) -> bool:
        """Return True if a number changes the law of the impact, or places or masses that it depends on."""
        first, mine = variants.variants[0], self.whole.terms.packed
        if not (first.same_places and first.same_masses):
            return True
        pairs = zip(mine.joints, first.terms.packed.joints, strict=True)
        return any(dict(a.params) != dict(b.params) for a, b in pairs if a.name in self.impacts)

    def _by_number(self, variants: Variants, t: float, q: np.ndarray, v: np.ndarray) -> np.ndarray:
        """(3 nb,) the same by a number at a held state, by the law of the simulation itself."""
        whole, total = self.whole, np.zeros(len(q))
        for variant, weight in zip(variants.variants, variants.weights, strict=True):
            value = variants.number.value + variant.offset * variants.step
            with with_value(whole.variation.work, variants.number, value, whole.variation.saved) as m:
                other = prepare_dynamics(m, *whole.span, contacts=True)
            take = other.packed
            take.system = take.system.changed(angle_offset=variant.terms.packed.system.angle_offset)
            total += weight * self._after(other, variant.terms, t, q, v)
        return total / variants.step

    def plain_law(self) -> Plain | None:
        """Return what the law needs where a single contact without friction is struck."""
        packed = self.whole.terms.packed
        assert self.along.held is not None
        held = np.flatnonzero(self.along.held[self.before])
        if (
            len(set(self.impacts)) != 1
            or (self.whole.terms.inertia[3:] == 0.0).any()
            or (held >= packed.contact_rows).any()
        ):
            return None
        names = [joint.name for joint in packed.joints]
        joint = names.index(self.impacts[0])
        params, row = packed.joints[joint].params, packed.rows_of(joint).start
        if params.get("friction", 0.0):
            return None
        here = self.along.take(slice(self.before, self.before + 2))
        rates = self.whole.terms.left(here).velocity[:, row]
        bounced = rates[1] > 0.5 * params.get("restitution", 0.0) * abs(rates[0])
        rows = self.whole.stretch_rows(self.along, self.before)
        return Plain(joint, row, rows, float(params.get("restitution", 0.0)) if bounced else 0.0)

    def _after(self, ready: Any, terms: Terms, t: float, q: np.ndarray, v: np.ndarray) -> np.ndarray:
        """(3 nb,) velocities after the impacts of this event; contacts that go on to rest stay at rest."""
        after = velocities_after(ready, t, q, v, self.impacts)
        here = self.along.take(slice(self.before, self.before + 2))
        resting = [k for k, joint in packed_contacts(terms.packed) if joint.name not in self.impacts]
        if self.ends or here.held is None or not any(here.held[:, terms.packed.first_row[k]].all() for k in resting):
            return after
        rows = self.whole.stretch_rows(self.along, self.before + 1)
        state = replace(here.take(slice(1, 2)), t=np.array([t]), q=q[None], v=after[None])
        jac, rates = terms.packed.spread(terms.rows(state)[2])[0][rows], terms.left(state).velocity[0, rows]
        after[3:] -= solve_with_rows(terms, jac[None], np.zeros((1, jac.shape[1])), rates[None])[0]
        return after


def fill_by_numbers(whole: Whole, along: Along, jumps: Sequence[Jump]) -> None:
    """Find how plain impacts change with each number at the held states before them, all alike ones at once."""
    alike: dict[tuple[Any, ...], list[Jump]] = {}
    for jump in jumps:
        jump.plain = plain = jump.plain_law() if jump.impacts else None
        if plain is not None:
            alike.setdefault((plain.joint, plain.rows.tobytes(), plain.restitution), []).append(jump)
    for own in alike.values():
        plain, rows = own[0].plain, [jump.before for jump in own]
        assert plain is not None
        t, q, v = along.t[rows], along.q[rows], along.v[rows]
        for p, variants in enumerate(whole.variants):
            if own[0].changes_with(variants):
                bounces = np.array([_bounced_with(variant, plain, t, q, v) for variant in variants.variants])
                slopes = np.tensordot(variants.weights, bounces, axes=1) / variants.step
                for jump, part in zip(own, slopes, strict=True):
                    jump.by_numbers[p] = part


def _bounced_with(variant: Variant, plain: Plain, t: np.ndarray, q: np.ndarray, v: np.ndarray) -> np.ndarray:
    """(S, 3 nb) velocities after an impact of a variant."""
    restitution = float(variant.terms.packed.joints[plain.joint].params.get("restitution", 0.0))
    return bounced(variant.terms, plain, t, q, v, restitution if plain.restitution else 0.0)


def bounced(terms: Terms, plain: Plain, t: np.ndarray, q: np.ndarray, v: np.ndarray, restitution: float) -> np.ndarray:
    """(S, 3 nb) velocities after, v - a (1 + e) J v / (J a), a: what an impulse along J makes of velocities."""
    state = Along(t, q, v, v, np.zeros((len(t), len(terms.packed.ws.phi))))
    jac = terms.packed.spread(terms.rows(state)[2])
    answer = solve_with_rows(terms, jac[:, plain.rows], jac[:, plain.row], np.zeros((len(t), len(plain.rows))))
    rate = (jac[:, plain.row] * v[:, 3:]).sum(axis=1)
    size = (1.0 + restitution) * rate / (jac[:, plain.row] * answer).sum(axis=1)
    out = v.copy()
    out[:, 3:] -= size[:, None] * answer
    return out


def solve_with_rows(terms: Terms, rows: np.ndarray, push: np.ndarray, rates: np.ndarray) -> np.ndarray:
    """Return x (S, n) of M x + R^T m = push (S, n), R x = rates (S, r), for rows R (S, r, n)."""
    n, count = rows.shape[2], rows.shape[1]
    matrix = np.zeros((len(rows), n + count, n + count))
    matrix[:, :n, :n] = np.diag(terms.inertia[3:])
    matrix[:, :n, n:], matrix[:, n:, :n] = rows.transpose(0, 2, 1), rows
    return np.linalg.solve(matrix, np.concatenate([push, rates], axis=1)[..., None])[:, :n, 0]


def jumps_of(whole: Whole, sol: Solution, along: Along, edges: list[int]) -> list[Jump]:
    """The events between the stretches of a simulation, in order; and the one that ended it."""
    out = [_jump(whole, sol, along, edge - 1, ends=False) for edge in edges[1:-1]]
    if sol.events and sol.events[-1].what == "end":
        out.append(_jump(whole, sol, along, len(along.t) - 1, ends=True))
    fill_by_numbers(whole, along, out)
    return out


def _jump(whole: Whole, sol: Solution, along: Along, row: int, ends: bool) -> Jump:
    t = float(sol.t[row])
    near = 1e-9 * float(sol.t[-1] - sol.t[0])
    here = [event for event in sol.events if abs(event.time - t) <= near]
    users = dict(sol.mechanism.events)
    for event in here:
        if event.what in ("event", "end") and event.name in users and users[event.name].acts:
            raise ModelError(f"{sol.packed.name}: derivatives beyond what event '{event.name}' changes are not known")
    struck = [event.name for event in here if event.what == "impact"]
    if ends:
        name = sol.events[-1].name
        return Jump(whole, along, row, struck, [Guard(USER, name, event=users[name])], ends)
    guards = guards_of(sol.packed, along, row, struck)
    names = dict.fromkeys(event.name for event in here if event.what == "event")
    guards += [Guard(USER, name, event=users[name]) for name in names if is_index(users.get(name))]
    return Jump(whole, along, row, struck, guards, ends)


def velocities_after(
    ready: PreparedDynamics, t: float, q: np.ndarray, v: np.ndarray, names: Collection[str]
) -> np.ndarray:
    """Return velocities (3 nb,) after the impacts of contacts by name, at t (s) and q, v (3 nb,).

    Raises ArithmeticError where no impulses are possible.
    """
    packed = ready.packed
    state = start_state(np.stack([q, v]), len(packed.ws.phi), t)
    contacts = contacts_of(ready, state, [], ready.end - ready.start, None)
    for k, contact in enumerate(ready.switches.contacts):
        contacts.chosen[TOUCHING, k] = contact.name in names
    scratch = scratch_for(ready.dynamics, packed.ws, len(packed.motions), 1, (0, 0))
    if not strike(ready.dynamics, scratch, contacts, t, state.y):
        raise ArithmeticError(f"{packed.name}: at t = {t:.6g} s no impulses of contacts are possible")
    return state.y[1]
