"""The pieces as the check sees them: mesh, height range, circle in the plane."""

from __future__ import annotations

import hashlib
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np

from mechanisms.parts_files import read_triangles
from shared.contract import Parts
from shared.errors import UserError


@dataclass(frozen=True)
class MeshPiece:
    """One piece of a body, in the body's frame (mm)."""

    body: str
    name: str
    triangles: np.ndarray
    """(n, 3, 3): corners of each facet."""

    @cached_property
    def z_range(self) -> tuple[float, float]:
        heights = self.triangles[:, :, 2]
        return float(heights.min()), float(heights.max())

    @cached_property
    def centre(self) -> np.ndarray:
        """(2,): the middle of the piece's extent in the plane."""
        flat = self.triangles[:, :, :2].reshape(-1, 2)
        return (flat.min(axis=0) + flat.max(axis=0)) / 2

    @cached_property
    def radius(self) -> float:
        """Of the circle round ``centre`` that holds the piece."""
        return float(np.linalg.norm(self.triangles[:, :, :2].reshape(-1, 2) - self.centre, axis=1).max())

    @cached_property
    def manifold(self) -> Any:
        """The ``manifold3d.Manifold`` of the mesh."""
        import manifold3d

        corners, index = np.unique(self.triangles.reshape(-1, 3), axis=0, return_inverse=True)
        solid = manifold3d.Manifold(manifold3d.Mesh(corners.astype(np.float32), index.reshape(-1, 3).astype(np.uint32)))
        if solid.status() != manifold3d.Error.NoError:
            raise UserError(f"{self.body}: {self.name}: its STL is not a closed surface ({solid.status()})")
        return solid


def read_pieces(parts: Parts, folder: Path) -> list[MeshPiece]:
    """Load the STL files of parts.json. Raises UserError if one is not the file that parts.json was written with."""
    pieces = []
    for body, described in parts.bodies.items():
        for name, piece in described.pieces.items():
            content = (folder / piece.stl).read_bytes()
            if hashlib.sha256(content).hexdigest() != piece.stl_sha256:
                raise UserError(
                    f"{folder / piece.stl} is not the file that parts.json describes; "
                    f"run make parts-{parts.mechanism.replace('_', '-')}"
                )
            pieces.append(MeshPiece(body, name, read_triangles(content)))
    return pieces
