"""Cycles of the gas in a cylinder: phases by the angle of the crank, each with its own pressure.

    p = s p_to + (1 - s) G(phi) (V_b / V)^n          s = u^3 (10 - 15 u + 6 u^2),  u = (phi - begin) / width

V is the volume now, V_b that at the bottom dead centre. With n = 0 and a constant G the pressure is given; with a
constant G it is polytropic in the volume where the piston really is; G rises where a charge burns. Where a valve opens
the pressure passes to p_to within ``width``, or at once.

phi is counted from the top dead centre at which the cylinder fires, in the direction in which its crank turns.
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache
from itertools import pairwise

import numpy as np

from mbsd.base.arguments import finite_number
from mbsd.base.errors import ModelError
from mbsd.model.cams.profile import hermite
from mbsd.model.cylinders.articulated_motion import ArticulatedMotion
from mbsd.model.cylinders.heat_release import HeatRelease, burned_integral
from mbsd.model.cylinders.piston_motion import PistonMotion

TURN = 2.0 * math.pi
PIECES = 128
"""Number of pieces of G while a charge burns: its quintics miss it by some 1e-9."""
BURNED = 37.0
"""exp(-37) is left: nothing burns any more."""


@dataclass(frozen=True)
class Bore:
    """Cylinder: bore area (m^2), clearance as a length of the bore (m), and motion of its piston."""

    area: float
    clearance: float
    motion: PistonMotion | ArticulatedMotion

    @property
    def bottom(self) -> float:
        """Height of the gas at the bottom dead centre (m)."""
        return self.clearance + self.motion.stroke

    def height(self, phi: np.ndarray | float) -> np.ndarray:
        """Height of the gas (m) at angles of the crank (rad)."""
        return self.clearance + self.motion.below(np.asarray(phi, float))


@dataclass(frozen=True)
class Phase:
    """From ``begin`` (rad) to the begin of the next."""

    begin: float
    exponent: float
    """n"""
    breaks: tuple[float, ...]
    """(k + 1,) where the pieces of G meet (rad)."""
    pieces: tuple[tuple[float, ...], ...]
    """(k, 6) their coefficients (Pa), by rising powers of the angle since their break."""
    to: float = 0.0
    """p_to (Pa)."""
    width: float = 0.0
    """Width of the passage to it (rad); 0: there is none."""


@dataclass(frozen=True)
class Opening:
    """A valve in the head, or a port in the wall."""

    open: bool
    port: float | None = None
    """How far below the head it is (m); None: a valve."""


class GasCycle(ABC):
    """The pressure in a cylinder over one cycle."""

    turns: int
    """Turns of the crank in one cycle."""
    compression: float | None
    """Volume at the bottom over that at the top dead centre; None: the clearance is not known."""

    @abstractmethod
    def phases(self, bore: Bore) -> tuple[Phase, ...]:
        """In order, over one cycle."""

    @property
    def burns(self) -> bool:
        """True if heat is released where crank and rod put the piston."""
        return False

    @property
    def period(self) -> float:
        """Period of the cycle (rad)."""
        return TURN * self.turns

    def openings(self, phi: float, bore: Bore) -> tuple[Opening, ...]:
        """Valves and ports and whether they are open at an angle after the firing (rad), for drawings."""
        return ()


@dataclass(frozen=True)
class BurningCycle(GasCycle):
    """A cycle whose charge burns after Wiebe's function between two polytropic changes of state."""

    compression: float  # pyright: ignore[reportIncompatibleVariableOverride]  (it is frozen)
    heat: float | None
    """J; or ``heat_density``, by the displaced volume (J/m^3)."""
    heat_density: float | None
    start: float
    duration: float
    a: float
    n: float
    compression_exponent: float
    expansion_exponent: float
    passage: float

    @property
    def burns(self) -> bool:
        """True if there is heat."""
        return bool(self.heat or self.heat_density)

    def closed(self, bore: Bore, closes: float, pressure: float, opens: float) -> tuple[Phase, Phase]:
        """Compression from where the valves close at a pressure (Pa), and expansion until they open (rad)."""
        heat = self.heat if self.heat is not None else (self.heat_density or 0.0) * bore.area * bore.motion.stroke
        release = HeatRelease(heat, self.start, self.duration, self.a, self.n)
        return closed_phases(release, bore, closes, pressure, self.compression_exponent, self.expansion_exponent, opens)


