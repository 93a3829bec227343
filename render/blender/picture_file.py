"""Checks the file of a picture: whether it is whole, and whether it is the one that was rendered.

Blender reports no error when the disk is full or a file is too large, so what it saved is looked at.
"""

from __future__ import annotations

import hashlib
from pathlib import Path

END = b"\0\0\0\0IEND\xaeB`\x82"
"""The last chunk of every PNG; decoders do without it."""


def fault(path: Path, width: int, height: int) -> str | None:
    """What is wrong with a PNG that should be of this size, in words after its name; None if nothing is.

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
    """The file name of a picture: what it shows, and a hash of its bytes together with that."""
    return f"{key}-{hashlib.sha256(key.encode() + content).hexdigest()[:32]}.png"


def is_as_named(path: Path, content: bytes) -> bool:
    """Whether these are the bytes that the file's name was made of."""
    return path.name == name_of(path.stem.partition("-")[0], content)
