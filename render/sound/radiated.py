"""How loud a power or a force is heard at 1 m.

    power P (W), of which a part eta leaves as sound:     p = sqrt(eta P rho_0 c / (4 pi r^2))
    force F (N) at frequency f on a frame that is small beside the waves:   p = F f / (2 c r)      (a dipole)

Source: Fahy, Gardonio, Sound and Structural Vibration, 2007, chapter 3.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from render.sound.ringing import AIR, SPEED_OF_SOUND

Array = NDArray[np.float64]


def of_power(power: Array, efficiency: float) -> Array:
    """(n,) pressure (Pa) at 1 m of powers (W)."""
    return np.sqrt(efficiency * np.maximum(power, 0.0) * AIR * SPEED_OF_SOUND / (4 * np.pi))


def of_force(force: Array, frequency: Array) -> Array:
    """(n,) pressure (Pa) at 1 m of forces (N) that change at a frequency (Hz)."""
    return np.abs(force) * frequency / (2 * SPEED_OF_SOUND)
