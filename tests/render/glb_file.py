"""A GLB taken apart by the rules of its specification, for the tests that look at it."""

from __future__ import annotations

import json
import math
import struct
from typing import Any

import numpy as np

FIELDS = {"SCALAR": 1, "VEC3": 3, "VEC4": 4}
KINDS = {5126: "<f4", 5125: "<u4", 5123: "<u2"}


class GlbFile:
    """Its nodes, arrays and animation."""

    def __init__(self, content: bytes) -> None:
        magic, version, length = struct.unpack_from("<4sII", content)
        assert (magic, version, length) == (b"glTF", 2, len(content))
        size, kind = struct.unpack_from("<I4s", content, 12)
        assert kind == b"JSON"
        assert size % 4 == 0
        self.json: dict[str, Any] = json.loads(content[20 : 20 + size])
        size_of_rest, kind = struct.unpack_from("<I4s", content, 20 + size)
        assert kind == b"BIN\0"
        self.binary = content[28 + size :]
        assert len(self.binary) == size_of_rest == self.json["buffers"][0]["byteLength"]
        self.nodes = {node["name"]: node for node in self.json["nodes"]}

    def array(self, number: int) -> np.ndarray:
        accessor = self.json["accessors"][number]
        view = self.json["bufferViews"][accessor["bufferView"]]
        assert view["byteOffset"] % 4 == 0
        fields = FIELDS[accessor["type"]]
        values = np.frombuffer(
            self.binary, KINDS[accessor["componentType"]], accessor["count"] * fields, view["byteOffset"]
        )
        assert values.nbytes == view["byteLength"]
        values = values.reshape(-1, fields)
        if "min" in accessor:
            assert accessor["min"] == values.min(axis=0).tolist()
            assert accessor["max"] == values.max(axis=0).tolist()
        return values

    @property
    def clock(self) -> np.ndarray:
        """(n,): times (s) of the animation's samples."""
        return self.array(self.json["animations"][0]["samplers"][0]["input"])[:, 0]

    def box_of(self, body: str) -> np.ndarray:
        """(8, 3): corners of the box round all meshes below the node of a body, in its frame."""
        meshes = [self.json["meshes"][self.json["nodes"][k]["mesh"]] for k in self.nodes[body]["children"]]
        used = [self.json["accessors"][mesh["primitives"][0]["attributes"]["POSITION"]] for mesh in meshes]
        low = np.min([accessor["min"] for accessor in used], axis=0)
        high = np.max([accessor["max"] for accessor in used], axis=0)
        return np.array([[(low, high)[i][0], (low, high)[j][1], (low, high)[k][2]] for i, j, k in np.ndindex(2, 2, 2)])

    def matrices(self, t: float) -> dict[str, np.ndarray]:
        """World matrix of every node at a time (s), as a viewer plays the animation."""
        local = {k: dict(node) for k, node in enumerate(self.json["nodes"])}
        [animation] = self.json["animations"]
        for channel in animation["channels"]:
            sampler = animation["samplers"][channel["sampler"]]
            assert sampler["interpolation"] == "LINEAR"
            times, values = self.array(sampler["input"])[:, 0], self.array(sampler["output"])
            if channel["target"]["path"] == "weights":
                values = values.reshape(len(times), -1)
            assert (np.diff(times) > 0).all()
            k = int(np.clip(np.searchsorted(times, t, side="right") - 1, 0, len(times) - 2))
            part = min(max((t - times[k]) / (times[k + 1] - times[k]), 0.0), 1.0)
            target = channel["target"]
            assert np.isfinite(values).all()
            local[target["node"]][target["path"]] = _between(values[k], values[k + 1], part, target["path"])
        self.weights = {node["name"]: node.get("weights", []) for node in local.values()}
        out: dict[str, np.ndarray] = {}

        def walk(k: int, above: np.ndarray) -> None:
            here = above @ _matrix(local[k])
            out[local[k]["name"]] = here
            for child in local[k].get("children", []):
                walk(child, here)

        for root in self.json["scenes"][self.json["scene"]]["nodes"]:
            walk(root, np.eye(4))
        return out


def _between(a: np.ndarray, b: np.ndarray, part: float, path: str) -> np.ndarray:
    a, b = a.astype(float), b.astype(float)
    if path != "rotation":
        return a + part * (b - a)
    dot = float(a @ b)
    angle = math.acos(min(abs(dot), 1.0))
    if angle < 1e-3:  # straight, as viewers do; the angle of nearly equal ones is rounding
        blend = a + part * (math.copysign(1, dot) * b - a)
        return blend / np.linalg.norm(blend)
    return (math.sin((1 - part) * angle) * a + math.copysign(1, dot) * math.sin(part * angle) * b) / math.sin(angle)


def _matrix(node: dict[str, Any]) -> np.ndarray:
    x, y, z, w = node.get("rotation", (0, 0, 0, 1))
    out = np.eye(4)
    out[:3, :3] = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
        [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
        [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
    ]
    out[:3, :3] *= node.get("scale", (1, 1, 1))
    out[:3, 3] = node.get("translation", (0, 0, 0))
    return out
