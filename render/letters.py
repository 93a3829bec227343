"""The letters of what is written over pictures: their font, and how wide words are."""

from __future__ import annotations

import importlib.util
from functools import lru_cache
from pathlib import Path
from typing import Any

MEASURED = 200.0
"""Pixels of the letters by which words are measured: large, so that nothing is rounded to a pixel."""


def font_of(size: float, bold: bool = False) -> Any:
    """Return Inter, which Blender brings along, ``size`` pixels high; without it Pillow's own font."""
    from PIL import ImageFont

    path = _inter()
    if path is None:
        return ImageFont.load_default(max(1.0, size))
    font = ImageFont.truetype(path, max(1.0, size))
    font.set_variation_by_axes([14, 600 if bold else 450])
    return font


def width_of(words: str, bold: bool = False) -> float:
    """Return the width of a line of words, in heights of its letters."""
    return _measuring(bold).getlength(words) / MEASURED


@lru_cache(maxsize=2)
def _measuring(bold: bool) -> Any:
    return font_of(MEASURED, bold)


@lru_cache(maxsize=1)
def _inter() -> Path | None:
    blender = importlib.util.find_spec("bpy")
    places = Path(blender.origin).parent.glob("*/datafiles/fonts/Inter.woff2") if blender and blender.origin else ()
    return next(iter(places), None)
