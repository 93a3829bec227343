"""Waves: spectra of rings of samples, and noise."""

from __future__ import annotations

import math

import numpy as np
import scipy.fft
from numpy.typing import NDArray

# Spectra of rings of samples, by scipy's pocketfft: the same bytes for the same samples.
#
# A length with large prime factors takes up to four times as long; :func:`quick_length` has none.

Array = NDArray[np.float64]
Spectrum = NDArray[np.complex128]


def rfft(wave: Array) -> Spectrum:
    """Return (..., n // 2 + 1) the spectrum of rings (..., n)."""
    return np.asarray(scipy.fft.rfft(wave))


def irfft(spectrum: Spectrum, count: int) -> Array:
    """Return (..., count) the rings with these spectra (..., count // 2 + 1)."""
    return np.asarray(scipy.fft.irfft(spectrum, count))


def quick_length(count: int) -> int:
    """Return the least number from ``count`` on that 2, 3 and 5 alone divide."""
    return int(scipy.fft.next_fast_len(count, real=True) or count)


# Noise that is the same in every run: phases by a counter (Philox 4x64), so nothing depends on earlier draws.
#
# A ring of N samples has the spectrum |X_k| exp(2 pi i u_k), u_k the k-th number of a stream of the counter;
# its amplitudes are smooth, so it has no chance levels, and it closes without a seam. Source: Salmon et al., Parallel
# Random Numbers: As Easy as 1, 2, 3, SC 2011.

KEY = 0x6D627364
"""The key of all streams, beside their own numbers."""
RATE = 48_000
OCTAVE = 0.5
"""Width of an octave's bell, in octaves."""


def uniform(count: int, stream: int) -> Array:
    """Return (count,) numbers 0 .. 1 of a stream."""
    raw = np.random.Philox(key=[KEY, stream]).random_raw(count)
    return (raw >> np.uint64(11)).astype(np.float64) * 2.0**-53


def shaped(count: int, stream: int, amplitude: Array) -> Array:
    """Return (count,) noise of rms 1 whose spectrum has these amplitudes (count // 2 + 1,)."""
    return irfft(shaped_spectrum(count, stream, amplitude), count)


def shaped_spectrum(count: int, stream: int, amplitude: Array) -> NDArray[np.complex128]:
    """Return (count // 2 + 1,) its spectrum; the rms is that of Parseval's theorem."""
    spectrum = amplitude.astype(np.complex128) * np.exp(2j * np.pi * uniform(len(amplitude), stream))
    spectrum[0] = 0.0
    if count % 2 == 0:
        spectrum[-1] = spectrum[-1].real
    power = 2 * np.vdot(spectrum, spectrum).real - (abs(spectrum[-1]) ** 2 if count % 2 == 0 else 0.0)
    spectrum *= count / max(math.sqrt(power), 1e-300)
    return spectrum


def octave_noise(count: int, centre: float, stream: int) -> Array:
    """Return (count,) noise of rms 1 about a frequency (Hz)."""
    return shaped(count, stream, np.exp(-0.5 * (np.log2(frequencies(count) / centre) / OCTAVE) ** 2))


def frequencies(count: int) -> Array:
    """Return frequencies (Hz) of the spectrum of a ring; the first is near 0 and not 0."""
    return np.maximum(np.fft.rfftfreq(count, 1 / RATE), 1e-3)
