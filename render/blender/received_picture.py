"""Checks a picture that came from another machine, or whose maker is not known, more strictly than Blender's own."""

from __future__ import annotations

import io
import zlib
from collections.abc import Iterator

from render.blender.worker.plain_png import COLOUR, SIGNATURE

CHUNKS = (b"IHDR", b"IDAT", b"IEND", *COLOUR)
"""Those of a picture that Blender's process has named."""
HEADER = 13
"""Bytes of IHDR: width, height, depth, kind of colour, compression, filter, interlacing."""
RGB = b"\x08\x02\x00\x00\x00"
"""Eight bits a colour, three colours, and the rest as it is everywhere."""


def fault_of(content: bytes, width: int, height: int) -> str | None:
    """What is wrong with bytes that should be a whole PNG of this size (pixels), in words after its name; or None.

    Its header is looked at first, so that no picture of another size is decoded; last, that its rows are all there and
    nothing follows them.
    """
    return fault_of_chunks(content, width, height) or _fault_of_rows(content, width, height) or _decoded(content)


def fault_of_chunks(content: bytes, width: int, height: int) -> str | None:
    """The same without decoding the rows: size, header, the checksum of every chunk, and nothing beside the picture."""
    if not content.startswith(SIGNATURE):
        return "is no PNG"
    if len(content) > most_bytes(width, height):
        return f"has {len(content) / 1e6:.1f} MB, more than {width}x{height} pixels can take"
    chunks = list(_chunks(content))
    kinds = [kind for kind, _, _ in chunks]
    if kinds[:1] != [b"IHDR"] or kinds[-1:] != [b"IEND"] or SIGNATURE + b"".join(c for *_, c in chunks) != content:
        return f"is cut short or goes on after its end ({len(content)} bytes)"
    if not set(kinds) <= set(CHUNKS) or kinds.count(b"IHDR") + kinds.count(b"IEND") != 2:
        return "has more in it than a picture"
    header = chunks[0][1]
    if len(header) != HEADER or header[8:] != RGB:
        return "is not of eight bits for each of three colours"
    header_numbers = int.from_bytes(header[:4]), int.from_bytes(header[4:8])
    if header_numbers != (width, height):
        return f"is {header_numbers[0]}x{header_numbers[1]}, not {width}x{height}"
    if any(zlib.crc32(chunk[4:-4]) != int.from_bytes(chunk[-4:]) for *_, chunk in chunks):
        return "has a chunk whose checksum is wrong"
    return None


def most_bytes(width: int, height: int) -> int:
    """Bytes that a picture of this size has at most: three a pixel without any compression, and what is around them."""
    rows = (3 * width + 1) * height
    return rows + rows // 100 + 65_536


def _chunks(content: bytes) -> Iterator[tuple[bytes, bytes, bytes]]:
    """Kind, data and all bytes of each chunk that is whole."""
    place = len(SIGNATURE)
    while place + 12 <= len(content):
        end = place + 12 + int.from_bytes(content[place : place + 4])
        if end > len(content):
            return
        yield content[place + 4 : place + 8], content[place + 8 : end - 4], content[place:end]
        place = end


def _fault_of_rows(content: bytes, width: int, height: int) -> str | None:
    wanted = (3 * width + 1) * height
    data = b"".join(data for kind, data, _ in _chunks(content) if kind == b"IDAT")
    inflating = zlib.decompressobj()
    try:
        rows = inflating.decompress(data, wanted + 1)
    except zlib.error as error:
        return f"does not decode ({error})"
    if len(rows) != wanted or not inflating.eof or inflating.unused_data:
        return f"has {len(rows)} bytes of rows, not {wanted}"
    return None


def _decoded(content: bytes) -> str | None:
    from PIL import Image

    try:
        with Image.open(io.BytesIO(content), formats=["PNG"]) as picture:
            picture.load()
    except Exception as error:  # whatever a decoder makes of bytes from elsewhere
        return f"does not decode ({type(error).__name__}: {error})"
    return None
