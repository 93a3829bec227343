"""Posters for a web page: small JPEGs, and all of them in one."""

from __future__ import annotations

import io
import math
from collections.abc import Sequence
from pathlib import Path

import numpy as np

WIDTH = 960
LARGEST = 120_000
"""Bytes."""
QUALITIES = (88, 82, 76, 70, 62, 54, 45)
TILE = 320, 180
"""Pixels of a picture in the strip."""
BESIDE = 4
"""Pictures in a row of it."""
ON_STRIP = 16
LOOK = 24, 14
"""Pixels in which two pictures are compared."""


def small_poster(path: Path) -> bytes:
    """A picture as a JPEG of at most LARGEST bytes, at the best quality that fits."""
    from PIL import Image

    with Image.open(path) as whole:
        picture = whole.convert("RGB")
    content = b""
    for width in (WIDTH, 3 * WIDTH // 4, WIDTH // 2):
        small = picture
        if picture.width > width:
            size = width, round(width * picture.height / picture.width)
            small = picture.resize(size, Image.Resampling.LANCZOS)
        for quality in QUALITIES:
            buffer = io.BytesIO()
            small.save(buffer, format="JPEG", quality=quality, optimize=True, progressive=True)
            content = buffer.getvalue()
            if len(content) <= LARGEST:
                return content
    return content


def strip(posters: Sequence[bytes]) -> bytes:
    """Small posters in rows, as one JPEG; the last row is filled from its middle.

    More than ``ON_STRIP`` are too many for one look: those are taken that are least like each other.
    """
    from PIL import Image, ImageOps

    wide, high = TILE
    tiles = [ImageOps.fit(Image.open(io.BytesIO(poster)), TILE, Image.Resampling.LANCZOS) for poster in posters]
    tiles = [tiles[k] for k in unlike([np.asarray(tile.convert("RGB").resize(LOOK), float) for tile in tiles])]
    rows = math.ceil(len(tiles) / BESIDE)
    sheet = Image.new("RGB", (BESIDE * wide, rows * high), tiles[0].getpixel((2, 2)))
    for row in range(rows):
        beside = tiles[row * BESIDE : (row + 1) * BESIDE]
        left = (BESIDE - len(beside)) * wide // 2
        for k, tile in enumerate(beside):
            sheet.paste(tile, (left + k * wide, row * high))
    content = b""
    for quality in QUALITIES:
        buffer = io.BytesIO()
        sheet.save(buffer, format="JPEG", quality=quality, optimize=True, progressive=True)
        content = buffer.getvalue()
        if len(content) <= 2 * LARGEST:
            break
    return content


def unlike(looks: Sequence[np.ndarray]) -> list[int]:
    """Numbers of ON_STRIP pictures in their order: each next one is the one least like all that are taken already."""
    flat = np.stack([look.ravel() for look in looks])
    if len(flat) <= ON_STRIP:
        return list(range(len(flat)))
    taken = [int(((flat - flat.mean(axis=0)) ** 2).sum(axis=1).argmax())]
    while len(taken) < ON_STRIP:
        off = ((flat[:, None] - flat[taken]) ** 2).sum(axis=2).min(axis=1)
        taken.append(int(off.argmax()))
    return sorted(taken)
