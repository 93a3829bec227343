"""A glTF document: buffers, meshes, materials and animations."""

from __future__ import annotations

import json
import struct
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from render.film.scene import SurfaceSpec
from shared.contract import AnyMotion

# A glTF 2.0 document in one binary file: arrays become views of one buffer, everything else is JSON.
#
#     file     magic "glTF", version 2, length;  chunk JSON padded with spaces;  chunk BIN padded with zeros
#     array    accessor (type, component type, count, least and largest) on a view (offset, length) of the buffer
#
# Source: Khronos, glTF 2.0 Specification, sections 3.6 (buffers), 3.11 (animations), 4 (GLB).

TYPES = {(): "SCALAR", (2,): "VEC2", (3,): "VEC3", (4,): "VEC4"}
COMPONENTS = {"float32": 5126, "uint32": 5125, "uint16": 5123}
VERTICES, INDICES = 34962, 34963
"""Target of a buffer view; others have none."""


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
        """Return the accessor of an array (n,) or (n, 2 .. 4) of float32, uint32 or uint16.

        ``bounds``: its range is written too.
        """
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
        """Return the array of an accessor."""
        accessor = self.json["accessors"][number]
        kind = next(name for name, code in COMPONENTS.items() if code == accessor["componentType"])
        shape = next(tail for tail, name in TYPES.items() if name == accessor["type"])
        start = self.json["bufferViews"][accessor["bufferView"]]["byteOffset"]
        count = accessor["count"] * int(np.prod(shape, dtype=int))
        flat = np.frombuffer(self._buffer, np.dtype(kind).newbyteorder("<"), count, start)
        return flat.reshape(accessor["count"], *shape).astype(kind)

    def content(self) -> bytes:
        """Return the file's bytes."""
        binary = bytes(self._buffer) + b"\0" * (-len(self._buffer) % 4)
        self.json["buffers"] = [{"byteLength": len(binary)}]
        text = json.dumps(self.json, separators=(",", ":"), allow_nan=False).encode()
        text += b" " * (-len(text) % 4)
        length = 12 + 8 + len(text) + 8 + len(binary)
        head = struct.pack("<4sII", b"glTF", 2, length)
        return (
            head + struct.pack("<I4s", len(text), b"JSON") + text + struct.pack("<I4s", len(binary), b"BIN\0") + binary
        )


# Surfaces as glTF's metallic-roughness materials: the finishes of the film, as far as a viewer knows them.

CLEARCOAT = "KHR_materials_clearcoat"
METALLIC = {"anodised": 1.0, "brushed": 1.0, "polished": 1.0, "satin": 0.35, "cast": 0.25}
TONE = {"anodised": 0.8, "brushed": 0.68}
"""Factor on the colour."""
CLEAR = 0.3
"""Opacity of a pane."""


class Paints:
    """The materials of a document, each once."""

    def __init__(self, document: Document) -> None:
        self._document = document
        self._known: dict[SurfaceSpec, int] = {}

    def number_of(self, surface: SurfaceSpec) -> int:
        """Return the number of a surface's material."""
        if surface not in self._known:
            made = material(surface, f"{surface.finish} {len(self._known)}")
            self._known[surface] = self._document.add("materials", made)
        return self._known[surface]


def material(surface: SurfaceSpec, name: str) -> dict[str, Any]:
    """Return the material of a surface; colours are linear in both."""
    tone = TONE.get(surface.finish, 1.0)
    out: dict[str, Any] = {
        "name": name,
        "pbrMetallicRoughness": {
            "baseColorFactor": [*(round(tone * part, 6) for part in surface.colour), 1.0],
            "metallicFactor": METALLIC.get(surface.finish, 0.0),
            "roughnessFactor": surface.roughness,
        },
    }
    if surface.finish == "glass":
        out["alphaMode"] = "BLEND"
        out["pbrMetallicRoughness"]["baseColorFactor"][3] = CLEAR
    if surface.finish == "anodised":
        out["extensions"] = {CLEARCOAT: {"clearcoatFactor": 0.18, "clearcoatRoughnessFactor": 0.16}}
    return out


# Triangles of an STL as vertices with normals: round walls are smooth, edges that turn by more than SHARP are not.

SHARP = np.radians(32.0)
"""Angle as in the film."""
FINE = 1e-3
"""Normals that differ by less are one."""
PAIRS = 4_000_000
"""Pairs of corners looked at together."""

Floats = NDArray[np.float32]


def smooth(triangles: NDArray[np.floating]) -> tuple[Floats, Floats, NDArray[np.unsignedinteger]]:
    """Return positions (n, 3), unit normals (n, 3) and corners (3 m,) of triangles (m, 3, 3).

    Flat triangles are left out. The normal at a corner is the mean of those of the triangles that meet there and turn
    by less than SHARP against its own, weighted by their angles at the corner.
    """
    triangles = np.asarray(triangles, float)
    normals = np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0])
    area = np.linalg.norm(normals, axis=1)
    seen = area > 1e-12 * area.max(initial=0.0)
    triangles, normals = triangles[seen], normals[seen] / area[seen, None]
    places, vertex = np.unique(triangles.reshape(-1, 3), axis=0, return_inverse=True)
    vertex = vertex.reshape(-1)
    weights = _angles(triangles).reshape(-1)
    at_corner = _means(vertex, np.repeat(normals, 3, axis=0), weights)
    keys = np.column_stack([vertex, np.round(at_corner / FINE).astype(np.int64)])
    _, first, corner = np.unique(keys, axis=0, return_index=True, return_inverse=True)
    corner = corner.reshape(-1).astype(np.uint16 if len(first) < 65535 else np.uint32)
    return places[vertex[first]].astype(np.float32), _unit(at_corner[first]).astype(np.float32), corner


