"""A PNG without what Blender writes beside the picture: the date, the seconds that it took, names of its own."""

from __future__ import annotations

from pathlib import Path

SIGNATURE = b"\x89PNG\r\n\x1a\n"
COLOUR = (b"sRGB", b"gAMA", b"cHRM", b"iCCP")
"""Chunks beside the critical ones that say what is seen."""


def make_plain(path: Path) -> None:
    """Write the file anew with its picture alone, so that equal pictures are equal files; a cut file is left alone."""
    content = path.read_bytes()
    plain = without_notes(content)
    if plain != content:
        path.write_bytes(plain)


def without_notes(content: bytes) -> bytes:
    """The chunks that decide what is seen, bytes as they are; the same content if it is no whole PNG."""
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
