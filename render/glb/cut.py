"""Sections of a GLB: cut pieces with their hatches."""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import msgspec
import numpy as np
from numpy.typing import NDArray

from render.film.film import Film
from render.film.scene import PieceSpec, Plane, SurfaceSpec
from render.film.section import LIGHT, MATT, Hatch, dark_of, hatch_of, in_body, light_of
from render.film.solids import read_corners
from shared.stage.errors import UserError

# Flat faces split into stripes, and the faces around them at the same places, so that a solid stays closed.

Array = NDArray[np.float64]
NEAR = 1e-9
"""Corners this near to a line (m) are on it."""


def striped(triangles: Array, hatch: Hatch, light: float) -> tuple[Array, Array]:
    """Return triangles (n, 3, 3) (m) split along the edges of stripes: the light ones and the dark ones.

    ``light`` is the light part of each stripe. The hatch's period is in m.
    """
    way = np.array(hatch.way)
    for line in _lines(triangles, hatch, light):
        triangles = _split(triangles, triangles @ way - line)
    where = triangles.mean(axis=1) @ way / hatch.period % 1.0 < light
    return triangles[where], triangles[~where]


def along_rim(triangles: Array, plane: Plane, hatch: Hatch, light: float, level: float) -> Array:
    """Return triangles (n, 3, 3) (m) whose edges in a plane, within ``level``, are split at stripes."""
    way, normal = np.array(hatch.way), np.array(plane[:3])
    on_it = np.abs(triangles @ normal - plane[3]) < level
    at_rim = on_it.sum(axis=1) == 2
    rim, others = triangles[at_rim], triangles[~at_rim]
    away = np.argmin(on_it[at_rim], axis=1)  # the corner that is off the plane comes last
    rim = np.take_along_axis(rim, ((away[:, None] + np.arange(1, 4)) % 3)[..., None], axis=1)
    for line in _lines(rim[:, :2], hatch, light):
        sides = rim[:, :2] @ way - line
        cut = _crosses(sides[:, 0], sides[:, 1])
        a, b, apex = (rim[cut, k] for k in range(3))
        middle = _between(a, b, sides[cut, 0], sides[cut, 1])
        rim = np.concatenate([rim[~cut], np.stack([a, middle, apex], 1), np.stack([middle, b, apex], 1)])
    return np.concatenate([others, rim])


def _lines(points: Array, hatch: Hatch, light: float) -> list[float]:
    """Return where stripes of points (..., 3) begin and end along the hatch's way."""
    if not len(points):
        return []
    along = points @ np.array(hatch.way)
    first, last = (int(np.floor(edge / hatch.period)) for edge in (along.min(), along.max()))
    return [hatch.period * (k + part) for k in range(first, last + 2) for part in (0.0, light)]


def _split(triangles: Array, sides: Array) -> Array:
    """Return triangles (n, 3, 3) split where ``sides`` (n, 3) change their sign.

    ``sides`` are how far corners are beyond a line (m).
    """
    sign = np.where(sides > NEAR, 1, np.where(sides < -NEAR, -1, 0))
    both = (sign.max(axis=1) > 0) & (sign.min(axis=1) < 0)
    touched = both & (sign == 0).any(axis=1)
    parts = [triangles[~both]]
    if touched.any():
        (on_it, a, b), (_, u, v) = _turned(triangles, sides, touched, np.argmax(sign == 0, axis=1))
        middle = _between(a, b, u, v)
        parts += [np.stack([on_it, a, middle], 1), np.stack([on_it, middle, b], 1)]
    crossed = both & ~touched
    if crossed.any():
        alone = np.argmax(sign == -np.sign(sign.sum(axis=1))[:, None], axis=1)
        (top, a, b), (w, u, v) = _turned(triangles, sides, crossed, alone)
        p, q = _between(top, a, w, u), _between(top, b, w, v)
        parts += [np.stack([top, p, q], 1), np.stack([p, a, b], 1), np.stack([p, b, q], 1)]
    return np.concatenate(parts)


def _turned(triangles: Array, sides: Array, which: NDArray[np.bool_], first: NDArray[np.intp]) -> tuple[Array, Array]:
    """Return corners (3, m, 3) and sides (3, m) of some triangles, each from its corner ``first`` on."""
    order = (first[which, None] + np.arange(3)) % 3
    corners = np.take_along_axis(triangles[which], order[..., None], axis=1)
    return corners.transpose(1, 0, 2), np.take_along_axis(sides[which], order, axis=1).T


def _crosses(u: Array, v: Array) -> NDArray[np.bool_]:
    return ((u > NEAR) & (v < -NEAR)) | ((u < -NEAR) & (v > NEAR))


def _between(a: Array, b: Array, u: Array, v: Array) -> Array:
    """Return where edges (m, 3) from ``a`` to ``b`` meet the line; the same bits from either end."""
    ahead = (u > v)[:, None]
    a, b = np.where(ahead, a, b), np.where(ahead, b, a)
    u, v = np.maximum(u, v), np.minimum(u, v)
    return a + (u / (u - v))[:, None] * (b - a)


