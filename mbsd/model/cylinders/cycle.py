"""Cycles of the gas in a cylinder: phases by the angle of the crank, each with its own pressure.

Heat of a charge that burns after Wiebe's function, and the pressure in its closed cylinder:

    x_b = 1 - exp(-a ((phi - phi_s) / phi_d)^n)              burned fraction; phi = 0 at the top dead centre
    d(p V^g) = (g - 1) V^(g - 1) Q dx_b                      from dU = dQ - p dV of an ideal gas
    p = [p_s V_s^g + (g - 1) Q int V^(g - 1) dx_b] / V^g     polytropic before phi_s

The integral is a quadrature by Gauss and Legendre in pieces, exact to rounding, so nothing is stepped. The default
a = 5 burns 99.3 % within phi_d; the rest burns after it.

Source: Ferguson, Kirkpatrick, Internal Combustion Engines, ch. 2 (finite heat release); Wiebe, Brennverlauf und
Kreisprozess von Verbrennungsmotoren, 1970.

Pressure of a phase:

    p = s p_to + (1 - s) G(phi) (V_b / V)^n          s = u^3 (10 - 15 u + 6 u^2),  u = (phi - begin) / width

V is the volume now, V_b that at the bottom dead centre. With n = 0 and a constant G the pressure is given; with a
constant G it is polytropic in the volume where the piston really is; G rises where a charge burns. Where a valve opens
the pressure passes to p_to within ``width``, or at once.

phi is counted from the top dead centre at which the cylinder fires, in the direction in which its crank turns.
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache
from itertools import pairwise

import numpy as np

from mbsd.base.arguments import finite_number
from mbsd.base.errors import ModelError
from mbsd.model.cylinders.piston_motion import ArticulatedMotion, PistonMotion
from mbsd.model.laws.numbers import hermite_coefficients

HEAT_RELEASE_PIECES, POINTS = 64, 10
"""Numbers of the quadrature over the burning."""


@dataclass(frozen=True)
class HeatRelease:
    """How one charge burns; ``heat`` (J) in all, angles (rad) from the top dead centre at which it fires."""

    heat: float
    start: float
    duration: float
    a: float = 5.0
    """Completeness: exp(-a) is left unburned after ``duration``."""
    n: float = 3.0
    """Shape: 3 burns fastest near the middle."""

    def __post_init__(self) -> None:
        for name in ("heat", "start", "duration", "a", "n"):
            number = finite_number(f"heat release: {name}", getattr(self, name))
            if name != "start" and not (number > 0 or (name == "heat" and number == 0)):
                raise ModelError(f"heat release: {name} is {number:g}; it must be positive")
        if not -math.pi < self.start < math.pi:
            raise ModelError(
                f"heat release: it starts {math.degrees(self.start):g} degrees from the top dead centre, where the "
                "valves are not closed; give radians between -pi and pi"
            )

    def burned(self, phi: np.ndarray) -> np.ndarray:
        """Burned fraction at angles phi (rad), 0 .. 1."""
        since = np.maximum(0.0, (np.asarray(phi, float) - self.start) / self.duration)
        return -np.expm1(-self.a * since**self.n)

    def rate(self, phi: np.ndarray) -> np.ndarray:
        """Rate of the burned fraction, by angle (1/rad)."""
        since = np.maximum(0.0, (np.asarray(phi, float) - self.start) / self.duration)
        return self.a * self.n / self.duration * since ** (self.n - 1) * np.exp(-self.a * since**self.n)

    def rate_slope(self, phi: np.ndarray) -> np.ndarray:
        """Return the derivative of ``rate`` by angle (1/rad^2) after the start.

        At the start it is 0 if infinite there.
        """
        u = np.maximum(0.0, (np.asarray(phi, float) - self.start) / self.duration)
        if self.n >= 2.0:
            rising = (self.n - 1.0) * u ** (self.n - 2.0)
        else:
            rising = np.where(u > 0.0, (self.n - 1.0) * np.where(u > 0.0, u, 1.0) ** (self.n - 2.0), 0.0)
        falling = self.a * self.n * u ** (2.0 * self.n - 2.0)
        return self.a * self.n / self.duration**2 * (rising - falling) * np.exp(-self.a * u**self.n)


def closed_pressure(
    phi: np.ndarray,
    volume: Callable[[np.ndarray], np.ndarray],
    pressure: float,
    release: HeatRelease,
    compression: float = 1.32,
    expansion: float = 1.28,
) -> np.ndarray:
    """(T,) pressure (Pa) at rising angles phi (T,) from -pi to pi, the valves closed.

    ``volume`` (m^3) of arrays of angles; ``pressure`` (Pa) at the bottom dead centre before, phi = -pi; polytropic
    exponents before and after the charge begins to burn.
    """
    phi = np.asarray(phi, float)
    space = volume(phi)
    first, ignited = (float(volume(np.array([angle]))[0]) for angle in (-math.pi, release.start))
    at_start = pressure * (first / ignited) ** compression
    unburned = pressure * (first / space) ** compression
    energy = at_start * ignited**expansion + (expansion - 1.0) * release.heat * burned_integral(
        phi, lambda angle: volume(angle) ** (expansion - 1.0), release
    )
    return np.where(phi <= release.start, unburned, energy / space**expansion)


def burned_integral(phi: np.ndarray, of: Callable[[np.ndarray], np.ndarray], release: HeatRelease) -> np.ndarray:
    """Return (T,) integrals of a function of the angle over the burned fraction, up to each phi.

    They begin at the start of burning.

    0 before it.
    """
    node, weight = np.polynomial.legendre.leggauss(POINTS)
    # Pieces end at the angles asked for and at equal steps of the burning, so that each integrand is smooth.
    steps = release.start + release.duration * np.linspace(0.0, 3.0, HEAT_RELEASE_PIECES)
    ends = np.unique(np.concatenate([steps, phi[phi > release.start], [math.pi]]))
    half, middle = 0.5 * np.diff(ends), 0.5 * (ends[1:] + ends[:-1])
    at = (middle[:, None] + half[:, None] * node).ravel()
    pieces = ((of(at) * release.rate(at)).reshape(-1, POINTS) * weight).sum(axis=1) * half
    summed = np.concatenate([[0.0], np.cumsum(pieces)])
    return np.where(phi > release.start, summed[np.minimum(np.searchsorted(ends, phi), len(ends) - 1)], 0.0)


TURN = 2.0 * math.pi
CYCLE_PIECES = 128
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
    """Distance below the head (m); None: a valve."""


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
    breaks = release.start + (end - release.start) * np.linspace(0.0, 1.0, CYCLE_PIECES + 1) ** 2
    height, slope = bore.height(breaks), bore.motion.slope(breaks)
    power = expansion - 1.0
    scale = power * release.heat / (bore.area * bottom**expansion)
    base = at_start * (ignited / bottom) ** expansion
    value = base + scale * burned_integral(breaks, lambda angle: bore.height(angle) ** power, release)
    rate, bend = release.rate(breaks), release.rate_slope(breaks)
    first_slope = scale * height**power * rate
    second = scale * (height**power * bend + power * height ** (power - 1.0) * slope * rate)
    samples = np.stack([value, first_slope, second], axis=-1)
    pieces = hermite_coefficients(np.diff(breaks), samples[:-1], samples[1:])
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
