"""Pictures as files: plain PNG, and checks of those that arrive from elsewhere."""

from __future__ import annotations

import hashlib
import io
import zlib
from collections.abc import Iterator
from pathlib import Path

# A PNG without what Blender writes beside the picture: the date, the seconds that it took, names of its own.

SIGNATURE = b"\x89PNG\r\n\x1a\n"
COLOUR = (b"sRGB", b"gAMA", b"cHRM", b"iCCP")
"""Chunks beside the critical ones that say what is seen."""


def make_plain(path: Path) -> None:
    """Write the file anew with its picture alone, so that equal pictures are equal files.

    A cut file is left alone.
    """
    content = path.read_bytes()
    plain = without_notes(content)
    if plain != content:
        path.write_bytes(plain)


def without_notes(content: bytes) -> bytes:
    """Return the chunks that decide what is seen; the same content if it is no whole PNG."""
    kept, place = [SIGNATURE], len(SIGNATURE)
    if not content.startswith(SIGNATURE):
        return content
    while place < len(content):
        end = place + 12 + int.from_bytes(content[place : place + 4])
        kind = content[place + 4 : place + 8]
        if len(kind) < 4 or end > len(content):
            return content
        if kind[:1].isupper() or kind in COLOUR:  # of a critical chunk the first letter is a capital
            kept.append(content[place:end])
        place = end
    return b"".join(kept)


# Checks the file of a picture: whether it is whole, and whether it is the one that was rendered.
#
# Blender reports no error when the disk is full or a file is too large, so what it saved is looked at.

END = b"\0\0\0\0IEND\xaeB`\x82"
"""The last chunk of every PNG; decoders do without it."""


def fault(path: Path, width: int, height: int) -> str | None:
    """Return the fault of a PNG that should be of this size, in words after its name; None if it has none.

    Looks at the size of the file, its last chunk, the checksums of all chunks, and decodes it to its last row.
    """
    from PIL import Image

    try:
        with path.open("rb") as file:
            size = file.seek(0, 2)
            if not size:
                return "is empty"
            file.seek(max(size - len(END), 0))
            if file.read() != END:
                return f"is cut short after {size} bytes"
        with Image.open(path) as picture:
            picture.verify()
        with Image.open(path) as picture:  # a picture cannot be read after verify()
            picture.load()
            if picture.size != (width, height):
                return f"is {picture.width}x{picture.height}, not {width}x{height}"
    except FileNotFoundError:
        return "is not there"
    except (OSError, SyntaxError, ValueError) as error:
        return f"does not decode ({error})"
    return None


def name_of(key: str, content: bytes) -> str:
    """Return the file name of a picture: what it shows, and a hash of its bytes together with that."""
    return f"{key}-{hashlib.sha256(key.encode() + content).hexdigest()[:32]}.png"


def is_as_named(path: Path, content: bytes) -> bool:
    """Return True if these are the bytes that the file's name was made of."""
    return path.name == name_of(path.stem.partition("-")[0], content)


# Checks a picture that came from another machine, or whose maker is not known, more strictly than Blender's own.

CHUNKS = (b"IHDR", b"IDAT", b"IEND", *COLOUR)
"""Names of pictures that Blender's process has written."""
HEADER = 13
"""Bytes of IHDR: width, height, depth, kind of colour, compression, filter, interlacing."""
RGB = b"\x08\x02\x00\x00\x00"
"""Eight bits a colour, three colours, and the rest as it is everywhere."""


def fault_of(content: bytes, width: int, height: int) -> str | None:
    """Return the fault of bytes that should be a whole PNG of this size (pixels); None if there is none.

    Its header is looked at first, so that no picture of another size is decoded; last, that its rows are all there and
    nothing follows them.
    """
    return fault_of_chunks(content, width, height) or _fault_of_rows(content, width, height) or _decoded(content)


def fault_of_chunks(content: bytes, width: int, height: int) -> str | None:
    """Return the same without decoding the rows.

    It looks at size, header and the checksum of every chunk, and for anything beside the picture.

    """
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
    """Return the most bytes that a picture of this size has.

    They are three a pixel without any compression, and what is around them.

    """
    rows = (3 * width + 1) * height
    return rows + rows // 100 + 65_536


def _chunks(content: bytes) -> Iterator[tuple[bytes, bytes, bytes]]:
    """Yield the kind, data and all bytes of each chunk that is whole."""
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
