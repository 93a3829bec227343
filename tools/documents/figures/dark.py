"""Pictures of docs/ on dark paper: the colours of an SVG or GIF exchanged, for pages that ask for it."""

from __future__ import annotations

import re
from cmath import phase, rect
from functools import cache
from math import degrees, radians

import matplotlib as mpl
from matplotlib.colors import to_hex

from mbsd.drawing import look
from mbsd.drawing.look import hex_of, lch_of, on_dark

# The pictures of docs/ on dark paper: the same SVG with its colours exchanged, for pages that a dark system shows.


COLOUR = re.compile(r"#[0-9a-f]{6}\b")
PAPER = "#0d1117"
"""Colour of GitHub's dark pages."""
NEUTRAL = {look.PAPER: PAPER, look.INK: "#e6edf3", look.QUIET: "#9198a1", look.FAINT: "#262c36", look.LOAD: "#a9b6c6"}
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


# A GIF of docs/ on dark paper: its tables of colours exchanged, every pixel as it is.
#
# Edges are drawn soft, so a table has all that lies between an ink and white. As white becomes the dark paper and inks
# become what :func:`mbsd.drawing.look.on_dark` says, what lies between them stays in between: its lightness L becomes a
# broken line through (1, paper), (:data:`INK`, 1.16 - 0.8 INK) and (0, 1.16).
#
# Source: W3C, Graphics Interchange Format, version 89a.


INK = 0.68
"""Lightness (OKLab) of the palest ink."""
EXTENSION, IMAGE, END = 0x21, 0x2C, 0x3B
HAS_TABLE, SIZE = 0x80, 0x07
"""Bits that say whether a table follows, and how long it is."""


def dark_gif(gif: bytes) -> bytes:
    """The same pictures on dark paper. Raises ValueError for what is no GIF."""
    if gif[:4] != b"GIF8":
        raise ValueError("this is no GIF")
    out = bytearray(gif)
    at = _table(out, 13, out[10])
    while out[at] != END:
        if out[at] == EXTENSION:
            at = _blocks(out, at + 2)
        elif out[at] == IMAGE:
            at = _blocks(out, _table(out, at + 10, out[at + 9]) + 1)
        else:
            raise ValueError(f"byte {at} of the GIF begins no block")
    return bytes(out)


def _table(out: bytearray, at: int, packed: int) -> int:
    """Exchange the table of colours at this place, if there is one; where what follows it begins."""
    if not packed & HAS_TABLE:
        return at
    end = at + 3 * (2 << (packed & SIZE))
    for k in range(at, end, 3):
        out[k : k + 3] = exchanged_rgb(bytes(out[k : k + 3]))
    return end


def _blocks(out: bytearray, at: int) -> int:
    """Where a chain of blocks ends that begins here."""
    while out[at]:
        at += 1 + out[at]
    return at + 1


@cache
def exchanged_rgb(colour: bytes) -> bytes:
    """Red, green and blue on dark paper."""
    light, chroma, hue = lch_of(f"#{colour.hex()}")
    made, tint = 1.16 - 0.8 * light, rect(0.9 * chroma, radians(hue))
    if light > INK:
        part = (light - INK) / (1.0 - INK)
        dark, its_chroma, its_hue = lch_of(PAPER)
        made, tint = (1 - part) * (1.16 - 0.8 * INK) + part * dark, tint + rect(part * its_chroma, radians(its_hue))
    return bytes.fromhex(hex_of(min(made, 0.96), abs(tint), degrees(phase(tint)))[1:])
