"""How thin the walls of a piece are: what a ray from its surface inwards meets first."""

from __future__ import annotations

import numpy as np

NOZZLE = 0.4
"""Width of a usual nozzle (mm); thinner walls are not printed."""
RAYS = 150
"""So many rays are looked at, from the largest facets and from others."""
SQUARE = 0.94
"""A ray counts where it meets a face that looks the other way, within 20 degrees: a wall, no edge or wedge."""
NARROW = 0.35
"""From facets narrower than this no ray starts (mm): they are sides of engraved lines."""
SKIN = 1e-4
"""Rays start so far below the surface (mm)."""


def thinnest(triangles: np.ndarray) -> float:
    """The thinnest wall (mm) of a closed mesh (n, 3, 3) that its rays find; infinite where they find none."""
    across = np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0])
    size = np.linalg.norm(across, axis=1)
    sound = size > 1e-9
    triangles, across, size = triangles[sound], across[sound], size[sound]
    normals = across / size[:, None]
    edges = np.linalg.norm(triangles - np.roll(triangles, 1, axis=1), axis=2)
    wide = np.flatnonzero(size / edges.max(axis=1) > NARROW)
    order = wide[np.argsort(-size[wide], kind="stable")]
    chosen = np.unique(np.concatenate([order[: RAYS // 2], order[:: max(1, len(order) // (RAYS // 2))]]))
    walls = (_inside(triangles, normals, triangles[k].mean(axis=0), -normals[k]) for k in chosen)
    return min(walls, default=np.inf)


def _inside(triangles: np.ndarray, normals: np.ndarray, start: np.ndarray, way: np.ndarray) -> float:
    """How far it is to the next face along a ray (Moeller and Trumbore 1997); infinite where that leans."""
    first, second = triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0]
    aside = np.cross(way, second)
    volume = np.einsum("ij,ij->i", first, aside)
    with np.errstate(divide="ignore", invalid="ignore"):
        to = start - triangles[:, 0]
        u = np.einsum("ij,ij->i", to, aside) / volume
        over = np.cross(to, first)
        v = over @ way / volume
        far = np.einsum("ij,ij->i", second, over) / volume
        hit = (np.abs(volume) > 0) & (u >= 0) & (v >= 0) & (u + v <= 1) & (far > SKIN)
    if not hit.any():
        return np.inf
    at = int(np.argmin(np.where(hit, far, np.inf)))
    return float(far[at]) if float(normals[at] @ way) > SQUARE else np.inf
