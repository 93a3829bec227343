"""A gain that brings a ring to a loudness without a peak above a ceiling.

The gain is found in steps of a ms: what each needs, the least of its neighbours (it is down before a peak comes),
smoothed by a bell that is no longer than these neighbours reach. Such a gain is nowhere above what a peak allows. How
loud a ring is behind it follows from its energies, so the gain before it is found by halving. Peaks count between the
samples, from four times as many.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from render.sound.fourier import irfft, rfft
from render.sound.loudness import STEP, energies, loudness, of_energies

Array = NDArray[np.float64]
Spectrum = NDArray[np.complex128]
FINER = 4
"""True peaks are looked for at so many times the rate."""
CHUNK, BESIDE = 16_000, 192
"""Samples that are looked at together, and beside them, where a spectrum does not know how the wave goes on."""
REACH = 12
"""ms by which the gain is down before and after a peak."""
TRIES, ENOUGH = 4, 0.1
"""Where a peak is pressed, energies tell the loudness roughly; so it is measured, and aimed at again (LU)."""
HALVINGS, NEAR = 24, 0.02
"""Most tries, and how near to the loudness is near enough (LU)."""
MOST, LESS = 36.0, 12.0
"""Peaks are pressed by so many dB at most; the gain is so many dB less than what pressing none gives, at most."""


def true_peaks(wave: Array) -> Array:
    """(m,) largest size within each ms of a ring (2, N), also between the samples."""
    count = wave.shape[1]
    steps = max(1, count // STEP)
    edges = (np.arange(steps + 1) * (count / steps)).astype(int)
    fine = np.empty(count)
    for first in range(0, count, CHUNK):
        here = np.arange(first - BESIDE, min(first + CHUNK, count) + BESIDE)
        between = _upsampled(wave[:, here % count]).reshape(2, -1, FINER)
        fine[first : first + CHUNK] = np.abs(between).max(axis=(0, 2))[BESIDE:-BESIDE]
    return np.maximum.reduceat(fine, edges[:-1])


def _upsampled(wave: Array) -> Array:
    """(2, FINER n) the wave between its samples (2, n); its ends are not to be used."""
    count = wave.shape[1]
    spectrum = rfft(wave) * FINER
    if count % 2 == 0:
        spectrum[:, -1] *= 0.5
    return irfft(spectrum, count * FINER)


def levelled(spectrum: Spectrum, beside: Spectrum, count: int, wanted: float, ceiling: float, showings: int) -> Array:
    """A ring (2, count) with this spectrum and that of what is heard ``beside`` it, (2, count // 2 + 1) each, together
    at ``wanted`` LUFS, as far as peaks below ``ceiling`` (1 is full scale) let the former be.

    What is beside it counts: the second gate of the loudness depends on how quiet the rest is.
    """
    wave, energy, air = irfft(spectrum, count), energies(spectrum, count), irfft(beside, count)
    now = of_energies(energy, showings, floor=-np.inf)
    if not np.isfinite(now) or not energy.any():
        return air
    peaks, quiet, aim, out = true_peaks(wave), energies(beside, count), wanted, air
    for _ in range(TRIES):
        gain = _gain(peaks, energy, quiet, aim, 10 ** ((wanted - now) / 20), ceiling, showings)
        middles = (np.arange(len(gain)) + 0.5) * (count / len(gain))
        out = wave * np.interp(np.arange(count), middles, gain, period=count) + air
        off = wanted - loudness(out, showings)
        if abs(off) < ENOUGH:
            break
        aim += off
    return out


def _gain(
    peaks: Array, energy: Array, quiet: Array, wanted: float, plain: float, ceiling: float, showings: int
) -> Array:
    """(m,) gain in each ms: ``plain`` without pressing any peak, then with as much more as it takes."""
    low, high, more, gain = -LESS, MOST, 0.0, peaks
    for _ in range(HALVINGS):
        factor = plain * 10 ** (more / 20)
        gain = factor * _pressed(peaks * factor, ceiling)
        reached = of_energies(energy * gain**2 + quiet, showings)
        if abs(reached - wanted) < NEAR:
            return gain
        low, high = (more, high) if reached < wanted else (low, more)
        more = (low + high) / 2
    return gain


def _pressed(peaks: Array, ceiling: float) -> Array:
    """(m,) gains with which no step of a ring of peaks is above the ceiling."""
    gain = np.minimum(1.0, ceiling / np.maximum(peaks, 1e-12))
    reach = min(REACH, (len(gain) - 1) // 2)
    if not reach:
        return np.full(len(gain), gain.min())
    least = gain.copy()
    for shift in range(1, reach + 1):
        np.minimum(least, np.minimum(np.roll(gain, shift), np.roll(gain, -shift)), out=least)
    bell = np.hanning(2 * reach + 1)[1:-1]
    half = len(bell) // 2
    smooth = sum(weight * np.roll(least, k - half) for k, weight in enumerate(bell / bell.sum()))
    return np.asarray(smooth)
