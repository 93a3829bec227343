"""Damages of a file's bytes; each function returns the new ones, None to remove the file."""

from __future__ import annotations

import random


def cut(content: bytes, chance: random.Random) -> bytes:
    """Cut it anywhere; often just before its end."""
    return content[: chance.choice([0, len(content) - 1, len(content) - 12, chance.randrange(len(content) + 1)])]


def flipped(content: bytes, chance: random.Random) -> bytes:
    """Flip some bits of one byte."""
    place = chance.randrange(max(len(content), 1))
    return (
        content[:place]
        + bytes(byte ^ chance.randrange(1, 256) for byte in content[place : place + 1])
        + content[place + 1 :]
    )


def no_text(content: bytes, chance: random.Random) -> bytes:
    """Put a byte above 0x7f somewhere."""
    place = chance.randrange(max(len(content), 1))
    return content[:place] + bytes([chance.randrange(0x80, 0x100)]) + content[place + 1 :]


def gone(content: bytes, chance: random.Random) -> None:
    """Remove it."""
