"""The mix: room, limiter, loudness."""

from __future__ import annotations

from collections.abc import Mapping
from functools import lru_cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from render.sound.waves import frequencies, irfft, rfft, shaped, shaped_spectrum

# Loudness after EBU R 128, which is ITU-R BS.1770-4: LUFS of stereo waves.
#
#     K-weighting      two biquads at 48 kHz, a high shelf of 4 dB and a high pass at 38 Hz
#     block            z = sum over channels of the mean square of 400 ms, every 100 ms;   l = -0.691 + 10 log10 z
#     gates            blocks above -70 LUFS, then those above their mean less 10 LU;   the loudness is that of their
#     mean
#
# The wave is a ring that is played several times; blocks of the measurement go round its end.

Array = NDArray[np.float64]
RATE = 48_000
SHELF = (1.53512485958697, -2.69169618940638, 1.19839281085285), (1.0, -1.69065929318241, 0.73248077421585)
HIGH_PASS = (1.0, -2.0, 1.0), (1.0, -1.99004745483398, 0.99007225036621)
"""Numerators and denominators of BS.1770-4, tables 1 and 2."""
STEP = 48
"""Samples of a millisecond, in which energies are counted."""
BLOCK, HOP = 400, 100
"""ms"""
ABSOLUTE, RELATIVE = -70.0, -10.0


@lru_cache(maxsize=1)
def weighting(count: int) -> NDArray[np.complex128]:
    """Return the K-weighting at the frequencies of the spectrum of a ring of so many samples."""
    z = np.exp(-2j * np.pi * np.fft.rfftfreq(count))
    gain = np.ones_like(z)
    for above, below in (SHELF, HIGH_PASS):
        gain *= np.polyval(above[::-1], z) / np.polyval(below[::-1], z)
    return gain


def energies(spectrum: NDArray[np.complex128], count: int) -> Array:
    """Return (m,) mean squares of each ms of a ring, K-weighted, both channels together.

    The ring has ``count`` samples and the spectrum (2, count // 2 + 1).
    """
    square = (irfft(spectrum * weighting(count), count) ** 2).sum(axis=0)
    if count < STEP:
        return np.array([square.mean()])
    whole = count // STEP
    return square[: whole * STEP].reshape(whole, STEP).mean(axis=1)


def of_energies(energy: Array, showings: int = 1, floor: float = ABSOLUTE) -> float:
    """Return integrated loudness (LUFS) of a ring with these mean squares a ms; -inf of silence.

    It is played so many times. ``floor`` is the absolute gate (LUFS), for waves that have no level yet.
    """
    whole = np.tile(energy, showings)
    if len(whole) < BLOCK:
        whole = np.full(BLOCK, whole.mean())
    sums = np.concatenate([[0.0], np.cumsum(whole)])
    starts = np.arange(0, len(whole) - BLOCK + 1, HOP)
    blocks = (sums[starts + BLOCK] - sums[starts]) / BLOCK
    heard = blocks[_lufs(blocks) > floor]
    if not len(heard):
        return -np.inf
    kept = heard[_lufs(heard) > _lufs(np.mean(heard)) + RELATIVE]
    return float(_lufs(kept.mean()))


def loudness(wave: Array, showings: int = 1, floor: float = ABSOLUTE) -> float:
    """Return integrated loudness (LUFS) of a ring (2, N) that is played so many times."""
    return of_energies(energies(rfft(wave), wave.shape[1]), showings, floor)


def _lufs(square: Any) -> Any:
    return -0.691 + 10 * np.log10(np.maximum(square, 1e-30))


# A gain that brings a ring to a loudness without a peak above a ceiling.
#
# The gain is found in steps of a ms: what each needs, the least of its neighbours (it is down before a peak comes),
# smoothed by a bell that is no longer than these neighbours reach. Such a gain is nowhere above what a peak allows. How
# loud a ring is behind it follows from its energies, so the gain before it is found by halving. Peaks count between the
# samples, from four times as many.

Spectrum = NDArray[np.complex128]
FINER = 4
"""True peaks are looked for at so many times the rate."""
CHUNK, BESIDE = 16_000, 192
"""Samples that are looked at together, and beside them, where a spectrum does not know how the wave goes on."""
REACH = 12
"""ms by which the gain is down before and after a peak."""
TRIES, ENOUGH = 4, 0.1
"""Tolerance (LU): where a peak is pressed, energies tell the loudness roughly, so it is measured and aimed at again."""
HALVINGS, NEAR = 24, 0.02
"""Most tries, and how near to the loudness is near enough (LU)."""
MOST, LESS = 36.0, 12.0
"""Peaks are pressed by so many dB at most; the gain is so many dB less than what pressing none gives, at most."""


