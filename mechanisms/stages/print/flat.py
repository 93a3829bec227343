"""Finds pieces that can be cut from a sheet: their outline is the same from the bed up to the sheet's thickness.

Eased edges, pockets, counterbores and engraving do not change the outline and are left out of it, and so is what stands
above the sheet, such as a boss; both are reported.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from mechanisms.stages.print.laying import FLAT, Laid
from shared.stage.errors import UserError

SAME = 0.9
"""The least area of an outline, of the largest, at every height of the sheet; an edge is eased by some of it."""
FULL = 0.7
"""How much of the cut sheet the piece must be."""
THICK = 0.6
"""A piece thicker than this part of its width is none of a sheet."""
ABOVE = 0.25
"""How much of the piece may stand above the sheet."""
SAMPLES = 24
LARGE = 0.02
"""The least area of a face that may be the sheet's upper one, of the outline's."""


@dataclass(frozen=True)
class Sheet:
    """A piece as something cut from a sheet (mm)."""

    thickness: float
    above: float
    """Height of what stands above the sheet and is not in the outline."""
    full: float
    """Volume of the piece within the sheet, as a part of the cut sheet's."""


def sheet_of(piece: Laid) -> Sheet | None:
    """The sheet that a laid piece can be cut from; None if its outline changes on the way up."""
    body = _manifold(piece)
    x, y, height = piece.size
    levels = _upper_faces(piece)
    heights = (np.arange(SAMPLES) + 0.5) / SAMPLES * height
    outlines = np.array([_filled(body.slice(float(z))) for z in heights])
    same = outlines >= SAME * outlines.max()
    if not same[0]:
        return None
    for level in levels:
        below = heights < level
        if not below.any() or not same[below].all():
            continue
        area = body.slice(level / 2).area()
        within = body.trim_by_plane((0.0, 0.0, -1.0), -level).volume()
        full = within / (area * level)
        if body.volume() - within > ABOVE * body.volume():
            return None
        if _filled(body.project()) > outlines.max() * 1.01 or not FULL < full < 1.03 or level > THICK * min(x, y):
            return None
        above = height - level
        return Sheet(level, above if above > FLAT else 0.0, min(full, 1.0))
    return None


def _upper_faces(piece: Laid) -> list[float]:
    """Heights of large faces that look up, from the highest down."""
    corners = piece.triangles
    across = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    up = across[:, 2] > 0.9999 * np.linalg.norm(across, axis=1)
    levels, areas = corners[up][:, :, 2].mean(axis=1), across[up, 2] / 2
    order = np.argsort(levels, kind="stable")
    levels, areas = levels[order], areas[order]
    faces = np.split(np.arange(len(levels)), np.flatnonzero(np.diff(levels) > FLAT) + 1)
    x, y, _ = piece.size
    large = [face for face in faces if areas[face].sum() > LARGE * x * y / 2]
    return [round(float(np.average(levels[face], weights=areas[face])), 3) for face in reversed(large)]


def _filled(section: Any) -> float:
    """Area of a section with its holes filled (mm^2)."""
    return sum(max(_signed(contour), 0.0) for contour in section.to_polygons())


def _signed(contour: Any) -> float:
    x, y = np.asarray(contour, dtype=float).T
    return float(np.sum(x * np.roll(y, -1) - np.roll(x, -1) * y)) / 2


def _manifold(piece: Laid) -> Any:
    import manifold3d

    mesh = manifold3d.Mesh(piece.vertices.astype(np.float32), piece.faces.astype(np.uint32))
    solid = manifold3d.Manifold(mesh)
    if solid.status() != manifold3d.Error.NoError:
        raise UserError(f"a mesh is not a closed surface ({solid.status()}); make the parts again")
    return solid
