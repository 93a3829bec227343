"""The room: its air, at a fixed level, and what its walls give back of the machine.

    air      noise that falls by 6 dB an octave above 200 Hz, a little other at each ear, at -50 LUFS
    walls    h(t) = noise exp(-6.9 t / T) after 5 ms, T = 0.3 s, duller with time; 12 dB below what comes directly

A machine that makes no sound is in the same room, and no louder.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from render.sound.chance import frequencies, shaped, shaped_spectrum
from render.sound.fourier import rfft
from render.sound.loudness import energies, of_energies

Array = NDArray[np.float64]
RATE = 48_000
AIR_LEVEL = -50.0
"""LUFS"""
KNEE = 200.0
DECAY, BEFORE = 0.3, 0.005
"""Reverberation time and first delay (s)."""
WALLS = 10 ** (-12 / 20)
"""Size of what the walls give back, over that of the machine itself."""
DULL = 4000.0
"""Above this frequency walls give back less (Hz)."""
STREAMS = 100
"""Number of the first of its streams of chance."""


def air(count: int) -> NDArray[np.complex128]:
    """(2, count // 2 + 1) the spectrum of the room alone, at its level."""
    f = frequencies(count)
    slope = np.where(f > 20.0, 1 / np.sqrt(1 + (f / KNEE) ** 2), 0.0)
    middle, left, right = (shaped_spectrum(count, STREAMS + k, slope) for k in range(3))
    spectrum = np.stack([middle + left, middle + right])
    level = of_energies(energies(spectrum, count), 4)
    return spectrum * 10 ** ((AIR_LEVEL - level) / 20) if np.isfinite(level) else 0.0 * spectrum


def walls(count: int) -> NDArray[np.complex128]:
    """(2, count // 2 + 1) what the room makes of a ring's spectrum: itself, and what the walls give back."""
    length = round(1.2 * DECAY * RATE)
    fall = np.exp(-6.9 * np.arange(length) / RATE / DECAY)
    dull = 1 / (1 + (frequencies(length) / DULL) ** 2)
    folded = np.zeros((2, count))
    for side in range(2):
        tail = shaped(length, STREAMS + 10 + side, dull) * fall
        late = np.arange(length) + round(BEFORE * RATE)
        np.add.at(folded[side], late % count, tail * WALLS / np.sqrt((tail**2).sum()))
    return 1 + rfft(folded)
