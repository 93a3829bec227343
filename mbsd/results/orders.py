"""Harmonics of a quantity that repeats with the crank: amplitude, phase, forward and backward parts.

    f(phi) = mean + sum_k amplitude_k cos(k phi + phase_k)                        a scalar, or a component of a vector
    fx + i fy = mean + sum_k [forward_k e^(i k phi) + backward_k e^(-i k phi)]    a vector: an ellipse of order k

phi is the angle of the crank (rad), a body on a pin of ground that turns round and round, so phases do not depend on
where the motion starts. What repeats every second turn only, as a four-stroke engine does, has orders 0.5, 1, 1.5 and
so on. A force whose first order has no backward part turns with the crank, and a counterweight on the crank cancels it.

Source: Maass, Klier, Kraefte, Momente und deren Ausgleich in der Verbrennungskraftmaschine, 1981.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np
from scipy.interpolate import CubicSpline

from mbsd.base.errors import ModelError


def crank_of(sol: Any) -> str:
    """Return the crank's name: of bodies that turn a whole turn one way, a driven one, else the first.

    ``sol`` is the Solution. Raises ModelError where none does.
    """
    m = sol.mechanism
    on_ground = [_moving(m, joint) for joint in m.joints.values() if joint.kind.pair == "pin" and _grounded(m, joint)]
    driven = [_moving(m, driver) for driver in m.drivers.values() if driver.kind.angular and _grounded(m, driver)]
    for name in (*driven, *on_ground):
        if _turns(sol.body(name).theta):
            return name
    turning = f"of {', '.join(on_ground)} none does" if on_ground else "nothing is on a pin of ground"
    raise ModelError(
        f"{m.name}: orders need a crank, a body on a pin of ground that turns one way by a whole turn; {turning}. "
        "Name a body that turns with crank=, or solve over a longer duration"
    )


def _grounded(m: Any, joint: Any) -> bool:
    return m.ground in (joint.i.body, joint.j.body) and joint.i.body is not joint.j.body


def _moving(m: Any, joint: Any) -> str:
    return (joint.j if joint.i.body is m.ground else joint.i).body.name


def _turns(angle: np.ndarray) -> bool:
    """Return True if an angle (T,) goes one way, by a turn at least."""
    steps = np.diff(angle)
    one_way = bool((steps >= 0).all() or (steps <= 0).all())
    return one_way and abs(angle[-1] - angle[0]) >= 2 * math.pi * (1 - WHOLE)


@dataclass(frozen=True, eq=False)
class Turning:
    """Both parts of harmonic vectors, (K,) complex: real part along x, imaginary part along y at phi = 0."""

    forward: np.ndarray
    """(K,) turns with the crank."""
    backward: np.ndarray
    """(K,) turns against the crank."""

    @property
    def largest(self) -> np.ndarray:
        """(K,) size where the vector is largest on the turn."""
        return np.abs(self.forward) + np.abs(self.backward)

    @property
    def smallest(self) -> np.ndarray:
        """(K,) size where the vector is smallest on the turn; 0 where it swings along a line."""
        return np.abs(np.abs(self.forward) - np.abs(self.backward))

    @property
    def along_x(self) -> np.ndarray:
        """(K,) amplitude of the component along x."""
        return np.abs(self.forward + self.backward.conj())

    @property
    def along_y(self) -> np.ndarray:
        """(K,) amplitude of the component along y."""
        return np.abs(self.forward - self.backward.conj())


WHOLE = 1e-6
"""Turns: what misses a whole number by less is one."""
SAMPLES = 1024
"""Steps of a turn where the rows are not equally far apart in the angle, at least."""
EVEN = 1e-9
"""Largest distance of a row from an equal step of the angle (rad)."""
REPEATS = 1e-6
"""Part of the largest value by which a quantity may differ after a cycle that it repeats."""


@dataclass(frozen=True, eq=False)
class Orders(Turning):
    """Harmonics against the angle of a crank, (K,) by rising order from the lowest above 0.

    Of a scalar ``forward`` and ``backward`` are conjugate halves of its amplitude.
    """

    crank: str
    turns: int
    """Turns of the crank in one cycle."""
    order: np.ndarray
    """(K,) periods in a turn of the crank: 1 / turns, 2 / turns, ..."""
    mean: np.ndarray
    """() of a scalar, (2,) of a vector."""
    amplitude: np.ndarray
    """(K,) of a scalar, (K, 2) of a vector along x and y, never negative."""
    phase: np.ndarray
    """Like ``amplitude`` (rad): f = amplitude cos(order phi + phase)."""
    gap: float
    """Distance of the quantity from its value one cycle before, as part of its largest value: 0 where it repeats."""

    def index(self, order: float) -> int:
        """The row of an order. Raises ModelError for one that is not there."""
        row = round(order * self.turns) - 1
        if not 0 <= row < len(self.order) or abs(self.order[row] - order) > 1e-9:
            raise ModelError(
                f"orders of '{self.crank}': there is no order {order:g}; they go from {self.order[0]:g} to "
                f"{self.order[-1]:g} by {self.order[0]:g}"
            )
        return row


def orders(crank: str, angle: np.ndarray, values: np.ndarray, turns: int | None = None) -> Orders:
    """Return harmonics of ``values`` (T,) or (T, 2) over the last cycle of a crank of ``angle`` (T,).

    The angle (rad) goes one way.

    A cycle has ``turns`` whole turns; None takes the least number after which the quantity repeats, and one turn where
    it does not repeat, which ``gap`` tells. Raises ModelError for less than a cycle and an angle that goes back.
    """
    direction = _direction(crank, angle, values)
    covered = int(abs(angle[-1] - angle[0]) / (2 * math.pi) + WHOLE)
    if covered < (turns or 1):
        raise ModelError(
            f"orders: '{crank}' makes {abs(angle[-1] - angle[0]) / (2 * math.pi):.4g} turns, and a cycle has "
            f"{turns or 1}; solve over a longer duration"
        )
    turned = direction * angle
    if turns is None:
        gaps = {n: _gap(turned, values, n) for n in range(1, covered + 1)}
        turns = next((n for n, gap in gaps.items() if gap <= REPEATS), 1)
    sampled = _last_cycle(turned, values, turns)
    count = (len(sampled) - 1) // 2
    k = np.arange(1, count + 1) / turns
    terms = np.fft.rfft(sampled, axis=0)[1 : count + 1] / len(sampled)
    terms = terms if direction > 0 else terms.conj()
    terms *= np.exp(-1j * k * (angle[-1] - direction * 2 * math.pi * turns)).reshape(-1, *(1,) * (values.ndim - 1))
    x, y = terms.T if values.ndim == 2 else (terms, np.zeros_like(terms))
    return Orders(
        x + 1j * y, x.conj() + 1j * y.conj(), crank, turns, k, sampled.mean(axis=0),
        2 * np.abs(terms), np.angle(terms), _gap(turned, values, turns),
    )  # fmt: skip


def _direction(crank: str, angle: np.ndarray, values: np.ndarray) -> float:
    """1 for a crank that turns counter-clockwise, else -1. Raises ModelError for what has no orders."""
    if values.shape not in ((len(angle),), (len(angle), 2)):
        raise ModelError(
            f"orders: the quantity has the shape {values.shape}; it must be ({len(angle)},) or ({len(angle)}, 2), "
            "one row for each time of the solution"
        )
    if not np.isfinite(values).all():
        raise ModelError("orders: the quantity is not finite at all times")
    direction = 1.0 if angle[-1] >= angle[0] else -1.0
    if (direction * np.diff(angle) < 0.0).any():
        raise ModelError(
            f"orders: '{crank}' turns back on its way; orders count periods in a turn of a body that turns one way, "
            "so name another one as crank"
        )
    return direction


def _gap(turned: np.ndarray, values: np.ndarray, turns: int) -> float:
    """Return the relative gap of the last turn to the one ``turns`` before, or of its end.

    It is relative to the largest value; its end counts if no more is known.
    """
    largest = float(np.abs(values).max())
    if largest == 0.0:
        return 0.0
    span = 2 * math.pi * turns
    ends = turned[turned >= max(turned[0] + span, turned[-1] - 2 * math.pi) - EVEN]
    before = np.maximum(ends - span, turned[0])
    return float(np.abs(_resampled(turned, values, ends) - _resampled(turned, values, before)).max()) / largest


def _last_cycle(turned: np.ndarray, values: np.ndarray, turns: int) -> np.ndarray:
    """(N, ...) at equal steps of the angle over the last cycle, its end left out."""
    first = turned[-1] - 2 * math.pi * turns
    start = int(np.argmin(np.abs(turned - first)))
    rows = len(turned) - 1 - start
    if rows and np.abs(turned[start:] - np.linspace(first, turned[-1], rows + 1)).max() <= EVEN:
        return values[start:-1]
    count = turns * max(SAMPLES, 2 * len(turned) // turns)
    return _resampled(turned, values, np.linspace(first, turned[-1], count, endpoint=False))


def _resampled(x: np.ndarray, values: np.ndarray, at: np.ndarray) -> np.ndarray:
    """Values at ``at``: cubic splines, one between each two jumps, where two rows share their angle."""
    out = np.empty((len(at), *values.shape[1:]))
    bounds = [0, *(np.flatnonzero(np.diff(x) <= 0) + 1), len(x)]
    for low, high in pairwise(bounds):
        inside = (at >= x[low]) & (at <= x[high - 1]) if low else at <= x[high - 1]
        if inside.any():
            out[inside] = values[low] if high - low < 2 else CubicSpline(x[low:high], values[low:high])(at[inside])
    return out