# Solids that a section cuts open, for files of other programs: closed again, with hatched cut faces.
#
# Hatches are triangles of two materials, not a texture: every viewer shows them, and a stage stays one file.

LEVEL = 1e-9
"""Corners this near (m) to a plane are on it."""
PART = "cut as they stand at the start, for meshes of a file cannot be cut anew at every moment"


def pieces_of(film: Film) -> list[PieceSpec]:
    """Return the film's pieces as files of meshes have them.

    Pieces that go through fixed planes are cut as they start.
    """
    return [piece for each in film.scene.pieces if (piece := _at_start(film, each)) is not None]


def front_of(film: Film) -> float:
    """Return the height (m) beyond which springs, ropes and belts are cut away; infinite if they are not.

    Planes that stand up leave them: in every other shape what hangs between bodies passes those.
    """
    return film.cut[0][3] if film.cut and all(plane[2] for plane in film.cut) else math.inf


def said_of(film: Film) -> str:
    """Return a note on bodies, springs, ropes and belts that are cut otherwise; empty without any."""
    bodies = dict.fromkeys(piece.body for piece in film.scene.pieces if piece.fixed)
    words = [f"{', '.join(bodies)}: {PART}"] if bodies else []
    if film.cut and front_of(film) == math.inf:
        words.append("springs, ropes and belts are whole, as the film's are not")
    return f"{film.motion.mechanism}: {'; '.join(words)}" if words else ""


def faces_of(triangles: Array, piece: PieceSpec, radius: float) -> list[tuple[Array, SurfaceSpec]]:
    """Return triangles (n, 3, 3) (m) of what a piece's section leaves, with their surfaces.

    The surfaces are the piece's own, and the light and dark stripes of its cut faces, as wide as a machine of this
    ``radius`` (m) has them.

    Raises UserError where manifold3d is missing, or the piece is not closed.
    """
    rest, caps = cut_open(triangles, piece)
    hatches = [_hatch(piece, plane, radius) for plane in piece.cut]
    for k, (plane, hatch) in enumerate(zip(piece.cut, hatches, strict=True)):
        rest = along_rim(rest, plane, hatch, LIGHT, LEVEL)
        caps = [cap if j == k else along_rim(cap, plane, hatch, LIGHT, LEVEL) for j, cap in enumerate(caps)]
    light, dark = zip(*(striped(cap, hatch, LIGHT) for cap, hatch in zip(caps, hatches, strict=True)), strict=True)
    tones = (light_of(piece.surface.colour), dark_of(piece.surface.colour))
    surfaces = [SurfaceSpec(colour=tone, finish="plastic", roughness=MATT) for tone in tones]
    return [(rest, piece.surface), (np.concatenate(light), surfaces[0]), (np.concatenate(dark), surfaces[1])]


def _hatch(piece: PieceSpec, plane: Plane, radius: float) -> Hatch:
    """Return stripes of a piece in a plane, their period in m."""
    hatch = hatch_of(f"{piece.body}/{piece.name}", plane)
    return Hatch(hatch.way, radius * hatch.period)


def cut_open(triangles: Array, piece: PieceSpec) -> tuple[Array, list[Array]]:
    """Return triangles (n, 3, 3) (m) of what a piece's section leaves: surface and cut along each plane.

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
    return _sorted(kept, piece.cut)


def _sorted(kept: Array, planes: Sequence[tuple[float, ...]]) -> tuple[Array, list[Array]]:
    """Return triangles on no plane, and those on each."""
    left, caps = np.ones(len(kept), bool), []
    for *normal, place in planes:
        on_it = left & (np.abs(kept @ np.array(normal) - place) < LEVEL).all(axis=1)
        caps.append(kept[on_it])
        left &= ~on_it
    return kept[left], caps


def _rest(solid: Any, piece: PieceSpec, corners: Array) -> Any:
    """Return the solid without what is beyond all planes.

    A single plane is exact, several are a wedge that is taken away.
    """
    if len(piece.cut) == 1:
        x, y, z, place = piece.cut[0]
        return solid.trim_by_plane((-x, -y, -z), -place)
    import manifold3d

    size = 8 * float(np.abs(corners).max())
    wedge = manifold3d.Manifold.cube((size, size, size), True)
    for x, y, z, place in piece.cut:
        wedge = wedge.trim_by_plane((x, y, z), place)
    return solid - wedge


def _at_start(film: Film, piece: PieceSpec) -> PieceSpec | None:
    """Return a piece cut where it stands at the start of the motion; None if nothing of it is left there."""
    if not piece.fixed:
        return piece
    pose = film.poses.body(piece.body, film.clock.moment(0))
    planes = tuple(in_body(plane, pose) for plane in piece.cut)
    heights = [read_corners(Path(piece.stl)) @ np.array(plane[:3]) - plane[3] for plane in planes]
    if all((height >= 0).all() for height in heights):
        return None
    passes = all((height > 0).any() for height in heights)
    return msgspec.structs.replace(piece, cut=planes if passes else (), fixed=False)