def true_peaks(wave: Array) -> Array:
    """Return (m,) largest size within each ms of a ring (2, N), also between the samples."""
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
    """Return (2, FINER n) the wave between its samples (2, n); its ends are not to be used."""
    count = wave.shape[1]
    spectrum = rfft(wave) * FINER
    if count % 2 == 0:
        spectrum[:, -1] *= 0.5
    return irfft(spectrum, count * FINER)


def levelled(spectrum: Spectrum, beside: Spectrum, count: int, wanted: float, ceiling: float, showings: int) -> Array:
    """Return a ring (2, count) of this spectrum, at ``wanted`` LUFS together with ``beside``.

    Both spectra are (2, count // 2 + 1). Peaks of the ring stay below ``ceiling`` (1 is full scale).

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
    """Return (m,) gain in each ms: ``plain`` below any peak, then with as much more as it takes."""
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
    """Return (m,) gains with which no step of a ring of peaks is above the ceiling."""
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


# The room: its air, at a fixed level, and what its walls give back of the machine.
#
#     air      noise that falls by 6 dB an octave above 200 Hz, a little other at each ear, at -50 LUFS
#     walls    h(t) = noise exp(-6.9 t / T) after 5 ms, T = 0.3 s, duller with time; 12 dB below what comes directly
#
# A machine that makes no sound is in the same room, and no louder.

AIR_LEVEL = -50.0
"""LUFS"""
KNEE = 200.0
DECAY, BEFORE = 0.3, 0.005
"""Reverberation time and first delay (s)."""
WALLS = 10 ** (-12 / 20)
"""Size of what the walls give back, over that of the machine itself."""
DULL = 4000.0
"""Frequency (Hz) above which walls give back less."""
STREAMS = 100
"""Number of the first of its streams of chance."""


def air_noise(count: int) -> NDArray[np.complex128]:
    """Return (2, count // 2 + 1) the spectrum of the room alone, at its level."""
    f = frequencies(count)
    slope = np.where(f > 20.0, 1 / np.sqrt(1 + (f / KNEE) ** 2), 0.0)
    middle, left, right = (shaped_spectrum(count, STREAMS + k, slope) for k in range(3))
    spectrum = np.stack([middle + left, middle + right])
    level = of_energies(energies(spectrum, count), 4)
    return spectrum * 10 ** ((AIR_LEVEL - level) / 20) if np.isfinite(level) else 0.0 * spectrum


def walls(count: int) -> NDArray[np.complex128]:
    """Return (2, count // 2 + 1) a ring's spectrum in the room: itself, and the walls' reflections."""
    length = round(1.2 * DECAY * RATE)
    fall = np.exp(-6.9 * np.arange(length) / RATE / DECAY)
    dull = 1 / (1 + (frequencies(length) / DULL) ** 2)
    folded = np.zeros((2, count))
    for side in range(2):
        tail = shaped(length, STREAMS + 10 + side, dull) * fall
        late = np.arange(length) + round(BEFORE * RATE)
        np.add.at(folded[side], late % count, tail * WALLS / np.sqrt((tail**2).sum()))
    return 1 + rfft(folded)


# From the stems of a machine to what is heard: balance, walls, loudness, and the room.
#
# Stems keep two thirds of the difference (dB) between them, as at a mixing desk: a motor is heard beside blows. In a
# stem nothing is changed. Together they are brought to -16 LUFS, with peaks below -2 dB so that AAC stays below -1
# dBTP; the room's air is added at its own level: it alone is heard where nothing makes a sound.

LOUDNESS = -16.0
"""LUFS"""
CEILING = 10 ** (-2.0 / 20)
BALANCE = 2 / 3
"""Part of the difference between stems, in dB, that is kept."""
QUIETEST = -190.0
"""A stem below is nothing (LUFS, 1 Pa being full scale); 0 dB of hearing are -94."""
LOWEST = 28.0
"""Frequencies below are no sound (Hz)."""


def mixed(stems: Mapping[str, Spectrum], count: int, showings: int) -> Array:
    """Return (2, count) a ring, played so many times, from spectra of stems (2, count // 2 + 1) in Pa."""
    high = 1 / (1 + (LOWEST / frequencies(count)) ** 8)
    loud = {name: of_energies(energies(stem * high, count), 4, QUIETEST) for name, stem in stems.items()}
    heard = {name: level for name, level in loud.items() if level > QUIETEST}
    air = air_noise(count)
    if not heard:
        return irfft(air, count)
    most = max(heard.values())
    whole = np.zeros((2, len(high)), complex)
    for name, level in sorted(heard.items()):
        whole += stems[name] * 10 ** ((1 - BALANCE) * (most - level) / 20)
    return levelled(whole * high * walls(count), air, count, LOUDNESS, CEILING, showings)
