"""The sound of machines beside each other: each where its picture is, and as loud beside the other as it is."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from render.film.film import Film
from render.film.time_map import TimeMap
from render.sound.desk import Spectrum
from render.sound.mix import mixed
from render.sound.setting import Setting
from render.sound.sound import stems_of

Array = NDArray[np.float64]
STREAMS = 100
"""From the streams of chance of a machine to those of the next: equal noises would be heard as one in the middle."""


class Heard(NamedTuple):
    """A machine that is heard."""

    film: Film
    time_map: TimeMap
    within: tuple[float, float]
    """Where its picture begins and ends in the whole one, -1 at the left edge, 1 at the right."""


def sound_of_all(machines: Sequence[Heard]) -> Array:
    """(2, n) the sound of machines whose time maps are of one length, at 48 kHz, 1 being full scale.

    Sources of one kind are balanced and levelled as one, so the louder machine is the louder one in the film.
    """
    settings = [Setting(*machine, streams=STREAMS * k) for k, machine in enumerate(machines)]
    stems: dict[str, Spectrum] = {}
    for setting in settings:
        for name, stem in stems_of(setting).items():
            stems[name] = stems[name] + stem if name in stems else stem
    return mixed(stems, settings[0].samples, 1)[:, : settings[0].heard_samples]
