"""The sound of a showreel: that of its films under their pictures, and silence under titles and silent films."""

from __future__ import annotations

import subprocess
import wave
from collections.abc import Sequence
from pathlib import Path

from render.frames.encode import ffmpeg
from render.showreel.clip import PATIENCE, Clip

RATE, FRAME = 48_000, 4
"""Samples a second; bytes of one, of two channels of 16 bits."""


def write_sound(row: Sequence[Clip], fps: int, target: Path) -> bool:
    """Write the sound of clips in a row as a WAV file; False, and no file, where none of them has any."""
    sounds = [_samples(clip) for clip in row]
    if not any(sounds):
        return False
    frames = 0
    with wave.open(str(target), "wb") as file:
        file.setnchannels(2)
        file.setsampwidth(2)
        file.setframerate(RATE)
        for clip, sound in zip(row, sounds, strict=True):
            first, last = (round(count / fps * RATE) for count in (frames, frames + clip.frames))
            long = (last - first) * FRAME
            file.writeframes(sound[:long].ljust(long, b"\0"))
            frames += clip.frames
    return True


def _samples(clip: Clip) -> bytes:
    """The samples of a film; empty of one without a sound."""
    command = [ffmpeg(), "-v", "error", "-i", str(clip.path), "-map", "0:a:0?", "-ac", "2", "-ar", str(RATE)]
    done = subprocess.run([*command, "-f", "s16le", "-"], capture_output=True, timeout=PATIENCE)
    return done.stdout if done.returncode == 0 else b""
