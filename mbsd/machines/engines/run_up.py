"""Run-up through resonance: an engine on its mount, one mode in closed form, at any acceleration.

    x'' + 2 zeta w x' + w^2 x = -d^2/dt^2 cos(theta)     "inertia": what moves to and fro with order n of the shaft
                              = w^2 cos(theta)           "constant": a force of constant amplitude, as of gas
    theta = b t^2 / 2,   b = n acceleration,   x(0) = x'(0) = 0

x is in amplitudes: of the inertia's at high speed, U / M, or of the static deflection, F / k. With the roots lambda of
the free vibration x is a sum of

    int_0^t e^(i b s^2 / 2 + lambda (t - s)) ds = (pi / (-2 i b))^(1/2) e^(lambda t + u_0^2) [erf(u_t) - erf(u_0)],
    u_s = (-i b / 2)^(1/2) (s + i lambda / b)

whose error functions of complex arguments are those of Faddeeva, so that nothing is integrated in steps. A slow run-up
reaches the steady resonance; a fast one passes it with a lower peak that comes later. Without damping the peak of a
constant force tends to 3.676 q^(1/2), q = w^2 / (2 pi b): periods from standstill to resonance, times 2.

Source: Lewis 1932, Vibration during acceleration through a critical speed, Trans. ASME 54; Fearn, Millsaps 1967, J. R.
Aeronaut. Soc. 71.
"""

from __future__ import annotations

import cmath
import math
from dataclasses import dataclass

import numpy as np
from scipy.special import wofz

from mbsd.base.arguments import finite_number, not_negative_number, positive_number
from mbsd.base.errors import ModelError
from mbsd.base.names import shown

EXCITATIONS = ("inertia", "constant")
SAMPLES = 48
"""Rows of a period of the excitation at its fastest, or of the free vibration where that is faster."""
MOST = 4_000_000
"""Rows."""
SHIFT = 0.861
"""Distance of the undamped peak from resonance, times q^(-1/2), in parts of the speed there."""
SHIFTS = 3.0
"""Number of these distances by which the run goes past resonance."""
LEAST = 0.3
"""Least distance by which it goes past resonance, in parts of the speed there."""


@dataclass(frozen=True, eq=False)
class RunUp:
    """One mode during a run-up from rest, and at constant speed."""

    t: np.ndarray
    """(T,) s"""
    speed: np.ndarray
    """(T,) of the shaft (rad/s)."""
    displacement: np.ndarray
    """(T,) in amplitudes of the inertia, or static deflections."""
    steady_peak: float
    """Largest amplitude at constant speed, in the same; infinite without damping."""
    steady_speed: float
    """The speed of that (rad/s)."""

    @property
    def peak(self) -> float:
        """Largest displacement to either side."""
        return float(np.abs(self.displacement).max())

    @property
    def peak_speed(self) -> float:
        """Speed of the shaft when it comes (rad/s)."""
        return float(self.speed[np.abs(self.displacement).argmax()])

    @property
    def reached(self) -> float:
        """Part of the steady peak that the run-up reaches; 0 without damping."""
        return self.peak / self.steady_peak


def run_up(
    frequency: float,
    damping_ratio: float,
    acceleration: float,
    order: float = 1,
    excitation: str = "inertia",
    until: float | None = None,
) -> RunUp:
    """Return one mode of ``frequency`` (Hz, undamped) under an ``order`` of a shaft from rest.

    ``until``: speed of the shaft at the end (rad/s), by default well past the peak. Raises ModelError for numbers that
    cannot be, damping that lets nothing resonate, and runs of more than 80 000 periods.
    """
    w = 2 * math.pi * positive_number("run_up: frequency", frequency, "Hz")
    zeta = not_negative_number("run_up: damping_ratio", damping_ratio)
    rate = positive_number("run_up: acceleration", acceleration, "rad/s^2")
    n = positive_number("run_up: order", order)
    if excitation not in EXCITATIONS:
        raise ModelError(f"run_up: excitation is {shown(excitation)}; it is 'inertia' or 'constant'")
    if zeta >= math.sqrt(0.5):
        raise ModelError(f"run_up: damping_ratio is {zeta:g}; from 0.707 on there is no resonance to run through")
    b = n * rate
    q = w**2 / (2 * math.pi * b)
    beyond = max(SHIFTS * SHIFT / math.sqrt(q), LEAST)
    end = w / n * (1 + beyond) if until is None else finite_number("run_up: until", until)
    if end <= 0.0:
        raise ModelError(f"run_up: until is {end:g} rad/s; it must be positive")
    duration = end / rate
    count = math.ceil(SAMPLES * duration * max(n * end, w) / (2 * math.pi)) + 1
    if count > MOST:
        raise ModelError(
            f"run_up: at {rate:g} rad/s^2 there are {duration * max(n * end, w) / (2 * math.pi):.3g} periods up to "
            f"{end:g} rad/s, too many to list; give a higher acceleration, or end earlier with until="
        )
    t = np.linspace(0.0, duration, count)
    x = _displacement(t, w, zeta, b, excitation)
    sharp = 2 * zeta * math.sqrt(1 - zeta**2)
    best = math.sqrt(1 - 2 * zeta**2)
    steady = w / n * (best if excitation == "constant" else 1 / best)
    return RunUp(t, rate * t, x, 1 / sharp if sharp else math.inf, steady)


def _displacement(t: np.ndarray, w: float, zeta: float, b: float, excitation: str) -> np.ndarray:
    """Return (T,) real part of the response to e^(i theta)."""
    damped = w * math.sqrt(1 - zeta**2)
    root = complex(-zeta * w, damped)
    first, second = _convolved(t, root, b), _convolved(t, root.conjugate(), b)
    answer = (first - second) / (2j * damped)  # of x'' + 2 zeta w x' + w^2 x = e^(i theta)
    if excitation == "constant":
        return (w**2 * answer).real
    # x + e^(i theta) =: y answers to 2 zeta w (e^(i theta))' + w^2 e^(i theta), from y(0) = 1, y'(0) = 0; the first
    # term is integrated by parts: int g(t - s) e'(s) ds = int g'(t - s) e(s) ds - g(t)
    rate = (root * first - root.conjugate() * second) / (2j * damped)
    decay = np.exp(-zeta * w * t)
    released = decay * (np.cos(damped * t) + zeta * w / damped * np.sin(damped * t))
    struck = decay * np.sin(damped * t) / damped
    moved = 2 * zeta * w * (rate - struck) + w**2 * answer
    return (moved + released - np.exp(0.5j * b * t**2)).real


def _convolved(t: np.ndarray, root: complex, b: float) -> np.ndarray:
    """Return (T,) int_0^t e^(i b s^2 / 2 + root (t - s)) ds, by scaled complementary error functions."""
    half = cmath.sqrt(-0.5j * b)
    first, last = half * (1j * root / b), half * (t + 1j * root / b)
    # erfc(u) = e^(-u^2) w(i u), and where Re u < 0, 2 - e^(-u^2) w(-i u)
    side, sides = math.copysign(1.0, first.real), np.copysign(1.0, last.real)
    begun = side * np.exp(root * t) * wofz(1j * side * first)
    ended = sides * np.exp(0.5j * b * t**2) * wofz(1j * sides * last)
    crossed = sides != side
    begun[crossed] -= 2 * side * np.exp(root * t[crossed] + first**2)
    return 0.5 * math.sqrt(math.pi) / half * (begun - ended)
