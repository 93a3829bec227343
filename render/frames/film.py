"""The film: frames, then the MP4 of pictures and sound."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from render.film.inputs import encoder_version, named, read_film, stage_key
from render.presets import Preset, has_sound
from shared.stage.console import say
from shared.stage.errors import UserError
from shared.stage.files import sources_hash, write_bytes
from shared.stage.paths import Out
from shared.stage.stages import Stage, key_of, versions

if TYPE_CHECKING:
    from render.frames.store import FrameIndex, FrameStore


def run(name: str, preset: Preset, show: str = "", sound: str = "") -> None:
    """The stage: out/films/<mechanism>-<preset>.mp4, with the sound beside it as WAV unless ``sound`` is "off".

    What is there already is not made again: pictures that a film with other sound has are not encoded again, either.
    Raises UserError for another word than on or off.
    """
    out = Out(name)
    heard = has_sound(sound)
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
    if heard:
        from render.frames import encode

        waves = write_sound(out, preset, show, wav_of(film))
        encode.mux(silent, waves, len(index.frames), preset, index.fps, film)
    else:
        wav_of(film).unlink(missing_ok=True)
        write_bytes(film, silent.read_bytes())
    stage.record()
    seconds, words = len(index.frames) / index.fps, "with its sound" if heard else "silent"
    size = film.stat().st_size / 1e6
    say("film", f"{out.name}: {film}: {seconds:.1f} s, {index.fps} frames a second, {words}, {size:.1f} MB")


def is_fresh(name: str, preset: Preset, show: str = "", sound: str = "") -> bool:
    """Return True if there is nothing to do. Raises UserError where motion, parts or shot are missing."""
    return _stage(Out(name), preset, show, has_sound(sound)).is_fresh()


def wav_of(film: Path) -> Path:
    """Return the WAV file beside a film."""
    return film.with_suffix(".wav")


def write_sound(out: Out, preset: Preset, show: str, target: Path) -> Path:
    """Return the sound of a film as a WAV file, written whole."""
    from render.sound.sound import sound_of, wav

    write_bytes(target, wav(sound_of(read_film(out, show, preset.aspect))))
    return target


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
        encode.encode(_pictures(out.name, store, index.frames), len(index.frames), preset, index.fps, target)
        stage.record()
    return target


def _pictures(mechanism: str, store: FrameStore, names: Sequence[str]) -> Iterator[bytes]:
    """Yield the pictures in order, each compared with the hash in its name; the bytes compared are the bytes filmed."""
    for number, name in enumerate(names):
        content = store.read(name)
        if content is None:
            store.find(name.partition("-")[0])  # removes it, so that it is missed
            raise UserError(
                f"{mechanism}: frame {number} ({name}) changed or went while the film was written; the same command "
                "renders it again"
            )
        yield content
