"""Solids that a section cuts open, for files of other programs: closed again, with the cut faces for themselves."""

from __future__ import annotations

import msgspec
import numpy as np
from numpy.typing import NDArray

from render.film.scene import PieceSpec, SurfaceSpec
from shared.stage.errors import UserError

Array = NDArray[np.float64]
LEVEL = 1e-9
"""Corners this near (m) to the plane are on it."""


def cut_open(triangles: Array, piece: PieceSpec) -> tuple[Array, Array]:
    """Triangles (n, 3, 3) (m) below the height of a piece's section: those of its surface, and those of the cut.

    Raises UserError where manifold3d is missing, or the piece is not closed.
    """
    try:
        import manifold3d
    except ImportError as error:
        raise UserError("a section in files of other programs needs manifold3d: install mbsd[cad]") from error
    assert piece.cut_above is not None
    corners, index = np.unique(triangles.reshape(-1, 3), axis=0, return_inverse=True)
    mesh = manifold3d.Mesh64(corners, index.reshape(-1, 3).astype(np.uint64))
    solid = manifold3d.Manifold(mesh)
    if solid.status() != manifold3d.Error.NoError:
        raise UserError(
            f"piece {piece.body}/{piece.name} is not closed, so no section can cut it; make the parts again"
        )
    rest = solid.trim_by_plane((0.0, 0.0, -1.0), -piece.cut_above).to_mesh64()
    kept = np.asarray(rest.vert_properties)[:, :3][np.asarray(rest.tri_verts)]
    is_cut = (np.abs(kept[..., 2] - piece.cut_above) < LEVEL).all(axis=1)
    return kept[~is_cut], kept[is_cut]


def cut_surface(surface: SurfaceSpec) -> SurfaceSpec:
    """The surface of a cut face: a light tone of the piece's, matt; other programs draw no hatches."""
    red, green, blue = (0.5 * part + 0.32 for part in surface.colour)
    return msgspec.structs.replace(surface, colour=(red, green, blue), finish="plastic", roughness=0.7)
