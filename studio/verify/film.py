"""Film: its pictures encoded again, its sound computed again, and both films compared."""

from __future__ import annotations

import re
import subprocess
from collections.abc import Iterator
from pathlib import Path

from render.frames import encode
from render.frames.store import FrameIndex, FrameStore
from render.presets import Preset
from shared.stage.errors import UserError
from shared.stage.face import to_run
from studio.verify.finding import Finding

PATIENCE = 3600.0
"""Seconds for decoding a film."""


def compared(
    film: Path, scratch: Path, store: FrameStore, index: FrameIndex, preset: Preset, sound: Path | None = None
) -> Finding:
    """Compare every decoded frame of the film with one encoded from the same pictures.

    ``sound`` is its sound made again, of a film that has some.
    """
    if not film.is_file():
        return Finding("film", "missing", f"{film.name} is not there")
    damaged = sorted({name for name in index.frames if store.read(name) is None})
    if damaged:
        return Finding("film", "differs", f"{len(damaged)} of its pictures are gone or damaged, such as {damaged[0]}")
    again = scratch / film.name
    silent = again if sound is None else again.with_suffix(".silent.mp4")
    encode.encode(_pictures(store, index), len(index.frames), preset, index.fps, silent)
    if sound is not None:
        encode.mux(silent, sound, len(index.frames), preset, index.fps, again)
    try:
        old, new = decoded(film), decoded(again)
    except UserError as error:
        return Finding("film", "differs", str(error))
    whole = "the same file" if film.read_bytes() == again.read_bytes() else "other bytes around the same frames"
    if old == new:
        return Finding("film", "same", f"{len(old)} decoded frames, {whole}")
    if len(old) != len(new):
        return Finding("film", "differs", f"{len(old)} frames decode, made again {len(new)}")
    wrong = [k for k, (a, b) in enumerate(zip(old, new, strict=True)) if a != b]
    return Finding("film", "differs", f"{len(wrong)} of {len(old)} decoded frames, the first is frame {wrong[0]}")


def _pictures(store: FrameStore, index: FrameIndex) -> Iterator[bytes]:
    for name in index.frames:
        content = store.read(name)
        if content is None:
            raise UserError(f"{store.folder / name} changed while it was compared; run the same command again")
        yield content


def decoded(film: Path) -> list[str]:
    """Return the SHA-256 of each decoded frame of a film. Raises UserError if it does not decode."""
    command = [encode.ffmpeg(), "-v", "error", "-xerror", "-i", str(film)]
    command += ["-map", "0:v:0", "-f", "framehash", "-hash", "sha256", "-"]
    done = subprocess.run(command, capture_output=True, text=True, errors="replace", timeout=PATIENCE)
    if done.returncode or done.stderr.strip():
        said = (done.stderr.strip().splitlines() or [f"code {done.returncode}"])[-1]
        raise UserError(f"{film} does not decode ({said}); remove it, and {to_run('film', '<name>')} writes it again")
    return [re.split(r",\s*", line)[-1] for line in done.stdout.splitlines() if line and not line.startswith("#")]
