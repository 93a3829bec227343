"""The film: frames, then the MP4."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

from render.film.inputs import encoder_version, named, stage_key
from render.presets import Preset
from shared.stage.console import say
from shared.stage.errors import UserError
from shared.stage.paths import Out
from shared.stage.stages import Stage

if TYPE_CHECKING:
    from render.frames.store import FrameStore


def run(name: str, preset: Preset, show: str = "") -> None:
    """The stage: out/films/<mechanism>-<preset>.mp4."""
    out = Out(name)
    stage = _stage(out, preset, show)
    film = stage.outputs[0]
    if stage.is_fresh():
        say("film", f"{out.name}: {preset}: nothing to do")
        return
    from render.frames import encode, frames
    from render.frames.store import FrameIndex, FrameStore
    from shared.stage import jsonfile

    encode.ffmpeg()  # reported now, not after the last frame
    frames.run(name, preset, show)
    store = FrameStore(out.frames(preset.name), (preset.width, preset.height))
    index = jsonfile.read(store.index, FrameIndex)
    encode.encode(_pictures(out.name, store, index.frames), len(index.frames), preset, index.fps, film)
    stage.done()
    seconds = len(index.frames) / index.fps
    say("film", f"{out.name}: {film}: {seconds:.1f} s, {index.fps} frames a second, {film.stat().st_size / 1e6:.1f} MB")


def is_fresh(name: str, preset: Preset, show: str = "") -> bool:
    """Whether there is nothing to do. Raises UserError where motion, parts or shot are missing."""
    return _stage(Out(name), preset, show).is_fresh()


def _stage(out: Out, preset: Preset, show: str) -> Stage:
    film = named(out.film(preset.name), show)
    return Stage(out, film.stem.replace(out.name, "film", 1), stage_key(out, preset, encoder_version(), show), [film])


def _pictures(mechanism: str, store: FrameStore, names: Sequence[str]) -> Iterator[bytes]:
    """The pictures in order, each compared with the hash in its name; the bytes compared are the bytes filmed."""
    for number, name in enumerate(names):
        content = store.read(name)
        if content is None:
            store.find(name.partition("-")[0])  # removes it, so that it is missed
            raise UserError(
                f"{mechanism}: frame {number} ({name}) changed or went while the film was written; the same command "
                "renders it again"
            )
        yield content
