"""From the stems of a machine to what is heard: balance, walls, loudness, and the room.

Stems keep two thirds of the difference (dB) between them, as at a mixing desk: a motor is heard beside blows. In a
stem nothing is changed. Together they are brought to -16 LUFS, with peaks below -2 dB so that AAC stays below -1 dBTP;
the room's air is added at its own level: it alone is heard where nothing makes a sound.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from render.sound import limiter, room
from render.sound.chance import frequencies
from render.sound.fourier import irfft
from render.sound.loudness import energies, of_energies

Array = NDArray[np.float64]
Spectrum = NDArray[np.complex128]
LOUDNESS = -16.0
"""LUFS"""
CEILING = 10 ** (-2.0 / 20)
BALANCE = 2 / 3
"""Part of the difference between stems, in dB, that is kept."""
QUIETEST = -190.0
"""A stem below is nothing (LUFS, 1 Pa being full scale); 0 dB of hearing are -94."""
LOWEST = 28.0
"""What is below is no sound (Hz)."""


def mixed(stems: Mapping[str, Spectrum], count: int, showings: int) -> Array:
    """(2, count) a ring that is played so many times, from spectra of stems (2, count // 2 + 1) in Pa."""
    high = 1 / (1 + (LOWEST / frequencies(count)) ** 8)
    loud = {name: of_energies(energies(stem * high, count), 4, QUIETEST) for name, stem in stems.items()}
    heard = {name: level for name, level in loud.items() if level > QUIETEST}
    air = room.air(count)
    if not heard:
        return irfft(air, count)
    most = max(heard.values())
    whole = np.zeros((2, len(high)), complex)
    for name, level in sorted(heard.items()):
        whole += stems[name] * 10 ** ((1 - BALANCE) * (most - level) / 20)
    return limiter.levelled(whole * high * room.walls(count), air, count, LOUDNESS, CEILING, showings)
