"""The bank angle of a V engine: unbalanced forces and couples, firing intervals and torque over it.

With two rods on a throw, b apart, order n of both has a part that turns with the shaft and one that turns against it:

    forward_n = cos((n - 1) b / 2),   backward_n = cos((n + 1) b / 2)          of both, in units of A_n m r w^2

so the forward first order is there at every angle, and counterweights cancel it; the backward one vanishes at b = 90
degrees alone. What the throws add to this is in :mod:`mbsd.machines.engines.free_forces`.

Torque: of the gas alone, each cylinder's T(phi) shifted by its firing angle a_k; with C_n the harmonics of one over its
cycle, the engine has C_n sum_k e^(-2 pi i n a_k / cycle), summed exactly.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from mbsd.base.errors import ModelError
from mbsd.machines.engines.engine import engine
from mbsd.machines.engines.firing import firing
from mbsd.machines.engines.free_forces import FreeForces, free_forces
from mbsd.machines.engines.layout import INLINE_THROWS, Layout, even_split, vee
from mbsd.model.cylinders.cycle import GasCycle

ORDERS = (1, 2, 4, 6)
NOTHING = 1e-9
"""Fraction of m r w^2, for couples times the spacing: less counts as no force, no couple."""
EVEN = 1e-6
"""rad"""
NARROWEST = 30.0
"""Degrees: narrower banks, whose cylinders would stand in each other's way, are drawn and are not the best."""


@dataclass(frozen=True)
class Family:
    """V engines of all bank angles: their throws (degrees), each with one pin or two split pins."""

    name: str
    throws: tuple[float, ...]
    split: bool = False
    """The two pins of a throw are apart so that it fires evenly at every angle."""

    @property
    def cylinders(self) -> int:
        """Two on each throw."""
        return 2 * len(self.throws)

    def layout(self, angle: float) -> Layout:
        """Return the layout with an angle between its banks (degrees)."""
        return vee(angle, self.throws, even_split(angle, self.cylinders) if self.split else 0.0)


FAMILIES = (
    Family("V2, one pin", (0,)),
    Family("V2, two pins, even", (0,), split=True),
    Family("V4, two pins", (0, 180)),
    Family("V4, four pins, even", (0, 180), split=True),
    Family("V6, three pins", (0, 120, 240)),
    Family("V6, six pins, even", (0, 120, 240), split=True),
    Family("V8, cross crank", (0, 90, 270, 180)),
    Family("V8, flat crank", (0, 180, 180, 0)),
    Family("V8, crank 0-90-180-270", (0, 90, 180, 270)),
    Family("V10, five pins", INLINE_THROWS[5]),
    Family("V10, ten pins, even", INLINE_THROWS[5], split=True),
    Family("V12", INLINE_THROWS[6]),
)


@dataclass(frozen=True, eq=False)
class Left:
    """Largest free forces and couples over the turn by order, (A, K).

    They are in m r w^2, and times the spacing of the throws.
    """

    force: np.ndarray
    couple: np.ndarray

    def rank(self, row: int) -> np.ndarray:
        """Return (A,) both of one order together."""
        return np.hypot(self.force[:, row], self.couple[:, row])


