"""The film: frames, then the MP4 of pictures and sound."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from render.film.inputs import encoder_version, named, read_film, stage_key
from render.presets import Preset, has_sound
from shared.contract import is_in_space
from shared.stage.console import say
from shared.stage.files import sources_hash, write_bytes
from shared.stage.paths import Out
from shared.stage.stages import Stage, key_of, versions

if TYPE_CHECKING:
    from render.frames.store import FrameIndex, FrameStore


def run(name: str, preset: Preset, show: str = "", sound: str = "") -> None:
    """Make out/films/<mechanism>-<preset>.mp4, with the sound beside it as WAV unless ``sound`` is "off".

    What is there already is not made again: pictures that a film with other sound has are not encoded again, either.
    Raises UserError for another word than on or off.
    """
    out = Out(name)
    heard = _is_heard(out, sound)
    stage = _stage(out, preset, show, heard)
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
    silent = _silent_film(out, preset, show, store, index)
    finish(silent, partial(_sound, out, preset, show) if heard else None, len(index.frames), preset, index.fps, film)
    stage.record()
    seconds, words = len(index.frames) / index.fps, "with its sound" if heard else "silent"
    size = film.stat().st_size / 1e6
    say("film", f"{out.name}: {film}: {seconds:.1f} s, {index.fps} frames a second, {words}, {size:.1f} MB")


def is_fresh(name: str, preset: Preset, show: str = "", sound: str = "") -> bool:
    """Return True if there is nothing to do. Raises UserError where motion, parts or shot are missing."""
    return _stage(Out(name), preset, show, _is_heard(Out(name), sound)).is_fresh()


def _is_heard(out: Out, sound: str) -> bool:
    """Return True for a film with sound; that of a mechanism in space has none."""
    return has_sound(sound) and not is_in_space(out.motion)


def wav_of(film: Path) -> Path:
    """Return the WAV file beside a film."""
    return film.with_suffix(".wav")


def finish(silent: Path, sound: Callable[[], bytes] | None, count: int, preset: Preset, fps: int, film: Path) -> None:
    """Write ``film`` of ``count`` frames whole from the silent one, and beside it the WAV of ``sound``, if any."""
    from render.frames.encode import mux

    waves = wav_of(film)
    if sound is None:
        waves.unlink(missing_ok=True)
        write_bytes(film, silent.read_bytes())
        return
    write_bytes(waves, sound())
    mux(silent, waves, count, preset, fps, film)


def write_sound(out: Out, preset: Preset, show: str, target: Path) -> Path:
    """Write the sound of a film whole as the WAV file ``target``, and return it."""
    write_bytes(target, _sound(out, preset, show))
    return target


def _sound(out: Out, preset: Preset, show: str) -> bytes:
    """Return the sound of a film as the bytes of a WAV file."""
    from render.sound.sound import sound_of, wav

    return wav(sound_of(read_film(out, show, preset.aspect)))


def _stage(out: Out, preset: Preset, show: str, heard: bool) -> Stage:
    film = named(out.film(preset.name), show)
    key = stage_key(out, preset, encoder_version(), show, sound_key() if heard else "silent")
    outputs = [film, wav_of(film)] if heard else [film]
    return Stage(out, film.stem.replace(out.name, "film", 1), key, outputs)


def sound_key() -> str:
    """Return the key of the sound, without the files and the clock."""
    room = Path(__file__).parents[1]
    return key_of(sources_hash(room / "sound", Path(__file__).with_name("encode.py")), versions("numpy"))


def _silent_film(out: Out, preset: Preset, show: str, store: FrameStore, index: FrameIndex) -> Path:
    """Return the pictures encoded, in the folder of the frames; not again, where these have not changed."""
    from render.frames import encode

    film = named(out.film(preset.name), show)
    target = store.folder / film.name
    key = key_of(index.frames, index.fps, preset, encode.SETTINGS, encoder_version())
    stage = Stage(out, film.stem.replace(out.name, "pictures", 1), key, [target])
    if not stage.is_fresh():
        pictures = (content for _, content in store.contents(out.name, index.frames))
        encode.encode(pictures, len(index.frames), preset, index.fps, target)
        stage.record()
    return target
