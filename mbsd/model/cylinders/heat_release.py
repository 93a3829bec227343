"""Heat of a charge that burns after Wiebe's function, and the pressure in its closed cylinder.

    x_b = 1 - exp(-a ((phi - phi_s) / phi_d)^n)              burned fraction; phi = 0 at the top dead centre
    d(p V^g) = (g - 1) V^(g - 1) Q dx_b                      from dU = dQ - p dV of an ideal gas
    p = [p_s V_s^g + (g - 1) Q int V^(g - 1) dx_b] / V^g     polytropic before phi_s

The integral is a quadrature by Gauss and Legendre in pieces, exact to rounding, so nothing is stepped. The default
a = 5 burns 99.3 % within phi_d; the rest burns after it.

Source: Ferguson, Kirkpatrick, Internal Combustion Engines, ch. 2 (finite heat release); Wiebe, Brennverlauf und
Kreisprozess von Verbrennungsmotoren, 1970.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from mbsd.base.arguments import finite_number
from mbsd.base.errors import ModelError

PIECES, POINTS = 64, 10
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
    steps = release.start + release.duration * np.linspace(0.0, 3.0, PIECES)
    ends = np.unique(np.concatenate([steps, phi[phi > release.start], [math.pi]]))
    half, middle = 0.5 * np.diff(ends), 0.5 * (ends[1:] + ends[:-1])
    at = (middle[:, None] + half[:, None] * node).ravel()
    pieces = ((of(at) * release.rate(at)).reshape(-1, POINTS) * weight).sum(axis=1) * half
    summed = np.concatenate([[0.0], np.cumsum(pieces)])
    return np.where(phi > release.start, summed[np.minimum(np.searchsorted(ends, phi), len(ends) - 1)], 0.0)
