"""The sound of a whole film."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from render.film.film import Film
from render.film.time_map import TimeMap
from render.sound.desk import Desk, Spectrum
from render.sound.mix import mixed
from render.sound.setting import RATE, Setting
from render.sound.sources import gas, impacts, knocks, mesh, motor, sliding, springs

Array = NDArray[np.float64]
SOURCES = (impacts, knocks, mesh, gas, motor, sliding, springs)
"""Springs come after impacts, which they answer."""


def sound_of(film: Film, time_map: TimeMap | None = None) -> Array:
    """(2, n) the sound of a film at 48 kHz, 1 being full scale: that of a showing, as often as it is shown.

    With a ``time_map`` it is that of another film of the same motion, once.
    """
    setting = Setting(film, time_map)
    if time_map is not None:
        return mixed(stems_of(setting), setting.samples, 1)[:, : setting.heard_samples]
    clock = film.clock
    ring = mixed(stems_of(setting), setting.samples, clock.showings)
    count = round(clock.total / film.shot.fps * RATE)
    return np.take(ring, np.arange(count) % ring.shape[1], axis=1)


def stems_of(setting: Setting) -> dict[str, Spectrum]:
    """(2, N // 2 + 1) the spectrum of what each source of a machine is heard as in a showing (Pa at 1 m)."""
    desk = Desk(setting)
    for source in SOURCES:
        if source.NAME not in setting.film.shot.sound.without:
            source.play(setting, desk)
    return desk.stems()
