"""The pictures of docs/ on dark paper: the same SVG with its colours exchanged, for pages that a dark system shows."""

from __future__ import annotations

import re
from functools import cache

import matplotlib as mpl
from matplotlib.colors import to_hex

from mbsd.drawing import look
from mbsd.drawing.look import on_dark

COLOUR = re.compile(r"#[0-9a-f]{6}\b")
PAPER = "#0d1117"
"""Colour of GitHub's dark pages."""
NEUTRAL = {
    look.PAPER: PAPER,
    look.INK: "#e6edf3",
    look.QUIET: "#9198a1",
    look.FAINT: "#262c36",
    look.LOAD: "#a9b6c6",
}
MAPS = ("viridis",)
"""Colours of data stay what their bar says."""


def dark(svg: bytes) -> bytes:
    """An SVG of mbsd or of matplotlib on dark paper. What has no colour of its own is black in SVG: ink."""
    text = COLOUR.sub(lambda match: exchanged(match[0]), svg.decode())
    return text.replace("<svg ", f'<svg fill="{NEUTRAL[look.INK]}" ', 1).encode()


def name_of(name: str) -> str:
    """``cams.svg`` is ``cams_dark.svg`` on dark paper."""
    stem, suffix = name.rsplit(".", 1)
    return f"{stem}_dark.{suffix}"


@cache
def exchanged(colour: str) -> str:
    """A colour on dark paper."""
    if colour in data_colours():
        return colour
    return NEUTRAL.get(colour) or on_dark(colour)


@cache
def data_colours() -> frozenset[str]:
    """Colours of the maps of data."""
    return frozenset(to_hex(mpl.colormaps[name](k)) for name in MAPS for k in range(256))
