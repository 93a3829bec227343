"""What an event makes of a tangent: its time moves, velocities jump, and accelerations differ before and after.

    t' = -(dg + g_p) / (dg/dt)                   of the scalar g that falls through zero
    y_-' + f_- t'   is mapped by the event's own law, R,  to   y_+' + f_+ t'

Impacts are mapped by differences of the law that the simulation itself uses, in states beside the one before. What
opens, slips or is only noted has neither a jump of velocities nor of accelerations. Source: Bernard, Bentsman, Int. J.
Control 63 (1996); Leine, Nijmeijer, Dynamics and Bifurcations of Non-Smooth Mechanical Systems (2004) (saltation).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from mbsd.base.errors import ModelError
from mbsd.derivatives.numbers import with_value
from mbsd.derivatives.tangents import Tangent, along_direction
from mbsd.derivatives.terms import Along
from mbsd.derivatives.variants import SECOND, Variants
from mbsd.dynamics.events.laws.compliance import Compliance
from mbsd.dynamics.events.laws.impact import impacts
from mbsd.dynamics.events.moment import Moment
from mbsd.dynamics.prepare.prepare import prepare_dynamics
from mbsd.results.solution import Solution

if TYPE_CHECKING:
    from mbsd.derivatives.simulations import SimulationTangents

REACH = 1e-6
"""Of differences of an impact, in sizes, rad, and parts of the fastest speed."""
GRAZING = 1e-9
"""Speed of the scalar of an event, as part of the fastest motion, below which it only touches zero."""
STILL = 1e-9


@dataclass
class Jump:
    """One event, between row ``before`` of a simulation and the next."""

    whole: SimulationTangents
    along: Along
    before: int
    impacts: list[str]
    guard: tuple[str, Any]
    """("gap", row), ("rate", row), ("user", event), or ("none", None)."""
    ends: bool

    def across(self, made: list[Tangent]) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """q', v' (P, 3 nb) after it, and how its time changes (P,) (s by the numbers)."""
        k, along = self.before, self.along
        after = min(k + 1, len(along.t) - 1) if not self.ends else k
        q, v, moved = [], [], np.zeros(len(made))
        for p, (tangent, variants) in enumerate(zip(made, self.whole.variants, strict=True)):
            dq, dv = tangent.q[-1], tangent.v[-1]
            moved[p] = self._time(dq, dv, variants)
            total_q, total_v = dq + along.v[k] * moved[p], dv + along.a[k] * moved[p]
            if self.impacts:
                total_v = self._struck(total_q, total_v, moved[p], variants)
            q.append(total_q - along.v[after] * moved[p])
            v.append(total_v - along.a[after] * moved[p])
        return np.array(q), np.array(v), moved

    def _time(self, dq: np.ndarray, dv: np.ndarray, variants: Variants) -> float:
        """How the time of the event changes with a number."""
        what, which = self.guard
        if what == "none":
            return 0.0
        k = slice(self.before, self.before + 1)
        here = self.along.take(k)
        if what == "user":
            return self._user_time(which, dq, dv, variants)
        terms = self.whole.terms
        part = "position" if what == "gap" else "velocity"
        change = float(getattr(along_direction(terms, here, dq[None], dv[None], SECOND, 1e-5), part)[0, which])
        if what == "rate":  # a difference along q, v holds the part of v as well: J v is linear in it
            assert terms is not None
        change += float(variants.slope(lambda v: getattr(v.terms.left(here), part))[0, which])
        pace = float(terms.left(here).velocity[0, which] if what == "gap" else terms.left(here).acceleration[0, which])
        fastest = float(np.abs(self.along.v).max()) or 1.0
        if abs(pace) <= GRAZING * fastest:
            raise ModelError(
                f"{terms.packed.name}: at t = {self.along.t[self.before]:.6g} s an event is met without speed, so that "
                "a small change may leave it out: there is no derivative beyond it"
            )
        return -change / pace

    def _user_time(self, event: Any, dq: np.ndarray, dv: np.ndarray, variants: Variants) -> float:
        along, k, packed = self.along, self.before, self.whole.terms.packed
        fastest = float(np.abs(along.v).max()) or 1.0
        far = max(float(np.abs(dq).max()), float(np.abs(dv).max()) / fastest, 1e-300)

        def value(packed: Any, t: float, q: np.ndarray, v: np.ndarray) -> float:
            return float(event.value(t, Moment(packed, t, q, v)))

        t, q, v, a = float(along.t[k]), along.q[k], along.v[k], along.a[k]
        h, dt = 1e-5 / far, 1e-6 * max(float(along.t[-1] - along.t[0]), 1e-9)
        change = (value(packed, t, q + h * dq, v + h * dv) - value(packed, t, q - h * dq, v - h * dv)) / (2 * h)
        change += float(variants.slope(lambda variant: np.float64(value(variant.terms.packed, t, q, v))))
        pace = (value(packed, t + dt, q + dt * v, v + dt * a) - value(packed, t - dt, q - dt * v, v - dt * a)) / (2 * dt)
        if not abs(pace) > 0.0:
            raise ModelError(f"{packed.name}: event '{event.name}' is met without speed: there is no derivative of it")
        return -change / pace

    # -- impacts -----------------------------------------------------------------------------------------------------

    def _struck(self, dq: np.ndarray, dv: np.ndarray, dt: float, variants: Variants) -> np.ndarray:
        """(3 nb,) how velocities after the impact change."""
        along, k, whole = self.along, self.before, self.whole
        fastest = float(np.abs(along.v).max()) or 1.0
        far = max(float(np.abs(dq).max()) / whole.terms.packed.size, float(np.abs(dv).max()) / fastest, 1e-300)
        h = REACH / far
        t, q, v = float(along.t[k]), along.q[k], along.v[k]
        ready = whole.ready()
        out = (
            self._after(ready, t + h * dt, q + h * dq, v + h * dv)
            - self._after(ready, t - h * dt, q - h * dq, v - h * dv)
        ) / (2 * h)
        first = variants.variants[0]
        if first.same_places and first.same_masses and not self._law_changes(variants):
            return out
        total = np.zeros_like(out)
        for variant, weight in zip(variants.variants, variants.weights, strict=True):
            value = variants.number.value + variant.offset * variants.step
            with with_value(whole.variation.work, variants.number, value) as m:
                other = prepare_dynamics(m, *whole.span, contacts=True)
            take = other.packed
            take.system = take.system.changed(angle_offset=variant.terms.packed.system.angle_offset)
            total += weight * self._after(other, t, q, v)
        return out + total / variants.step

    def _law_changes(self, variants: Variants) -> bool:
        mine, other = self.whole.terms.packed, variants.variants[0].terms.packed
        return any(
            dict(a.params) != dict(b.params)
            for a, b in zip(mine.joints, other.joints, strict=True)
            if a.name in self.impacts
        )

    def _after(self, ready: Any, t: float, q: np.ndarray, v: np.ndarray) -> np.ndarray:
        """(3 nb,) velocities after the impacts of this event."""
        packed = ready.packed
        at = Compliance(packed, ready.dynamics, ready.switches, t, np.ascontiguousarray(q))
        closed = [contact for contact in ready.switches.contacts if contact.name in self.impacts]
        return impacts(at, closed, v.copy(), STILL / packed.row_scale())[0]


def jumps_of(whole: SimulationTangents, sol: Solution, along: Along, edges: list[int]) -> list[Jump]:
    """The events between the stretches of a simulation, in order; and the one that ended it."""
    out = []
    gaps = sol.packed.contact_gaps()
    users = dict(sol.mechanism.events)
    for edge in edges[1:-1]:
        out.append(_jump(whole, sol, along, edge - 1, gaps, users, ends=False))
    if sol.events and sol.events[-1].what == "end":
        out.append(_jump(whole, sol, along, len(along.t) - 1, gaps, users, ends=True))
    return out


def _jump(whole: Any, sol: Solution, along: Along, row: int, gaps: Any, users: Any, ends: bool) -> Jump:
    t = float(sol.t[row])
    near = 1e-9 * float(sol.t[-1] - sol.t[0])
    here = [event for event in sol.events if abs(event.time - t) <= near]
    struck = [event.name for event in here if event.what == "impact"]
    guard: tuple[str, Any] = ("none", None)
    for event in here:
        if event.what in ("impact", "closes") and event.name in gaps:
            guard = ("gap", gaps[event.name])
            break
        if event.what == "sticks" and event.name in gaps:
            guard = ("rate", gaps[event.name] + 1)
        if event.what in ("event", "end") and event.name in users:
            guard = ("user", users[event.name])
            if users[event.name].action is not None:
                raise ModelError(
                    f"{sol.packed.name}: derivatives beyond the action of event '{event.name}' are not known"
                )
    if guard[0] == "rate" and struck:
        guard = ("gap", gaps[struck[0]])
    return Jump(whole, along, row, struck, guard, ends)
