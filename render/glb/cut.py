"""Solids that a section cuts open, for files of other programs: closed again, with the cut faces for themselves."""

from __future__ import annotations

from typing import Any

import msgspec
import numpy as np
from numpy.typing import NDArray

from render.film.scene import PieceSpec, SurfaceSpec
from shared.stage.errors import UserError

Array = NDArray[np.float64]
LEVEL = 1e-9
"""Corners this near (m) to a plane are on it."""


def cut_open(triangles: Array, piece: PieceSpec) -> tuple[Array, Array]:
    """Triangles (n, 3, 3) (m) of what a piece's section leaves: those of its surface, and those of the cut.

    Raises UserError where manifold3d is missing, or the piece is not closed.
    """
    try:
        import manifold3d
    except ImportError as error:
        raise UserError("a section in files of other programs needs manifold3d: install mbsd[cad]") from error
    corners, index = np.unique(triangles.reshape(-1, 3), axis=0, return_inverse=True)
    mesh = manifold3d.Mesh64(corners, index.reshape(-1, 3).astype(np.uint64))
    solid = manifold3d.Manifold(mesh)
    if solid.status() != manifold3d.Error.NoError:
        raise UserError(
            f"piece {piece.body}/{piece.name} is not closed, so no section can cut it; make the parts again"
        )
    rest = _rest(solid, piece, corners).to_mesh64()
    kept = np.asarray(rest.vert_properties)[:, :3][np.asarray(rest.tri_verts)]
    is_cut = np.zeros(len(kept), bool)
    for *normal, place in piece.cut:
        is_cut |= (np.abs(kept @ np.array(normal) - place) < LEVEL).all(axis=1)
    return kept[~is_cut], kept[is_cut]


def _rest(solid: Any, piece: PieceSpec, corners: Array) -> Any:
    """The solid without what is beyond all planes; a single one is exact, several are a wedge that is taken away."""
    if len(piece.cut) == 1:
        x, y, z, place = piece.cut[0]
        return solid.trim_by_plane((-x, -y, -z), -place)
    import manifold3d

    size = 8 * float(np.abs(corners).max())
    wedge = manifold3d.Manifold.cube((size, size, size), True)
    for x, y, z, place in piece.cut:
        wedge = wedge.trim_by_plane((x, y, z), place)
    return solid - wedge


def cut_surface(surface: SurfaceSpec) -> SurfaceSpec:
    """The surface of a cut face: a light tone of the piece's, matt; other programs draw no hatches."""
    red, green, blue = (0.5 * part + 0.32 for part in surface.colour)
    return msgspec.structs.replace(surface, colour=(red, green, blue), finish="plastic", roughness=0.7)
