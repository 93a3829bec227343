"""The payload as bytes: JSON with arrays beside it, compressed. page/src/data/decode.js reads it.

bytes      zlib of what follows, or what follows as it is
file       "MBSV", version (uint32), length of the header (uint32), header, zeros up to a multiple of 8, blocks
header     JSON in UTF-8; an array is {"$": [type, offset, count]}: where it begins behind the header (bytes)
block      the numbers' first bytes, then their second bytes and so on, which compresses better; multiples of 8
type       f4 f8 i1 u1 i2 u2 u4, little endian
"""

from __future__ import annotations

import json
import struct
import zlib
from typing import Any

import numpy as np

MAGIC, VERSION = b"MBSV", 1
TYPES = {"float32": "f4", "float64": "f8", "int8": "i1", "uint8": "u1", "int16": "i2", "uint16": "u2", "uint32": "u4"}


def encode(payload: dict[str, Any], compress: bool = True) -> bytes:
    """The bytes of dicts, lists, strings, numbers and arrays (flattened); the same each time."""
    blocks = bytearray()

    def plain(value: Any) -> Any:
        if isinstance(value, np.ndarray):
            place = len(blocks)
            blocks.extend(_planes(value))
            blocks.extend(b"\0" * (-len(blocks) % 8))
            return {"$": [TYPES[value.dtype.name], place, value.size]}
        if isinstance(value, dict):
            return {str(key): plain(part) for key, part in value.items()}
        if isinstance(value, list | tuple):
            return [plain(part) for part in value]
        return value

    header = json.dumps(plain(payload), separators=(",", ":"), ensure_ascii=False, allow_nan=False).encode()
    head = MAGIC + struct.pack("<II", VERSION, len(header)) + header
    content = head + b"\0" * (-len(head) % 8) + bytes(blocks)
    return zlib.compress(content, 9) if compress else content


def _planes(values: np.ndarray) -> bytes:
    flat = np.ascontiguousarray(values, values.dtype.newbyteorder("<")).reshape(-1)
    return flat.view(np.uint8).reshape(-1, values.itemsize).T.tobytes()