def _angles(triangles: NDArray[np.floating]) -> NDArray[np.floating]:
    """Return (m, 3) of the triangles at their corners (rad)."""
    ahead = _unit(np.roll(triangles, -1, axis=1) - triangles)
    back = _unit(np.roll(triangles, 1, axis=1) - triangles)
    return np.arccos(np.clip((ahead * back).sum(axis=-1), -1.0, 1.0))


def _means(vertex: np.ndarray, normals: np.ndarray, weights: np.ndarray) -> np.ndarray:
    """Return (k, 3) for each corner, from all corners at the same vertex."""
    order = np.argsort(vertex, kind="stable")
    counts = np.bincount(vertex)
    starts = np.concatenate([[0], np.cumsum(counts)[:-1]])
    mates = counts[vertex[order]]  # of each corner, itself included
    out = np.zeros_like(normals)
    ends = np.cumsum(mates)
    first = 0
    while first < len(order):
        done = ends[first - 1] if first else 0
        last = max(first + 1, int(np.searchsorted(ends, done + PAIRS)))
        here = np.arange(first, min(last, len(order)))
        left = np.repeat(here, mates[here])
        offset = np.arange(len(left)) - np.repeat(np.cumsum(mates[here]) - mates[here], mates[here])
        other = starts[vertex[order[left]]] + offset
        a, b = order[left], order[other]
        near = (normals[a] * normals[b]).sum(axis=1) >= np.cos(SHARP)
        np.add.at(out, a[near], normals[b[near]] * weights[b[near], None])
        first = last
    return _unit(out)


def _unit(vectors: np.ndarray) -> np.ndarray:
    length = np.linalg.norm(vectors, axis=-1, keepdims=True)
    return vectors / np.where(length > 0, length, 1.0)


# One glTF animation: what nodes do at the times of data.json, straight lines between them.

Array = NDArray[np.float64]
FEWER = 1440
"""Times of things whose shapes change, at most."""


class Track(NamedTuple):
    """Animation of one node, as accurate as data.json."""

    node: int
    path: str
    """translation (m), angle about z (rad), scale, or weights of shapes."""
    values: Array
    """(T, ...) at the times ``kept`` or ``fewer``."""


class Animation:
    """Collector of everything that is animated.

    Of two times of data.json at an event it has one, because poses agree there.
    """

    def __init__(self, document: Document, motion: AnyMotion) -> None:
        self._document = document
        time = (np.array(motion.time) - motion.time[0]).astype(np.float32)
        self.kept = np.flatnonzero(np.concatenate([[True], np.diff(np.maximum.accumulate(time)) > 0]))
        """Numbers of the times that it has."""
        self.fewer = self.kept[np.unique(np.linspace(0, len(self.kept) - 1, FEWER).round().astype(int))]
        """A selection of these, for what changes its shape."""
        self._time = time
        self.tracks: list[Track] = []
        """The same for other formats."""
        self._clocks: dict[int, int] = {}
        self._samplers: list[dict[str, Any]] = []
        self._channels: list[dict[str, Any]] = []

    def rows(self, values: np.ndarray) -> NDArray[np.intp]:
        """Return numbers of the times of values."""
        return self.kept if len(values) == len(self.kept) else self.fewer

    def add(self, node: int, path: str, values: np.ndarray) -> None:
        """Add ``values`` at the times ``kept``, or ``fewer``: translation, scale or weights of a node."""
        self.tracks.append(Track(node, path, values))
        self._sample(node, path, values)

    def turn(self, node: int, angle: Array) -> np.ndarray:
        """Return the turn a node about z by angles (n,) (rad); returns the quaternions (n, 4)."""
        self.tracks.append(Track(node, "angle", angle))
        turn = about_z(angle)
        self._sample(node, "rotation", turn)
        return turn

    def _sample(self, node: int, path: str, values: np.ndarray) -> None:
        number = len(values)
        if number not in self._clocks:
            self._clocks[number] = self._document.array(self._time[self.rows(values)], bounds=True)
        flat = values.reshape(-1) if path == "weights" else values
        output = self._document.array(flat.astype(np.float32))
        self._samplers.append({"input": self._clocks[number], "output": output, "interpolation": "LINEAR"})
        self._channels.append({"sampler": len(self._samplers) - 1, "target": {"node": node, "path": path}})

    def place(self, node: int, place: Array, angle: Array) -> None:
        """Move a node to places (n, 3) (m), turned about z by angles (n,) (rad).

        Without the clip it is where it begins.
        """
        self.add(node, "translation", place)
        turn = self.turn(node, angle)
        thing = self._document.json["nodes"][node]
        thing["translation"] = place[0].astype(np.float32).tolist()
        thing["rotation"] = turn[0].astype(np.float32).tolist()

    def pose(self, node: int, place: Array, turned: Array) -> None:
        """Move a node to places (n, 3) (m), turned by quaternions (n, 4) (w, x, y, z), whose signs go on."""
        self.add(node, "translation", place)
        quaternions = np.roll(turned, -1, axis=1)
        self.tracks.append(Track(node, "rotation", quaternions))
        self._sample(node, "rotation", quaternions)
        thing = self._document.json["nodes"][node]
        thing["translation"] = place[0].astype(np.float32).tolist()
        thing["rotation"] = quaternions[0].astype(np.float32).tolist()

    def content(self) -> dict[str, Any]:
        """Return the animation as it stands in the document."""
        return {"name": "motion", "samplers": self._samplers, "channels": self._channels}


def about_z(angle: Array) -> Array:
    """Return quaternions (n, 4) of turns by angles (n,) about z (rad)."""
    half, zero = angle / 2, np.zeros(len(angle))
    return np.stack([zero, zero, np.sin(half), np.cos(half)], axis=1)
