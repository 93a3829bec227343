"""Passes of a render, as arrays: the light of a picture and the guides of its denoiser, read from an OpenEXR file.

Blender gives its passes to files alone. These are read here as it writes them: several parts in one file, scan lines,
not compressed (https://openexr.com/en/latest/OpenEXRFileLayout.html).
"""

from __future__ import annotations

import struct
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

Array = np.ndarray
KINDS = {0: np.dtype("<u4"), 1: np.dtype("<f2"), 2: np.dtype("<f4")}
MULTIPART = 0x1000
"""Flag of a file of several parts."""


@dataclass(frozen=True)
class Small:
    """A small picture with what its pixels see first: arrays (h, w, 3), and (h, w) of the depth."""

    light: Array
    noisy: Array
    """The light before it was denoised."""
    depth: Array
    albedo: Array
    normal: Array
    mirrored: Array
    """Part of the light that is mirrored rather than scattered."""


def read_light(content: bytes) -> Array:
    """Return the light (h, w, 3) of a file of Blender's passes, float32, linear, the upper row first."""
    return _rgb(read_passes(content), "Combined", "RGB")


def read_small(content: bytes) -> Small:
    """Return a picture with the guides that ``denoising_store_passes`` adds, with or without a denoiser."""
    passes = read_passes(content)
    noisy = "Noisy Image" if "Noisy Image.R" in passes else "Combined"
    return Small(
        light=_rgb(passes, "Combined", "RGB"),
        noisy=_rgb(passes, noisy, "RGB"),
        depth=passes["Denoising Depth.Z"].astype(np.float32),
        albedo=_rgb(passes, "Denoising Albedo", "RGB"),
        normal=_rgb(passes, "Denoising Normal", "XYZ"),
        mirrored=_rgb(passes, "Denoising Specular Albedo", "RGB"),
    )


def _rgb(passes: Mapping[str, Array], name: str, channels: str) -> Array:
    return np.stack([passes[f"{name}.{channel}"] for channel in channels], axis=-1).astype(np.float32)


def read_passes(content: bytes) -> dict[str, Array]:
    """Return arrays (h, w) by pass and channel, ``Combined.R``, of an uncompressed OpenEXR file.

    Raises ValueError for a file that is cut short or compressed.
    """
    try:
        return _read(content)
    except (struct.error, IndexError, KeyError) as error:
        raise ValueError(f"the OpenEXR file is not whole ({error})") from error


def _read(content: bytes) -> dict[str, Array]:
    several = bool(struct.unpack_from("<I", content, 4)[0] & MULTIPART)
    parts, at = _headers(content, several)
    rows = sum(height for _, _, height, _ in parts)
    at += 8 * rows  # the table of places
    arrays = [
        {name: np.empty((height, width), kind) for name, kind in channels} for channels, width, height, _ in parts
    ]
    for _ in range(rows):
        part = 0
        if several:
            (part,) = struct.unpack_from("<i", content, at)
            at += 4
        y, size = struct.unpack_from("<ii", content, at)
        at += 8
        channels, width, _, top = parts[part]
        place = at
        for name, kind in channels:
            arrays[part][name][y - top] = np.frombuffer(content, kind, width, place)
            place += width * kind.itemsize
        if place != at + size:
            raise ValueError("the OpenEXR file is compressed")
        at += size
    return {name.partition(".")[2]: array for part in arrays for name, array in part.items()}


Part = tuple[list[tuple[str, np.dtype]], int, int, int]
"""Channels, width, height and first row of a part."""


def _headers(content: bytes, several: bool) -> tuple[list[Part], int]:
    """Return the parts, and the place after their headers."""
    parts: list[Part] = []
    at = 8
    while True:
        fields: dict[str, bytes] = {}
        while content[at]:
            name, at = _text(content, at)
            _, at = _text(content, at)
            (size,) = struct.unpack_from("<i", content, at)
            fields[name] = content[at + 4 : at + 4 + size]
            at += 4 + size
        at += 1
        left, top, right, bottom = struct.unpack("<4i", fields["dataWindow"])
        if fields["compression"][0]:
            raise ValueError("the OpenEXR file is compressed")
        parts.append((_channels(fields["channels"]), right - left + 1, bottom - top + 1, top))
        if not several:
            return parts, at
        if not content[at]:
            return parts, at + 1


def _channels(listing: bytes) -> list[tuple[str, np.dtype]]:
    channels, at = [], 0
    while listing[at]:
        name, at = _text(listing, at)
        channels.append((name, KINDS[struct.unpack_from("<i", listing, at)[0]]))
        at += 16
    return channels


def _text(content: bytes, at: int) -> tuple[str, int]:
    end = content.find(b"\0", at)
    if end < 0:
        raise ValueError("the OpenEXR file is cut short")
    return content[at:end].decode(), end + 1
