"""A wave as the bytes of a WAV file: two channels of 16 bits."""

from __future__ import annotations

import io
import wave

import numpy as np
from numpy.typing import NDArray

from render.sound.setting import RATE

FULL = 32767


def wav(sound: NDArray[np.float64]) -> bytes:
    """The file of waves (2, n), 1 being full scale; what is beyond is cut."""
    samples = np.rint(np.clip(sound, -1.0, 1.0) * FULL).astype("<i2")
    buffer = io.BytesIO()
    with wave.open(buffer, "wb") as file:
        file.setnchannels(2)
        file.setsampwidth(2)
        file.setframerate(RATE)
        file.writeframes(samples.T.tobytes())
    return buffer.getvalue()
