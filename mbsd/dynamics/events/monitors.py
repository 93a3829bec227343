"""What is monitored along a step: scalars that are not negative now, and mean an event where they fall through zero.

open contact       its gap                      open clutch        its rate
closed contact     its normal force N           sticking contact   mu N - |T|; of a joint its limit less |T|
sliding contact    its speed, sign kept         event of the user  its value, sign kept
at rest, where they share their friction        1 - s, the part of their limits that they need (sharing.py, together.py)
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from mbsd.arrays.friction_along import normals_along
from mbsd.arrays.packing import Packed
from mbsd.arrays.reactions import times_compact
from mbsd.base.arguments import LARGEST
from mbsd.base.errors import ModelError
from mbsd.base.shown import shown
from mbsd.base.users_function import described
from mbsd.dynamics.events.laws.least_part import PULLED
from mbsd.dynamics.events.moment import Moment
from mbsd.dynamics.reference.acceleration import derivative
from mbsd.dynamics.reference.arrays import Dynamics, Scratch
from mbsd.dynamics.rows.held import OPEN, SLIDES, STICKS
from mbsd.dynamics.rows.joint_sticks import JointStick
from mbsd.dynamics.rows.switches import RunContact
from mbsd.equations.assembly import tabulate
from mbsd.model.event import Event

ROUNDING = 1e-10
"""Rounding of forces, as part of the largest."""
CLOSES, LOCKS, OPENS, SLIPS, HALTS, USER = "closes", "locks", "opens", "slips", "halts", "event"


Divide = Callable[[float, np.ndarray, np.ndarray, np.ndarray], tuple[np.ndarray, float]]
"""Multipliers divided, and the part s, from a time (s), a pose and velocities (3 nb,), multipliers (m,)."""


class Samples:
    """Times (S,) with coordinates and velocities (S, 3 nb), and all that monitors read there, computed when asked."""

    def __init__(
        self, packed: Packed, dynamics: Dynamics, scratch: Scratch, t: np.ndarray, q: np.ndarray, v: np.ndarray
    ) -> None:
        self.packed, self.dynamics, self.scratch = packed, dynamics, scratch
        self.t, self.q, self.v = t, np.ascontiguousarray(q), np.ascontiguousarray(v)
        self._rows: tuple[np.ndarray, np.ndarray, np.ndarray] | None = None
        self._lam: np.ndarray | None = None
        self._gamma: np.ndarray | None = None
        self._divided: tuple[np.ndarray, np.ndarray] | None = None

    def residuals(self) -> np.ndarray:
        """(S, m)"""
        return self._tabulated()[0]

    def rates(self) -> np.ndarray:
        """(S, m) J v"""
        return self._tabulated()[1]

    def multipliers(self) -> np.ndarray:
        """(S, m)"""
        if self._lam is None:
            self._lam = np.zeros((len(self.t), len(self.packed.ws.phi)))
            out = np.zeros((2, self.q.shape[1]))
            for k, t in enumerate(self.t):
                derivative(self.dynamics, self.scratch, t, np.stack([self.q[k], self.v[k]]), out, self._lam[k])
        return self._lam

    def divided(self, divide: Divide) -> tuple[np.ndarray, np.ndarray]:
        """Multipliers (S, m) with what rows at rest share divided among them, and the parts s (S,) that they need."""
        if self._divided is None:
            along = zip(self.t, self.q, self.v, self.multipliers(), strict=True)
            shares = [divide(*sample) for sample in along]
            self._divided = np.array([lam for lam, _ in shares]), np.array([part for _, part in shares])
        return self._divided

    def bends(self) -> np.ndarray:
        """(S, m) J a - gamma: second derivatives of the residuals."""
        _, _, compact = self._tabulated()
        a, out, lam = np.zeros_like(self.v), np.zeros((2, self.q.shape[1])), np.zeros(len(self.packed.ws.phi))
        for k, t in enumerate(self.t):
            derivative(self.dynamics, self.scratch, t, np.stack([self.q[k], self.v[k]]), out, lam)
            a[k] = out[1]
        assert self._gamma is not None
        return times_compact(self.packed, compact, a) - self._gamma

    def normals(self) -> np.ndarray:
        """(S, f) normal forces of the joints with friction."""
        return normals_along(self.packed, self.dynamics.loads, self.q, self._tabulated()[2], self.multipliers())

    def _tabulated(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        if self._rows is None:
            rows = len(self.packed.ws.phi)
            phi, gamma = np.zeros((2, len(self.t), rows))
            compact = np.zeros((len(self.t), rows, 6))
            drives = self.packed.drives(self.t)
            tabulate(self.packed.system, drives, self.q, self.v, self.packed.ws, phi, compact, gamma)
            self._gamma = gamma
            self._rows = phi, times_compact(self.packed, compact, self.v), compact
        return self._rows


@dataclass
class Monitor:
    """One scalar."""

    name: str
    what: str
    value: Callable[[Samples], np.ndarray]
    """(S,)"""
    still: float
    """Values above minus this are rounding."""
    contact: RunContact | None = None
    stick: JointStick | None = None
    together: bool = False
    """Whether it is of all that is at rest."""
    event: Event | None = None
    stops: bool = True
    """False for an event of the user that passes zero the other way: it is only noted."""
    leaves: Callable[[Samples], bool] | None = None
    """From the begin and the end of a step: whether the scalar rises away from zero there, by its rates."""


def contact_monitors(
    contact: RunContact, near: np.ndarray, still: np.ndarray, load: float, shares: Divide | None, together: bool
) -> list[Monitor]:
    """Monitors of a contact in its present state. ``near``, ``still`` (m,): rounding.

    ``shares`` divides the forces of what is at rest, ``together`` with contacts that stick.
    """
    gap, way, name, sign = contact.gap, contact.way or 0, contact.name, contact.sign
    if contact.state == OPEN:
        if contact.always_closed:
            return [Monitor(name, LOCKS, lambda s: s.rates()[:, gap], still[gap], contact)]

        def leaves(s: Samples) -> bool:
            return bool((s.rates()[:, gap] > -still[gap]).all() and (s.bends()[0, gap] > 0.0))

        return [Monitor(name, CLOSES, lambda s: s.residuals()[:, gap], near[gap], contact, leaves=leaves)]
    out = [Monitor(name, OPENS, _push(gap, shares, load), ROUNDING * load, contact)]
    if contact.way is None:
        return out
    mu = contact.static_friction
    if contact.state == STICKS:

        def reserve(s: Samples) -> np.ndarray:
            return -mu * s.multipliers()[:, gap] - np.abs(s.multipliers()[:, way])

        if not together:
            out.append(Monitor(name, SLIPS, reserve, ROUNDING * load, contact))
    elif contact.state == SLIDES:
        out.append(Monitor(name, HALTS, lambda s: sign * s.rates()[:, way], still[way], contact))
    return out


def _push(gap: int, shares: Divide | None, load: float) -> Callable[[Samples], np.ndarray]:
    """The normal force of a contact, below zero where no others hold."""
    if shares is None:
        return lambda s: -s.multipliers()[:, gap]

    def push(s: Samples) -> np.ndarray:
        lam, part = s.divided(shares)
        return np.where((part >= PULLED) & (lam[:, gap] > -ROUNDING * load), -load, -lam[:, gap])

    return push


def stick_monitors(
    sticks: Sequence[JointStick], shares: Divide | None, name: str, still: np.ndarray, load: float
) -> list[Monitor]:
    """Monitors of joints that stick by events.

    ``shares`` divides the forces of what is at rest, if that is done; ``name``: of the first of it.
    """
    out, resting = [], []
    for stick in sticks:
        if stick.state == SLIDES and stick.holds:
            out.append(Monitor(stick.name, HALTS, _speed(stick), still[stick.way], stick=stick))
        elif stick.state == STICKS:
            resting.append(stick)
    if shares is not None:
        return [*out, Monitor(name, SLIPS, lambda s: _spare(s, shares), ROUNDING, together=True)]
    return out + [Monitor(stick.name, SLIPS, _reserve(stick), ROUNDING * load, stick=stick) for stick in resting]


def _spare(samples: Samples, shares: Divide) -> np.ndarray:
    """(S,) 1 - s"""
    return 1.0 - np.minimum(samples.divided(shares)[1], 2.0)


def _speed(stick: JointStick) -> Callable[[Samples], np.ndarray]:
    return lambda s: stick.sign * s.rates()[:, stick.way]


def _reserve(stick: JointStick) -> Callable[[Samples], np.ndarray]:
    return lambda s: stick.limit(s.normals()) - np.abs(s.multipliers()[:, stick.way])


def event_monitor(packed: Packed, event: Event, side: float) -> Monitor:
    """Monitor of an event of the user whose value now has the sign ``side``."""

    def value(s: Samples) -> np.ndarray:
        return np.array(
            [
                side * checked(packed, event, Moment(packed, float(t), q, v))
                for t, q, v in zip(s.t, s.q, s.v, strict=True)
            ]
        )

    return Monitor(event.name, USER, value, 0.0, event=event, stops=event.direction in (0, -int(side)))


def checked(packed: Packed, event: Event, moment: Moment) -> float:
    """The value of an event; raises ModelError where the function fails or gives no finite number."""
    what = f"{packed.name}: event '{event.name}'"
    try:
        value = event.value_at(moment)
    except Exception as error:
        raise ModelError(f"{what}: its function fails at t = {moment.t:.6g} s: {described(error)}") from error
    if isinstance(value, np.ndarray) and value.ndim == 0:
        value = value[()]
    number = not isinstance(value, bool) and isinstance(value, int | float | np.floating | np.integer)
    if not number or not -LARGEST <= value <= LARGEST:
        raise ModelError(f"{what} is {shown(value)} at t = {moment.t:.6g} s; it must be a finite number")
    return float(value)
