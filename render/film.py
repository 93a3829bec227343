"""The film: frames, then the MP4."""

from __future__ import annotations

from render.inputs import stage_key
from render.presets import Preset
from shared.console import say
from shared.paths import Out
from shared.stages import Stage


def run(name: str, preset: Preset) -> None:
    """The stage: out/films/<mechanism>-<preset>.mp4."""
    out = Out(name)
    film = out.film(preset.name)
    stage = Stage(out, f"film-{preset.name}", stage_key(out, preset), [film])
    if stage.is_fresh():
        say("film", f"{out.name}: {preset}: nothing to do")
        return
    from render import encode, frames
    from render.store import FrameIndex, FrameStore
    from shared import jsonfile

    encode.ffmpeg()  # told now, not after the last frame
    frames.run(name, preset)
    store = FrameStore(out.frames(preset.name))
    index = jsonfile.read(store.index, FrameIndex)
    encode.encode([store.path(key) for key in index.frames], index.fps, film)
    stage.done()
    seconds = len(index.frames) / index.fps
    say("film", f"{out.name}: {film}: {seconds:.1f} s, {index.fps} frames a second, {film.stat().st_size / 1e6:.1f} MB")