def level(begin: float, pressure: float, exponent: float = 0.0) -> Phase:
    """A phase of constant pressure (Pa), or polytropic with that pressure where the volume is the largest."""
    return Phase(begin, exponent, (begin, begin + 1.0), ((pressure, 0.0, 0.0, 0.0, 0.0, 0.0),))


def opened(before: Phase, begin: float, to: float, width: float) -> tuple[Phase, ...]:
    """Return phases of a valve that opens at ``begin``, from ``before`` to another pressure (Pa).

    It opens within a width (rad) or at once.
    """
    after = level(begin + width, to)
    if width == 0.0:
        return (after,)
    return Phase(begin, before.exponent, before.breaks, before.pieces, to, width), after


@lru_cache(maxsize=128)
def closed_phases(
    release: HeatRelease, bore: Bore, closes: float, pressure: float, compression: float, expansion: float, opens: float
) -> tuple[Phase, Phase]:
    """Return compression from the closing of the valves, and expansion until ``opens``, while it burns.

    The valves close at a pressure (Pa).

    ``compression`` and ``expansion`` are polytropic exponents.
    """
    bottom, first, ignited = bore.bottom, float(bore.height(closes)), float(bore.height(release.start))
    at_start = pressure * (first / ignited) ** compression
    end = min(opens, release.start + release.duration * (BURNED / release.a) ** (1.0 / release.n))
    breaks = release.start + (end - release.start) * np.linspace(0.0, 1.0, PIECES + 1) ** 2
    height, slope = bore.height(breaks), bore.motion.slope(breaks)
    power = expansion - 1.0
    scale = power * release.heat / (bore.area * bottom**expansion)
    base = at_start * (ignited / bottom) ** expansion
    value = base + scale * burned_integral(breaks, lambda angle: bore.height(angle) ** power, release)
    rate, bend = release.rate(breaks), release.rate_slope(breaks)
    first_slope = scale * height**power * rate
    second = scale * (height**power * bend + power * height ** (power - 1.0) * slope * rate)
    samples = np.stack([value, first_slope, second], axis=-1)
    pieces = hermite(np.diff(breaks), samples[:-1], samples[1:])
    last = (float(value[-1]), 0.0, 0.0, 0.0, 0.0, 0.0)
    burning = Phase(
        release.start, expansion, (*breaks.tolist(), end + 1.0), (*(tuple(row) for row in pieces.tolist()), last)
    )
    return level(closes, pressure * (first / bottom) ** compression, compression), burning


def numbers_given(what: str, positive: Sequence[str], least: Mapping[str, float], **values: float) -> dict[str, float]:
    """Numbers as floats, some of them ``positive``, some not below their ``least``. Raises ModelError."""
    out = {name: finite_number(f"{what}: {name}", value) for name, value in values.items()}
    for name, value in out.items():
        if name in positive and not value > 0.0:
            raise ModelError(f"{what}: {name} is {value:g}; it must be positive")
        if name in least and value < least[name]:
            raise ModelError(f"{what}: {name} is {value:g}; it must be {least[name]:g} or more")
    return out


def heat_given(what: str, heat: float | None, heat_density: float | None) -> tuple[float | None, float | None]:
    """One of the two at most. Raises ModelError."""
    if heat is not None and heat_density is not None:
        raise ModelError(f"{what}: give heat (J) or heat_density (J/m^3), not both")
    named = {key: value for key, value in (("heat", heat), ("heat_density", heat_density)) if value is not None}
    numbers = numbers_given(what, (), dict.fromkeys(named, 0.0), **named)
    return numbers.get("heat"), numbers.get("heat_density")


def compression_given(what: str, value: float) -> float:
    """A compression ratio. Raises ModelError."""
    ratio = finite_number(f"{what}: compression", value)
    if not ratio > 1.0:
        raise ModelError(f"{what}: compression is {ratio:g}; the ratio of the largest volume to the least is above 1")
    return ratio


def in_order(what: str, angles: Mapping[str, float]) -> None:
    """Raise ModelError where angles (rad), by what happens there, do not follow each other."""
    names = list(angles)
    for before, after in pairwise(names):
        if not angles[before] < angles[after]:
            raise ModelError(
                f"{what}: {before} is {math.degrees(angles[before]):.6g} degrees and {after} "
                f"{math.degrees(angles[after]):.6g} degrees from the top dead centre at which it fires; {before} must "
                "come first. Give radians"
            )
