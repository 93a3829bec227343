"""A glTF 2.0 document in one binary file: arrays become views of one buffer, everything else is JSON.

    file     magic "glTF", version 2, length;  chunk JSON padded with spaces;  chunk BIN padded with zeros
    array    accessor (type, component type, count, least and largest) on a view (offset, length) of the buffer

Source: Khronos, glTF 2.0 Specification, sections 3.6 (buffers), 3.11 (animations), 4 (GLB).
"""

from __future__ import annotations

import json
import struct
from typing import Any

import numpy as np

TYPES = {(): "SCALAR", (2,): "VEC2", (3,): "VEC3", (4,): "VEC4"}
COMPONENTS = {"float32": 5126, "uint32": 5125, "uint16": 5123}
VERTICES, INDICES = 34962, 34963
"""What a view is for; others have none."""


class Document:
    """Collects the parts of a file; ``json`` holds those that refer to each other by their place in lists."""

    def __init__(self) -> None:
        self.json: dict[str, Any] = {
            "asset": {"version": "2.0", "generator": "mbsd"},
            "accessors": [],
            "bufferViews": [],
        }
        self._buffer = bytearray()

    def add(self, kind: str, thing: dict[str, Any]) -> int:
        """Append to a list such as ``nodes`` or ``meshes``; returns its place there."""
        self.json.setdefault(kind, []).append(thing)
        return len(self.json[kind]) - 1

    def array(self, values: np.ndarray, target: int | None = None, bounds: bool = False) -> int:
        """The accessor of an array (n,) or (n, 2 .. 4) of float32, uint32 or uint16; ``bounds`` tells its range."""
        self._buffer.extend(b"\0" * (-len(self._buffer) % 4))
        view: dict[str, Any] = {"buffer": 0, "byteOffset": len(self._buffer), "byteLength": values.nbytes}
        if target is not None:
            view["target"] = target
        self._buffer.extend(np.ascontiguousarray(values).astype(values.dtype.newbyteorder("<")).tobytes())
        accessor: dict[str, Any] = {
            "bufferView": self.add("bufferViews", view),
            "componentType": COMPONENTS[values.dtype.name],
            "count": len(values),
            "type": TYPES[values.shape[1:]],
        }
        if bounds:
            flat = values.reshape(len(values), -1)
            accessor["min"], accessor["max"] = (edge(axis=0).tolist() for edge in (flat.min, flat.max))
        return self.add("accessors", accessor)

    def values(self, number: int) -> np.ndarray:
        """The array of an accessor."""
        accessor = self.json["accessors"][number]
        kind = next(name for name, code in COMPONENTS.items() if code == accessor["componentType"])
        shape = next(tail for tail, name in TYPES.items() if name == accessor["type"])
        start = self.json["bufferViews"][accessor["bufferView"]]["byteOffset"]
        count = accessor["count"] * int(np.prod(shape, dtype=int))
        flat = np.frombuffer(self._buffer, np.dtype(kind).newbyteorder("<"), count, start)
        return flat.reshape(accessor["count"], *shape).astype(kind)

    def content(self) -> bytes:
        """The file's bytes."""
        binary = bytes(self._buffer) + b"\0" * (-len(self._buffer) % 4)
        self.json["buffers"] = [{"byteLength": len(binary)}]
        text = json.dumps(self.json, separators=(",", ":"), allow_nan=False).encode()
        text += b" " * (-len(text) % 4)
        length = 12 + 8 + len(text) + 8 + len(binary)
        head = struct.pack("<4sII", b"glTF", 2, length)
        return (
            head + struct.pack("<I4s", len(text), b"JSON") + text + struct.pack("<I4s", len(binary), b"BIN\0") + binary
        )
