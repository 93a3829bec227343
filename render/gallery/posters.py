"""Posters for a web page: small JPEGs, and all of them in one."""

from __future__ import annotations

import io
import math
from collections.abc import Sequence
from pathlib import Path

WIDTH = 960
LARGEST = 120_000
"""Bytes."""
QUALITIES = (88, 82, 76, 70, 62, 54, 45)
TILE = 320, 180
"""Pixels of a picture in the strip."""
BESIDE = 4
"""Pictures in a row of it."""
ON_STRIP = 16


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

    More than ``ON_STRIP`` are too many for one look: some are taken, at equal distances.
    """
    from PIL import Image, ImageOps

    if len(posters) > ON_STRIP:
        posters = [posters[k * len(posters) // ON_STRIP] for k in range(ON_STRIP)]
    wide, high = TILE
    rows = math.ceil(len(posters) / BESIDE)
    tiles = [ImageOps.fit(Image.open(io.BytesIO(poster)), TILE, Image.Resampling.LANCZOS) for poster in posters]
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
