"""The view of the gas behind a piston: pressure and volume, and what each cycle of its crank gives.

    W = int (p - p_outside) dV over a cycle        indicated work;  over the displaced volume: mean effective pressure

It is the integral of the force's power, by Gauss and Legendre on the quintics through the rows of the motion, in pieces
that end where one phase of the cycle follows another. Over whole cycles the pressure outside does no work.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, fields, replace

import numpy as np

from mbsd.model.cams.profile import hermite
from mbsd.model.force import Chamber, CrankCycle
from mbsd.results.force_view import ForceView
from mbsd.results.moved import Moved

POINTS = 6
"""Number of points of the quadrature between two rows."""
WHOLE = 1e-9
"""Part of a cycle by which a motion may miss a whole number of cycles."""
HALVINGS = 48
"""Number of halvings of a step, to find where a phase ends."""


@dataclass(frozen=True, kw_only=True)
class GasView(ForceView):
    """Force of gas on a piston, with (T,) pressure and volume; cycles count from the first row on."""

    pressure: np.ndarray
    """(T,) absolute (Pa)."""
    volume: np.ndarray
    """(T,) of the gas (m^3)."""
    crank_angle: np.ndarray | None = None
    """(T,) how far the crank has turned, in its own direction, since a top dead centre at which the cylinder fires
    (rad, never wrapped); None of gas without a cycle."""
    cycle_angle: float | None = None
    """Angle of the crank after which the pressure repeats (rad)."""
    displaced: float | None = None
    """Volume between the dead centres (m^3)."""
    indicated_work: np.ndarray | None = None
    """(C,) what the gas gives to the piston in each whole cycle of the motion (J), gas exchange included. Empty where
    the motion has no whole cycle, or its crank turns back."""

    @property
    def mean_effective_pressure(self) -> np.ndarray | None:
        """(C,) indicated work over displaced volume of each cycle (Pa)."""
        return None if self.indicated_work is None or self.displaced is None else self.indicated_work / self.displaced

    def columns(self, title: str) -> dict[str, np.ndarray]:
        """Return the columns of a force, with pressure and volume."""
        out = super().columns(title)
        return out | {f"{title}.pressure [Pa]": self.pressure, f"{title}.volume [m^3]": self.volume}


def gas_view(moved: Moved, view: ForceView, chamber: Chamber, power: Callable[[Moved], np.ndarray]) -> GasView:
    """The view of a force with what its chamber tells; ``power`` (T,) of the force along another motion."""
    assert view.effort is not None, "gas acts along one direction"
    assert view.value is not None
    own = {field.name: getattr(view, field.name) for field in fields(ForceView)}
    own["pressure"] = view.effort / chamber.area + chamber.outside
    own["volume"] = chamber.area * (view.value + chamber.shift)
    if chamber.cycle is None:
        return GasView(**own)
    cycle = chamber.cycle
    return GasView(
        **own,
        crank_angle=_turned(moved, moved.q, cycle, view) - cycle.sense * cycle.fires_at,
        cycle_angle=cycle.period,
        displaced=cycle.displaced,
        indicated_work=_works(moved, view, cycle, power),
    )


def _turned(moved: Moved, state: np.ndarray, cycle: CrankCycle, view: ForceView) -> np.ndarray:
    """Return (T,) of q or v (T, 3 nb): the crank's turn against the cylinder, in its own direction."""
    crank, frame = (3 * moved.packed.body_names.index(name) + 2 for name in (cycle.crank, view.bodies[0]))
    return cycle.sense * (state[:, crank] - state[:, frame])


def _works(moved: Moved, view: ForceView, cycle: CrankCycle, power: Callable[[Moved], np.ndarray]) -> np.ndarray:
    """(C,) of the whole cycles from the first row on."""
    angle = _turned(moved, moved.q, cycle, view) - cycle.sense * cycle.fires_at
    way = 1.0 if angle[-1] >= angle[0] else -1.0
    covered = way * (angle - angle[0])
    count = int(covered[-1] / cycle.period + WHOLE)
    if not count or (np.diff(covered) < 0.0).any():
        return np.zeros(0)
    left = np.flatnonzero(np.diff(moved.t) > 0.0)
    samples = np.stack([moved.q, moved.v, moved.a], axis=-1)
    quintics = hermite(np.diff(moved.t)[left], samples[left], samples[left + 1])
    begins, lasts = moved.t[left], float(moved.t[left[-1] + 1])

    def states(at: np.ndarray) -> Moved:
        """The motion at times within it."""
        step = np.clip(np.searchsorted(begins, at, side="right") - 1, 0, len(begins) - 1)
        ahead = (at - begins[step])[:, None] ** np.arange(6)
        q = np.einsum("sp,scp->sc", ahead, quintics[step])
        v = np.einsum("sp,scp->sc", ahead[:, :5] * np.arange(1, 6), quintics[step][..., 1:])
        return replace(moved, t=at, q=q, v=v, a=np.zeros_like(q), approached=None)

    def covered_at(at: np.ndarray) -> np.ndarray:
        return way * (_turned(moved, states(at).q, cycle, view) - cycle.sense * cycle.fires_at - angle[0])

    ways = [cycle.period * np.arange(1, count + 1)]
    for change in cycle.changes:
        first = (way * (change - angle[0])) % cycle.period
        ways.append(first + cycle.period * np.arange(count))
    wanted = np.concatenate(ways)
    wanted = wanted[(wanted > 0.0) & (wanted < covered[-1])]
    rows = np.clip(np.searchsorted(covered, wanted, side="right") - 1, 0, len(covered) - 2)
    low, high = moved.t[rows], moved.t[rows + 1]
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        before = covered_at(middle) < wanted
        low, high = np.where(before, middle, low), np.where(before, high, middle)
    times = np.unique(np.concatenate([begins, [lasts], low]))
    half, middle = 0.5 * np.diff(times), 0.5 * (times[1:] + times[:-1])
    node, weight = np.polynomial.legendre.leggauss(POINTS)
    at = (middle[:, None] + half[:, None] * node).ravel()
    given = (power(states(at)).reshape(-1, POINTS) * weight).sum(axis=1) * half
    number = np.floor(covered_at(middle) / cycle.period).astype(int)
    inside = (number >= 0) & (number < count)
    return np.bincount(number[inside], weights=given[inside], minlength=count)
