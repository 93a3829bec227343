"""Spectra of rings of samples, by scipy's pocketfft: the same bytes for the same samples.

A length with large prime factors takes up to four times as long; :func:`quick_length` has none.
"""

from __future__ import annotations

import numpy as np
import scipy.fft
from numpy.typing import NDArray

Array = NDArray[np.float64]
Spectrum = NDArray[np.complex128]


def rfft(wave: Array) -> Spectrum:
    """(..., n // 2 + 1) the spectrum of rings (..., n)."""
    return np.asarray(scipy.fft.rfft(wave))


def irfft(spectrum: Spectrum, count: int) -> Array:
    """(..., count) the rings with these spectra (..., count // 2 + 1)."""
    return np.asarray(scipy.fft.irfft(spectrum, count))


def quick_length(count: int) -> int:
    """The least number from ``count`` on that 2, 3 and 5 alone divide."""
    return int(scipy.fft.next_fast_len(count, real=True) or count)
