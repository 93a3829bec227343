"""``python -m studio.verify.again NAME PRESET FRAMES SHOW``: render frames in a process of their own.

PRESET is its fields, ``preview,1280,720,8,0,128``. Motion, solids and shot are those of $MBSD_OUT, which gets the
pictures.
"""

from __future__ import annotations

import sys
from dataclasses import astuple

from render.film.inputs import read_film
from render.frames.frames import Pictures, Tally, render
from render.frames.store import FrameStore
from render.presets import Preset
from shared.stage.console import run_cli
from shared.stage.paths import Out


def preset_words(preset: Preset) -> str:
    """Return a preset as a word of the command line."""
    return ",".join(str(int(field) if isinstance(field, bool) else field) for field in astuple(preset))


def main() -> None:
    """Render the frames."""
    name, words, numbers, show = sys.argv[1:]
    kind, width, height, samples, blur, poster = words.split(",")
    out, preset = Out(name), Preset(kind, int(width), int(height), int(samples), bool(int(blur)), int(poster))
    film, store = read_film(out, show, preset.aspect), FrameStore(out.frames(preset.name))
    frames = sorted({int(number) % film.clock.frames for number in numbers.split(",")})
    with store.locked():
        render(Pictures(film, preset), store, frames, "to compare", Tally())


if __name__ == "__main__":
    run_cli(main)