@dataclass(frozen=True, eq=False)
class BankAngles:
    """One family over its bank angles."""

    family: Family
    ratio: float
    """Crank radius over rod."""
    angle: np.ndarray
    """(A,) between the banks (degrees)."""
    free: tuple[FreeForces, ...]
    """(A,) forces and couples with exact piston harmonics."""
    uneven: np.ndarray
    """(A,) largest difference of an interval between firings from the mean one (degrees of the shaft)."""
    order: tuple[tuple[int, ...], ...]
    """(A,) firing orders, the most even ones."""
    ripple: np.ndarray | None
    """(A,) torque of the gas: largest less least, over the mean; None without a cycle."""

    def left(self, counterweights: bool = False, shafts: Sequence[int] = ()) -> Left:
        """Return what is left unbalanced. ``counterweights`` cancel the first order that turns with the shaft.

        ``shafts``: orders that pairs of balance shafts cancel, turning both ways, forces and couples.
        """
        parts = {}
        for what in ("force", "couple"):
            size = np.array([getattr(free, what).largest for free in self.free])
            if counterweights:
                size[:, 0] = [abs(getattr(free, what).backward[0]) for free in self.free]
            for order in shafts:
                if order not in ORDERS:
                    raise ModelError(f"engine '{self.family.name}': shafts of order {order}; there are {ORDERS}")
                size[:, ORDERS.index(order)] = 0.0
            parts[what] = size
        return Left(parts["force"], parts["couple"])

    @property
    def best(self) -> float:
        """The angle (degrees): least first order with counterweights, then second, then firing, then torque."""
        left = self.left(counterweights=True)
        keys = [
            left.rank(0),
            left.rank(1),
            self.uneven,
            np.zeros(len(self.angle)) if self.ripple is None else self.ripple,
        ]
        kept = np.flatnonzero(self.angle >= min(NARROWEST, self.angle.max()))
        for key in keys:
            kept = kept[key[kept] <= key[kept].min() + 1e-6]
        return float(self.angle[kept[0]])

    @property
    def fires_evenly(self) -> np.ndarray:
        """(n,) the angles (degrees), not the narrowest, at which all intervals are equal."""
        return self.angle[(self.uneven < math.degrees(EVEN)) & (self.angle >= NARROWEST)]

    def reasons(self) -> list[str]:
        """Return the reasons for the best angle, in sentences."""
        k = int(np.argmin(np.abs(self.angle - self.best)))
        free, out = self.free[k], []
        own = self.left(counterweights=True)
        first = own.rank(0)
        if first.max() < NOTHING:
            out.append("It has no first order at any angle.")
        elif first[k] < NOTHING:
            turns = abs(free.force.forward[0]) + abs(free.couple.forward[0]) > NOTHING
            only = int((first < NOTHING).sum()) == 1
            out.append(
                f"At {self.best:g} degrees {'alone ' if only else ''}no first order turns against the shaft"
                + (", and counterweights cancel what turns with it." if turns else ".")
            )
        else:
            out.append(f"Of the first order {first[k]:.3g} is left there at least, against {first.max():.3g} at most.")
        second = own.rank(1)
        if second.max() < NOTHING:
            out.append("It has no second order at any angle.")
        elif second[k] < NOTHING:
            out.append("The second order vanishes there.")
        if self.uneven[k] < math.degrees(EVEN):
            out.append(f"It fires evenly, every {720 / self.family.cylinders:g} degrees.")
        elif len(self.fires_evenly):
            angles = ", ".join(f"{angle:g}" for angle in self.fires_evenly)
            out.append(f"It would fire evenly at {angles} degrees.")
        else:
            out.append(f"It fires evenly at no angle from {NARROWEST:g} degrees on.")
        return out


def bank_angles(
    family: Family, ratio: float = 0.28, cycle: GasCycle | None = None, angles: Sequence[float] = tuple(range(181))
) -> BankAngles:
    """Return a family over ``angles`` between its banks (degrees); ``ratio``: crank radius over rod.

    With a ``cycle`` also the ripple of the torque of its gas. Raises ModelError.
    """
    wide = np.asarray(angles, float)
    fired, free = [], []
    for angle in wide:
        plan = family.layout(float(angle))
        fired.append(firing(plan))
        free.append(free_forces(plan, ratio, ORDERS))
    mean = 720.0 / family.cylinders
    uneven = np.array([np.abs(np.degrees(sequence.intervals) - mean).max() for sequence in fired])
    ripple = None
    if cycle is not None:
        torque = gas_torque(cycle, ratio)
        ripple = np.array([_ripple(torque, sequence.angles, sequence.cycle) for sequence in fired])
    return BankAngles(family, ratio, wide, tuple(free), uneven, tuple(sequence.order for sequence in fired), ripple)


def gas_torque(cycle: GasCycle, ratio: float, steps: int = 1440) -> np.ndarray:
    """Return (steps,) torque of one cylinder's gas on the shaft over its cycle, from where it fires (N m).

    For a cylinder of 80 mm bore and stroke; the torque of others has the same shape.
    """
    stroke = 0.08
    m = engine("I1", bore=0.08, stroke=stroke, rod=0.5 * stroke / ratio, gas=cycle, speed=1.0)
    sol = m.sweep(duration=cycle.period, steps=steps)
    return -sol.driver("motor").effort[:steps]


def _ripple(torque: np.ndarray, fired: np.ndarray, cycle: float) -> float:
    """Return (Largest - least) / mean of the sum of shifted copies."""
    harmonics = np.fft.rfft(torque)
    n = np.arange(len(harmonics))
    shifted = harmonics * np.exp(-2j * math.pi * np.outer(fired / cycle, n)).sum(axis=0)
    summed = np.fft.irfft(shifted, len(torque))
    return float(np.ptp(summed) / abs(summed.mean()))


def all_families(
    ratio: float = 0.28, cycle: GasCycle | None = None, tell: Callable[[str], None] = lambda line: None
) -> list[BankAngles]:
    """Return the whole map, a degree apart."""
    out = []
    for family in FAMILIES:
        tell(family.name)
        out.append(bank_angles(family, ratio, cycle))
    return out
