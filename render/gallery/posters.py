"""Posters for a web page: small JPEGs."""

from __future__ import annotations

import io
from pathlib import Path

WIDTH = 960
LARGEST = 120_000
"""Bytes."""
QUALITIES = (88, 82, 76, 70, 62, 54, 45)


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
