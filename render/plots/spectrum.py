"""Amplitudes of the harmonics of what repeats with each turn or period; of all else a spectrum over frequency.

    amplitude of order k     |2/N sum_n f_n exp(-2 pi i k n / N)|        f = mean + sum_k amplitude_k cos(k phi + phase)

N equal steps of a period, or of the angle of the crank in its last turn. What neither repeats nor turns is looked at
through a Hann window, of which a harmonic of amplitude A keeps a peak of height A (F. J. Harris, "On the use of
windows for harmonic analysis with the discrete Fourier transform", Proc. IEEE 66, 1978).
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from scipy.interpolate import CubicSpline

from render.crank import crank_of
from shared.contract import Motion

STEPS = 2048
"""Number of steps of one period or turn, where the rows are not equally far apart."""


@dataclass(frozen=True)
class Spectrum:
    """Amplitudes over orders of a period or of the crank, or over frequencies."""

    at: np.ndarray
    """(K,) orders, or frequencies (Hz); from 0."""
    amplitudes: np.ndarray
    """(K, ...) of the columns; at 0 the size of the mean."""
    harmonic: bool
    """Whether ``at`` are orders."""
    base: float
    """Frequency of order 1 (Hz), on average where the speed varies; else the resolution."""
    over: str
    """What it was taken over, in words."""
    order_of: str
    """What the orders count: a crank's name, or "period"."""


def spectrum(motion: Motion, values: np.ndarray) -> Spectrum:
    """Spectrum of series (T,) or (T, k) over the times of a motion."""
    time, crank = np.asarray(motion.time), crank_of(motion)
    if motion.period:
        turns = crank.turns if crank and crank.first == 0 else 1
        amplitudes = _amplitudes(_equal_steps(time, values))
        over = "one period" if turns == 1 and crank is None else "one turn" if turns == 1 else f"{turns} turns"
        return Spectrum(
            np.arange(len(amplitudes)) / turns, amplitudes, True, turns / motion.period,
            over + (f" of the {crank.body}" if crank else ""), crank.body if crank else "period",
        )  # fmt: skip
    if crank:
        ends = crank.angle[-1] - 2 * np.pi, crank.angle[-1]
        began = float(np.interp(ends[0], crank.angle[crank.first :], time[crank.first :]))
        amplitudes = _amplitudes(_resampled(crank.angle, values, np.linspace(*ends, STEPS, endpoint=False)))
        return Spectrum(
            np.arange(len(amplitudes), dtype=float), amplitudes, True, 1 / (time[-1] - began),
            f"the last turn of the {crank.body}", crank.body,
        )  # fmt: skip
    return _windowed(time, values)


def _windowed(time: np.ndarray, values: np.ndarray) -> Spectrum:
    count = max(STEPS, 2 * len(time))
    span = float(time[-1] - time[0])
    sampled = _resampled(time, values, time[0] + span * np.arange(count) / count)
    mean = sampled.mean(axis=0)
    window = 1 - np.cos(2 * np.pi * np.arange(count) / count)
    amplitudes = _amplitudes((sampled - mean) * window.reshape(-1, *(1,) * (values.ndim - 1)))
    amplitudes[0] = np.abs(mean)
    half = len(time) // 2 + 1  # above it lies nothing but what the interpolation added
    at = np.arange(half) / span
    return Spectrum(at, amplitudes[:half], False, 1 / span, f"{span:.4g} s, Hann window", "")


def _amplitudes(rows: np.ndarray) -> np.ndarray:
    """(N // 2 + 1, ...) of N equal steps that repeat."""
    out = np.abs(np.fft.rfft(rows, axis=0)) * (2 / len(rows))
    out[0] /= 2
    if len(rows) % 2 == 0:
        out[-1] /= 2
    return out


def _equal_steps(time: np.ndarray, values: np.ndarray) -> np.ndarray:
    """The rows of a period without its end, resampled where they are not equally far apart."""
    steps = np.diff(time)
    if np.ptp(steps) <= 1e-6 * steps.mean():
        return values[:-1]
    return _resampled(time, values, np.linspace(time[0], time[-1], STEPS, endpoint=False))


def _resampled(x: np.ndarray, values: np.ndarray, at: np.ndarray) -> np.ndarray:
    """Values at ``at``: cubic splines, one between each two events, whose rows share their x."""
    out = np.empty((len(at), *values.shape[1:]))
    starts = [0, *(np.flatnonzero(np.diff(x) <= 0) + 1), len(x)]
    for low, high in pairwise(starts):
        inside = (at >= x[low]) & (at <= x[high - 1])
        if not inside.any():
            continue
        if high - low < 2:
            out[inside] = values[low]
        else:
            out[inside] = CubicSpline(x[low:high], values[low:high])(at[inside])
    return out
