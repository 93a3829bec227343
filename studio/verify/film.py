"""Film compared with one made again: chosen frames pixel by pixel, its pictures encoded, its sound."""

from __future__ import annotations

import io
import re
import subprocess
from collections.abc import Iterator
from pathlib import Path

import numpy as np

from render.frames import encode
from render.frames.store import FrameIndex, FrameStore
from render.presets import Preset
from shared.stage import jsonfile
from shared.stage.errors import UserError
from shared.stage.face import to_run
from studio.verify.files import Finding

# Pixels of chosen frames, compared with the same frames rendered again.


CHOSEN = 3
"""Frames if none are named, in equal steps from the first."""


def index_of(store: FrameStore) -> FrameIndex | None:
    """Return the index of frames to pictures; None if the film was never rendered here."""
    return jsonfile.read(store.index, FrameIndex) if store.index.is_file() else None


def chosen(words: str, count: int, mechanism: str) -> list[int]:
    """Return the frame numbers of ``0,30,60``, or three of them.

    Raises UserError for a frame outside of the film.
    """
    if not words.strip():
        return sorted({k * count // CHOSEN for k in range(CHOSEN)})
    frames = []
    for word in words.replace(",", " ").split():
        if not word.isascii() or not word.isdigit() or int(word) >= count:
            raise UserError(f"{mechanism}: there is no frame {word!r}; the film has frames 0 to {count - 1}")
        frames.append(int(word))
    return sorted(set(frames))


def compare_frame(frame: int, name: str, store: FrameStore, again: FrameStore) -> Finding:
    """Compare the picture of a frame with the one rendered again.

    ``name`` is its file's in the film's index.
    """
    what = f"frame {frame}"
    old = store.read(name)
    if old is None:
        return Finding(what, "differs", f"{name} is gone or was changed since it was rendered")
    new = next(iter(sorted(again.folder.glob(f"{name.partition('-')[0]}-*.png"))), None)
    if new is None:
        return Finding(what, "outdated", "the film was made from another motion, other solids, another shot or sources")
    return pixels(what, old, new.read_bytes())


def pixels(what: str, old: bytes, new: bytes) -> Finding:
    """Compare two PNGs by their pixels."""
    ours, other = _decoded(old), _decoded(new)
    if ours.shape != other.shape:
        return Finding(what, "differs", f"{_size(ours)} pixels, rebuilt {_size(other)}")
    far = np.abs(ours.astype(np.int16) - other).max(axis=2)
    if not far.any():
        beside = "the same bytes" if old == new else "other bytes around the same pixels"
        return Finding(what, "same", f"{_size(ours)} pixels, {beside}")
    rows, columns = np.nonzero(far)
    return Finding(
        what,
        "differs",
        f"{len(rows)} of {far.size} pixels by up to {far.max()} of 255, the first at ({columns[0]}, {rows[0]})",
    )


def _size(picture: np.ndarray) -> str:
    return f"{picture.shape[1]}x{picture.shape[0]}"


def _decoded(content: bytes) -> np.ndarray:
    """Return the pixels, rows x columns x 3, 0..255."""
    from PIL import Image

    with Image.open(io.BytesIO(content)) as picture:
        return np.asarray(picture.convert("RGB"))


# Film: its pictures encoded again, its sound computed again, and both films compared.


PATIENCE = 3600.0
"""Seconds for decoding a film."""


def compare_film(
    film: Path, scratch: Path, store: FrameStore, index: FrameIndex, preset: Preset, sound: Path | None = None
) -> Finding:
    """Compare every decoded frame of the film with one encoded from the same pictures.

    ``sound`` is its sound made again, of a film that has some.
    """
    if not film.is_file():
        return Finding("film", "missing", f"{film.name} does not exist")
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
        return Finding("film", "differs", f"{len(old)} frames decode, rebuilt {len(new)}")
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
