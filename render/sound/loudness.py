"""Loudness after EBU R 128, which is ITU-R BS.1770-4: LUFS of stereo waves.

    K-weighting      two biquads at 48 kHz, a high shelf of 4 dB and a high pass at 38 Hz
    block            z = sum over channels of the mean square of 400 ms, every 100 ms;   l = -0.691 + 10 log10 z
    gates            blocks above -70 LUFS, then those above their mean less 10 LU;   the loudness is that of their mean

What is measured here is a ring that is played several times; its blocks go round its end.
"""

from __future__ import annotations

from functools import lru_cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from render.sound.fourier import irfft, rfft

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
    """The K-weighting at the frequencies of the spectrum of a ring of so many samples."""
    z = np.exp(-2j * np.pi * np.fft.rfftfreq(count))
    gain = np.ones_like(z)
    for above, below in (SHELF, HIGH_PASS):
        gain *= np.polyval(above[::-1], z) / np.polyval(below[::-1], z)
    return gain


def energies(spectrum: NDArray[np.complex128], count: int) -> Array:
    """(m,) mean squares of each ms of a ring of so many samples, K-weighted, both channels together, from its spectrum
    (2, count // 2 + 1)."""
    square = (irfft(spectrum * weighting(count), count) ** 2).sum(axis=0)
    if count < STEP:
        return np.array([square.mean()])
    whole = count // STEP
    return square[: whole * STEP].reshape(whole, STEP).mean(axis=1)


def of_energies(energy: Array, showings: int = 1, floor: float = ABSOLUTE) -> float:
    """Integrated loudness (LUFS) of a ring with these mean squares a ms, played so many times; -inf of silence.

    ``floor`` is the absolute gate (LUFS), for waves that have no level yet.
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
    """Integrated loudness (LUFS) of a ring (2, N) that is played so many times."""
    return of_energies(energies(rfft(wave), wave.shape[1]), showings, floor)


def _lufs(square: Any) -> Any:
    return -0.691 + 10 * np.log10(np.maximum(square, 1e-30))
