"""The sound of a film, alone or in a story, and its wave file."""

from __future__ import annotations

import io
import wave
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from render.film.clock import TimeMap
from render.film.film import Film
from render.sound.desk import Desk, Spectrum
from render.sound.mix import LOUDNESS, energies, mixed
from render.sound.setting import RATE, Setting
from render.sound.sources import gas, impacts, knocks, mesh, motor, sliding, springs
from render.sound.waves import rfft

# The sound of a whole film.

Array = NDArray[np.float64]
SOURCES = (impacts, knocks, mesh, gas, motor, sliding, springs)
"""Springs come after impacts, which they answer."""


def sound_of(film: Film, time_map: TimeMap | None = None) -> Array:
    """Return (2, n) the sound of a film at 48 kHz, 1 being full scale.

    It is the sound of a showing, as often as that is shown. With a ``time_map`` it is that of another film of the same
    motion, once.
    """
    setting = Setting(film, time_map)
    if time_map is not None:
        return mixed(stems_of(setting), setting.samples, 1)[:, : setting.heard_samples]
    clock = film.clock
    ring = mixed(stems_of(setting), setting.samples, clock.showings)
    count = round(clock.total / film.shot.fps * RATE)
    return np.take(ring, np.arange(count) % ring.shape[1], axis=1)


BED, FADE = -9.0, 0.3
"""dB: level of the machine under pictures whose time stands, beside that in motion; seconds in which it comes."""
EVEN, MOST = 3000, 12.0
"""ms over which that level is kept even, and the gain that this takes at most (dB)."""


def sound_of_story(film: Film, time_map: TimeMap) -> Array:
    """Return (2, n) the sound of a story at 48 kHz, 1 being full scale.

    Where its time stands the machine is heard from afar, as it runs in its film, so that no silence breaks off. A
    passage that is quiet in the film is not, there: the next picture would begin with a bang.
    """
    wave, ring = sound_of(film, time_map), _evened(sound_of(film))
    count, step = wave.shape[1], RATE // 100
    stands = (time_map.moments_at(np.arange(0, count, step) / RATE)[1] == 0.0).astype(float)
    bell = np.hanning(round(FADE * 100) + 2)[1:-1]
    stands = np.convolve(np.pad(stands, len(bell) // 2, mode="edge"), bell / bell.sum(), mode="valid")
    level = 10 ** (BED / 20) * np.interp(np.arange(count), step * np.arange(len(stands)), stands)
    return wave + level * np.take(ring, np.arange(count) % ring.shape[1], axis=1)


def _evened(ring: Array) -> Array:
    """Return a ring (2, n) whose loudness is that of a whole film wherever it is measured over EVEN."""
    count = ring.shape[1]
    energy = energies(rfft(ring), count)
    width = min(EVEN, len(energy))
    sums = np.concatenate([[0.0], np.cumsum(np.tile(energy, 3))])
    first = len(energy) + np.arange(len(energy)) - width // 2
    around = (sums[first + width] - sums[first]) / width
    wanted = 10 ** ((LOUDNESS + 0.691) / 10)
    gain = np.clip(np.sqrt(wanted / np.maximum(around, 1e-30)), 10 ** (-MOST / 20), 10 ** (MOST / 20))
    return ring * np.interp(np.arange(count), (np.arange(len(gain)) + 0.5) * (count / len(gain)), gain, period=count)


def stems_of(setting: Setting) -> dict[str, Spectrum]:
    """Return the spectrum (2, N // 2 + 1) of each source of a machine in a showing (Pa at 1 m)."""
    desk = Desk(setting)
    for source in SOURCES:
        if source.NAME not in setting.film.shot.sound.without:
            source.play(setting, desk)
    return desk.stems()


# The sound of machines beside each other: each where its picture is, and as loud beside the other as it is.

STREAMS = 100
"""Distance of the streams of chance of two machines: equal noises would be heard as one in the middle."""


class Heard(NamedTuple):
    """A machine that is heard."""

    film: Film
    time_map: TimeMap
    within: tuple[float, float]
    """Start and end of its picture in the whole one, -1 at the left edge, 1 at the right."""


def sound_of_all(machines: Sequence[Heard]) -> Array:
    """Return (2, n) the sound of machines at 48 kHz, 1 being full scale.

    Their time maps are of one length.

    Sources of one kind are balanced and levelled as one, so the louder machine is the louder one in the film.
    """
    settings = [Setting(*machine, streams=STREAMS * k) for k, machine in enumerate(machines)]
    stems: dict[str, Spectrum] = {}
    for setting in settings:
        for name, stem in stems_of(setting).items():
            stems[name] = stems[name] + stem if name in stems else stem
    return mixed(stems, settings[0].samples, 1)[:, : settings[0].heard_samples]


# A wave as the bytes of a WAV file: two channels of 16 bits.

FULL = 32767


def wav(sound: NDArray[np.float64]) -> bytes:
    """Return the file of waves (2, n), 1 being full scale; what is beyond is cut."""
    samples = np.rint(np.clip(sound, -1.0, 1.0) * FULL).astype("<i2")
    buffer = io.BytesIO()
    with wave.open(buffer, "wb") as file:
        file.setnchannels(2)
        file.setsampwidth(2)
        file.setframerate(RATE)
        file.writeframes(samples.T.tobytes())
    return buffer.getvalue()
