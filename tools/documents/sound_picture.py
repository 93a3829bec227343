"""docs/sound.png: the sound of films of some mechanisms, wave and spectrogram.

``python -m tools.documents sound reflective_wall geneva_drive planetary_gear``, after ``make run-...`` of each.
"""

from __future__ import annotations

import io
from collections.abc import Sequence

import matplotlib as mpl

mpl.use("Agg")

import numpy as np
from matplotlib import pyplot as plt
from matplotlib.axes import Axes
from PIL import Image

from render.film.inputs import read_film
from render.sound.setting import RATE
from render.sound.sound import sound_of
from shared.stage.paths import Out
from tools.documents.figures.look import BLUE, FAINT, INK, MOVED, STYLE, plain
from tools.documents.pages import DOCS, write_changed

SECONDS = 4.0


def main(names: Sequence[str]) -> None:
    """Draw the films of the mechanisms named."""
    with plt.rc_context(STYLE):  # pyright: ignore[reportArgumentType]
        figure, axes = plt.subplots(
            2, len(names), figsize=(3.4 * len(names), 4.2), squeeze=False, sharex=True, layout="constrained",
            height_ratios=(1, 2),
        )  # fmt: skip
        for name, (wave, colours) in zip(names, axes.T, strict=True):
            _draw(name, wave, colours)
        axes[0, 0].set_ylabel("left, right")
        axes[1, 0].set_ylabel("Hz")
        buffer = io.BytesIO()
        figure.savefig(buffer, format="png", dpi=100)
    small = io.BytesIO()
    with Image.open(buffer) as picture:
        picture.convert("RGB").quantize(64).save(small, format="PNG", optimize=True)
    write_changed(DOCS / "sound.png", small.getvalue())


def _draw(name: str, above: Axes, below: Axes) -> None:
    film = read_film(Out(name))
    sound = sound_of(film)[:, : round(SECONDS * RATE)]
    t = np.arange(sound.shape[1]) / RATE
    for wave, offset, colour in zip(sound, (1.1, -1.1), (BLUE, MOVED), strict=True):
        above.plot(t[::6], wave[::6] + offset, color=colour, linewidth=0.3)
    plain(above, ylim=(-2.2, 2.2), yticks=[])
    above.set_title(name.replace("_", " "))
    below.specgram(sound.mean(axis=0) + 1e-9, NFFT=2048, Fs=RATE, noverlap=1536, vmin=-125, vmax=-40, cmap="magma")
    below.set(yscale="log", ylim=(40, 16_000), xlim=(0, SECONDS), xlabel="film, s")
    for time in film.clock.time_map.when(np.array([e.time for e in film.motion.events if e.what == "impact"]))[0]:
        below.axvline(time, color=FAINT, linewidth=0.6, linestyle=(0, (1, 3)))
    below.tick_params(colors=INK)
