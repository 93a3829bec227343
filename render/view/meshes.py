"""Triangles of the solids, small: pieces of one shape are one mesh, places are whole numbers of a step, differences
are kept instead of numbers. page/src/view3d/meshes.js reads them.

    positions    (3 n,) uint16: all x, then all y, then all z, each less the one before (modulo 2^16), in steps from low
    normals      (2 n,) int8: octahedral u of all, then v of all
    triangles    (3 m,) uint16 or uint32: first corner less that of the triangle before, then second and third corner
                 less the first, zigzag (0, -1, 1, -2 .. as 0, 1, 2, 3 ..)

Octahedral normals: Meyer et al., On Floating-Point Normal Vectors, Eurographics 2010.
"""

from __future__ import annotations

import hashlib
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

from render.film.solids import read_triangles
from render.glb.mesh import smooth

STEPS = 65535
Shape = tuple[np.ndarray, np.ndarray, np.ndarray]


class Meshes:
    """Those of a page: ``list`` of dicts, ``step`` (m)."""

    def __init__(self, largest: float) -> None:
        """``largest``: extent of the largest piece (m)."""
        self.step = largest / STEPS
        self.list: list[dict[str, Any]] = []
        self._known: dict[str, int] = {}

    def add(self, shape: Shape) -> tuple[int, list[float]]:
        """Number of the mesh of a shape (positions, normals, corners), and where its lowest corner is (m)."""
        positions, normals, corners = shape
        low = positions.min(axis=0)
        whole = np.round((positions - low) / self.step).astype(np.int64)
        triangles = _sorted(corners.astype(np.int64).reshape(-1, 3))
        content = {
            "positions": np.diff(whole, axis=0, prepend=0).T.astype(np.uint16),
            "normals": _octahedral(normals).T,
            "triangles": _differences(triangles, len(whole)),
        }
        key = hashlib.sha256(b"".join(array.tobytes() for array in content.values())).hexdigest()
        if key not in self._known:
            self._known[key] = len(self.list)
            self.list.append({"count": len(whole)} | content)
        return self._known[key], [float(value) for value in low]


def shapes(files: list[Path]) -> Iterator[Shape]:
    """Shapes of STL files, in their order; one that is another moved is worked out once."""
    known: dict[bytes, tuple[np.ndarray, Shape]] = {}
    for file in files:
        triangles = read_triangles(file)
        low = triangles.reshape(-1, 3).min(axis=0)
        key = hashlib.sha256(np.round((triangles - low) * 1e7).astype(np.int64).tobytes()).digest()
        if key not in known:
            known[key] = low, smooth(triangles)
        first, (positions, normals, corners) = known[key]
        yield (positions + (low - first)).astype(np.float32), normals, corners


def _sorted(triangles: np.ndarray) -> np.ndarray:
    """Each with its least corner first, in the order of these; the side they show stays."""
    least = triangles.argmin(axis=1)
    turned = np.take_along_axis(triangles, (least[:, None] + np.arange(3)) % 3, axis=1)
    return turned[np.lexsort(turned.T[::-1])]


def _differences(triangles: np.ndarray, count: int) -> np.ndarray:
    out = triangles.copy()
    out[:, 0] = np.diff(triangles[:, 0], prepend=0)
    out[:, 1:] -= triangles[:, :1]
    zigzag = np.where(out >= 0, 2 * out, -2 * out - 1)
    return zigzag.T.astype(np.uint16 if 2 * count < STEPS else np.uint32)


def _octahedral(normals: np.ndarray) -> np.ndarray:
    """(n, 2) int8 of unit vectors (n, 3)."""
    x, y, z = (normals / np.abs(normals).sum(axis=1, keepdims=True)).T
    below = z < 0
    u = np.where(below, (1 - np.abs(y)) * np.where(x >= 0, 1, -1), x)
    v = np.where(below, (1 - np.abs(x)) * np.where(y >= 0, 1, -1), y)
    return np.round(np.stack([u, v], axis=1) * 127).astype(np.int8)
