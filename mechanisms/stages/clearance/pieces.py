"""A piece as the check uses it: its mesh, its range of heights, and a circle in the plane that holds it."""

from __future__ import annotations

import hashlib
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np

from mechanisms.stages.clearance.distinct import distinct
from mechanisms.stages.clearance.tree import FacetTree
from mechanisms.stages.parts_files import read_triangles
from shared.contract import Parts
from shared.stage.errors import UserError
from shared.stage.face import to_run

LEVEL = 1e-6
"""A facet whose corners differ less in height is horizontal (mm)."""
UPRIGHT = 1e-4
"""A wall that leans by less (rad) faces neither up nor down: rounded corners of an STL lean it so much."""


@dataclass(frozen=True)
class MeshPiece:
    """One piece of a body, in the body's frame (mm)."""

    body: str
    name: str
    triangles: np.ndarray
    """(n, 3, 3): corners of each facet."""

    @cached_property
    def z_range(self) -> tuple[float, float]:
        """Lowest and highest z (mm)."""
        heights = self.triangles[:, :, 2]
        return float(heights.min()), float(heights.max())

    @cached_property
    def centre(self) -> np.ndarray:
        """(2,): the middle of the piece's extent in the plane."""
        flat = self.triangles[:, :, :2].reshape(-1, 2)
        return (flat.min(axis=0) + flat.max(axis=0)) / 2

    @cached_property
    def radius(self) -> float:
        """Radius of the circle round ``centre`` that holds the piece."""
        return float(np.linalg.norm(self.triangles[:, :, :2].reshape(-1, 2) - self.centre, axis=1).max())

    def is_around(self, place: np.ndarray) -> bool:
        """Whether the circle round it holds a place (2,) of its body's frame."""
        return float(np.hypot(*(place - self.centre))) <= self.radius

    @cached_property
    def reach(self) -> float:
        """How far the piece reaches from the origin of its body's frame in the plane."""
        return float(np.linalg.norm(self.centre)) + self.radius

    @cached_property
    def level(self) -> np.ndarray:
        """(n,): which facets are horizontal."""
        return np.ptp(self.triangles[:, :, 2], axis=1) <= LEVEL

    @cached_property
    def sides(self) -> FacetTree:
        """The facets that are not horizontal, by place, relative to ``centre``."""
        return FacetTree(self.triangles[~self.level], self.centre, self.radius)

    @cached_property
    def tree(self) -> FacetTree:
        """All facets by place, relative to ``centre``."""
        return FacetTree(self.triangles, self.centre, self.radius)

    @cached_property
    def upward(self) -> np.ndarray:
        """(n,): the z component of each facet's normal, times twice its area (mm^2); corners run counter-clockwise."""
        p, q = (self.triangles[:, k, :2] - self.triangles[:, 0, :2] for k in (1, 2))
        return p[:, 0] * q[:, 1] - p[:, 1] * q[:, 0]

    @cached_property
    def size(self) -> np.ndarray:
        """(n,): twice the area of each facet (mm^2)."""
        p, q = (self.triangles[:, k] - self.triangles[:, 0] for k in (1, 2))
        return np.linalg.norm(np.cross(p, q), axis=1)

    @cached_property
    def outlines(self) -> dict[tuple[float, float], Any]:
        """The ``search.outline.Outline`` or None of those heights (mm) that were asked for."""
        return {}

    @cached_property
    def manifold(self) -> Any:
        """The ``manifold3d.Manifold`` of the mesh."""
        import manifold3d

        corners = self.triangles.reshape(-1, 3)
        first, index = distinct(corners)
        solid = manifold3d.Manifold(manifold3d.Mesh64(corners[first], index.reshape(-1, 3).astype(np.uint64)))
        if solid.status() != manifold3d.Error.NoError:
            raise UserError(f"{self.body}: {self.name}: its STL is not a closed surface ({solid.status()})")
        return solid


def facing(lying: MeshPiece, other: MeshPiece, sign: float) -> tuple[np.ndarray, np.ndarray]:
    """The horizontal facets of ``lying`` that look up (``sign`` 1) or down (-1), and the facets of ``other`` that look
    the other way, upright ones left out: (n, 3, 3) each.
    """
    faces = lying.triangles[lying.level & (sign * lying.upward > 0)]
    return faces, other.triangles[sign * other.upward < -UPRIGHT * other.size]


def height_between(first: MeshPiece, second: MeshPiece) -> float:
    """The least height (mm) between a horizontal face of one piece and what faces it in the other, wherever they are.

    Infinite if nothing does. From a horizontal facet the way to the nearest point of another solid is vertical, unless
    a facet beside it is on that way too; the other end is a corner of a facet that faces it.
    """
    least = np.inf
    for a, b in ((first, second), (second, first)):
        for sign in (1.0, -1.0):
            lying, facets = facing(a, b, sign)
            faces, above = np.unique(sign * lying[:, 0, 2]), np.unique(sign * facets[:, :, 2])
            at = np.searchsorted(above, faces - LEVEL)
            inside = at < len(above)
            least = min(least, float((above[at[inside]] - faces[inside]).min(initial=np.inf)))
    return max(least, 0.0)


def read_pieces(parts: Parts, folder: Path) -> list[MeshPiece]:
    """Load the STL files of parts.json. Raises UserError if one is not the file that parts.json was written with."""
    pieces = []
    for body, described in parts.bodies.items():
        for name, piece in described.pieces.items():
            content = (folder / piece.stl).read_bytes()
            if hashlib.sha256(content).hexdigest() != piece.stl_sha256:
                raise UserError(
                    f"{folder / piece.stl} is not the file that parts.json describes; "
                    f"run {to_run('parts', parts.mechanism)}"
                )
            pieces.append(MeshPiece(body, name, read_triangles(content)))
    return pieces
