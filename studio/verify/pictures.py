"""Pixels of chosen frames, compared with the same frames rendered again."""

from __future__ import annotations

import io

import numpy as np

from render.frames.store import FrameIndex, FrameStore
from shared.stage import jsonfile
from shared.stage.errors import UserError
from studio.verify.finding import Finding

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


def compared(frame: int, name: str, store: FrameStore, again: FrameStore) -> Finding:
    """Compare the picture of a frame with the one rendered again.

    ``name`` is its file's in the film's index.
    """
    what = f"frame {frame}"
    old = store.read(name)
    if old is None:
        return Finding(what, "differs", f"{name} is gone, or is not the picture that was rendered any more")
    new = next(iter(sorted(again.folder.glob(f"{name.partition('-')[0]}-*.png"))), None)
    if new is None:
        return Finding(what, "outdated", "the film was made from another motion, other solids, another shot or sources")
    return pixels(what, old, new.read_bytes())


def pixels(what: str, old: bytes, new: bytes) -> Finding:
    """Compare two PNGs by their pixels."""
    ours, other = _decoded(old), _decoded(new)
    if ours.shape != other.shape:
        return Finding(what, "differs", f"{_size(ours)} pixels, made again {_size(other)}")
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
