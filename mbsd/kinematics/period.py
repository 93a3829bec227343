"""The period of a driven mechanism: the time after which every body is back, but for whole turns.

    T      common period of the drivers' laws: q T_1 = p T_2 for T_1 / T_2 = p / q
    K T    period of the mechanism, K the least whole number after which poses, velocities and accelerations are back

After T a body that only turned stands p / q of a turn further (a gear by its teeth, an indexed wheel by its slots),
so K is a multiple of every such q; which one is found by looking at the poses themselves.
"""

from __future__ import annotations

import math
import warnings
from collections.abc import Iterable
from dataclasses import dataclass
from fractions import Fraction
from typing import TYPE_CHECKING

import numpy as np

from mbsd.base.errors import MechanismError, ModelWarning
from mbsd.results.solution import RETURNED, Ends, returned

if TYPE_CHECKING:
    from mbsd.kinematics.prepared import Prepared
    from mbsd.model.joint import Joint
    from mbsd.model.mechanism import Model

MOST_TURNS = 100
"""Common periods of the laws that are looked at."""
RATIONAL = 1e-9
"""A number counts as p / q where it is nearer, relatively; q is no larger than MOST_TURNS."""


@dataclass(frozen=True)
class Repetition:
    """When a mechanism repeats."""

    laws: float | None
    """Common period of the laws (s); None where there is none."""
    turns: int | None
    """Number of these after which every body is back; None if that is not within MOST_TURNS."""

    @property
    def period(self) -> float | None:
        """Period of the mechanism (s)."""
        return None if self.laws is None or self.turns is None else self.turns * self.laws


def period(m: Model) -> float | None:
    """See :meth:`mbsd.mechanism.Mechanism.period`."""
    from mbsd.kinematics.prepared import prepare

    common = common_period(m.drivers.values())
    if common is None:
        return None
    return repetition(m, common, prepare(m, 0.0, common)).period


def common_period(drivers: Iterable[Joint]) -> float | None:
    """Return the least time (s) after which all drivers' laws repeat; None within MOST_TURNS turns.

    An angle repeats after whole turns. A law that holds its value repeats after any time.
    """
    periods = []
    for driver in drivers:
        law = driver.motion
        assert law is not None, "a driver has a law"
        if law.period is None:
            if _holds(law):
                continue
            return None
        ends = law(np.array([0.0, law.period]))
        gap = float(ends[1, 0] - ends[0, 0])
        if driver.kind.angular:
            gap = math.remainder(gap, 2 * math.pi)
        if abs(gap) > RETURNED * max(1.0, abs(float(ends[0, 0]))):
            return None
        periods.append(float(law.period))
    if len(periods) < 2:
        return periods[0] if periods else None
    longest = max(periods)
    turns = 1
    for other in periods:
        ratio = rational(longest / other)
        if ratio is None:
            return None
        turns = math.lcm(turns, ratio.denominator)
    return turns * longest if turns <= MOST_TURNS else None


def repetition(m: Model, common: float, ready: Prepared) -> Repetition:
    """Return when ``m`` repeats, whose laws do so after ``common`` (s); ``ready`` for 0 .. common."""
    from mbsd.kinematics.march import march_along

    march = march_along(ready, np.array([0.0, common]))
    if returned(_ends(march.q, march.v, march.a, 0, 1)):
        return Repetition(common, 1)
    least = _least_turns(_ends(march.q, march.v, march.a, 0, 1))
    if least is None:
        return Repetition(common, None)
    for turns in sorted({max(least, 2), MOST_TURNS // least * least}):
        repeats = _search(m, common, least, turns)
        if repeats is not None:
            return Repetition(common, repeats)
    return Repetition(common, None)


def rational(value: float) -> Fraction | None:
    """Return ``value`` as p / q with q up to MOST_TURNS; None where it is none."""
    fraction = Fraction(value).limit_denominator(MOST_TURNS)
    return fraction if abs(value - float(fraction)) <= RATIONAL * max(1.0, abs(value)) else None


def _holds(law: object) -> bool:
    values = law(np.linspace(0.0, 1.0, 17))  # pyright: ignore[reportCallIssue]
    return bool(np.ptp(values[:, 0]) == 0.0 and not values[:, 1:].any())


def _ends(q: np.ndarray, v: np.ndarray, a: np.ndarray, i: int, j: int) -> Ends:
    def row_of(k: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        return q[k].reshape(-1, 3), v[k].reshape(-1, 3), a[k].reshape(-1, 3)

    return row_of(i), row_of(j)


def _least_turns(ends: Ends) -> int | None:
    """Return the number of turns that divides that of the period; None for a body without whole turns.

    It shows in bodies that stand where they stood, move as they moved, and have turned.
    """
    (q0, v0, a0), (q1, v1, a1) = ends
    least = 1
    for body in range(1, len(q0)):
        place = max(abs(q1[body, :2] - q0[body, :2]))
        rates = max(np.abs(v1[body] - v0[body]).max(), np.abs(a1[body] - a0[body]).max())
        scale = max(1.0, np.abs(v0[body]).max(), np.abs(a0[body]).max())
        if place > RETURNED * max(1.0, float(np.abs(q0[body]).max())) or rates > RETURNED * scale:
            continue
        ratio = rational(float(q1[body, 2] - q0[body, 2]) / (2 * math.pi))
        if ratio is None:
            return None
        least = math.lcm(least, ratio.denominator)
    return least if least <= MOST_TURNS else None


def _search(m: Model, common: float, least: int, turns: int) -> int | None:
    """Return the first multiple of ``least`` up to ``turns`` after which everything is back."""
    from mbsd.kinematics.prepared import prepare

    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", ModelWarning)  # of the motion that is wanted, the sweep itself warns
            return _first_return(prepare(m, 0.0, turns * common), common, least, turns)
    except MechanismError:
        return None  # it comes to a toggle or a limit: it does not repeat


def _first_return(ready: Prepared, common: float, least: int, turns: int) -> int | None:
    from mbsd.kinematics.march import march_along

    march = march_along(ready, common * np.arange(0, turns + 1, least))
    for k in range(1, len(march.q)):
        if returned(_ends(march.q, march.v, march.a, 0, k)):
            return k * least
    return None
