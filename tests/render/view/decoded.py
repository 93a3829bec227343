"""The payload's bytes read back in Python, as the page reads them."""

from __future__ import annotations

import json
import struct
import zlib
from typing import Any

import numpy as np


def decoded(content: bytes) -> dict[str, Any]:
    """Dicts and arrays of a payload's bytes, compressed or not."""
    plain = content if content[:4] == b"MBSV" else zlib.decompress(content)
    version, length = struct.unpack("<II", plain[4:12])
    assert version == 1
    blocks = plain[-(-(12 + length) // 8) * 8 :]

    def arrays(value: dict[str, Any]) -> Any:
        if set(value) != {"$"}:
            return value
        kind, offset, count = value["$"]
        size = int(kind[1:])
        planes = np.frombuffer(blocks, np.uint8, count * size, offset).reshape(size, count)
        return np.ascontiguousarray(planes.T).view(f"<{kind}").reshape(-1)

    return json.loads(plain[12 : 12 + length], object_hook=arrays)
