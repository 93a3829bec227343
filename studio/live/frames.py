"""Message as bytes: its header's length (uint32, little endian), the header as JSON, the payload.

Server and browser, and server and child, send the same frames, so a motion that a child has solved is passed on as it
is. page/connection.js reads them.
"""

from __future__ import annotations

import json
import struct
from typing import Any

LARGEST = 1 << 30
"""Bytes of a frame; more is no message of ours."""


def framed(header: dict[str, Any], payload: bytes = b"") -> bytes:
    """Return the bytes of a message. Numbers that are not finite become null."""
    try:
        text = json.dumps(header, ensure_ascii=False, allow_nan=False)
    except ValueError:
        text = json.dumps(_finite(header), ensure_ascii=False, allow_nan=False)
    head = text.encode("utf-8", "replace")
    return struct.pack("<I", len(head)) + head + payload


def unframed(frame: bytes) -> tuple[dict[str, Any], bytes]:
    """Return header and payload. Raises ValueError for an invalid frame."""
    if len(frame) < 4:
        raise ValueError("a frame has four bytes at least")
    (size,) = struct.unpack_from("<I", frame)
    header = json.loads(frame[4 : 4 + size])
    if len(frame) < 4 + size or not isinstance(header, dict):
        raise ValueError("the header of a frame is a JSON object")
    return header, frame[4 + size :]


def _finite(value: Any) -> Any:
    if isinstance(value, float):
        return value if value - value == 0 else None
    if isinstance(value, dict):
        return {str(key): _finite(part) for key, part in value.items()}
    if isinstance(value, list | tuple):
        return [_finite(part) for part in value]
    return value
