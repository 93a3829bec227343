"""Tubes of even thickness along paths that change: coils, rods, ropes."""

# pyright: reportAttributeAccessIssue=false
# bpy fills itself in when it is imported, its stubs are empty.
from __future__ import annotations

from typing import Any

import numpy as np

from render.blender.scene.materials import material
from render.film.scene import Point, TubeSpec

SIDES = 16


def build(scene: Any, spec: TubeSpec, radius: float) -> Any:
    """The tube, whose vertices :func:`place` moves; its ends are flat. ``radius`` is the motion's (m)."""
    import bpy

    mesh = bpy.data.meshes.new(spec.name)
    faces: list[tuple[int, ...]] = []
    for ring in range(spec.points - 1):
        for side in range(SIDES):
            a, b = ring * SIDES + side, ring * SIDES + (side + 1) % SIDES
            faces.append((a, b, b + SIDES, a + SIDES))
    round_ones = len(faces)
    faces += [tuple(reversed(range(SIDES))), tuple(range((spec.points - 1) * SIDES, spec.points * SIDES))]
    mesh.from_pydata([(0.0, 0.0, 0.0)] * (spec.points * SIDES), [], faces)
    mesh.polygons.foreach_set("use_smooth", [True] * round_ones + [False] * 2)
    mesh.materials.append(material(spec.surface, spec.name, radius))
    thing = bpy.data.objects.new(mesh.name, mesh)
    scene.collection.objects.link(thing)
    return thing


def vertices(path: list[Point], radius: float) -> np.ndarray:
    """Vertices (points * SIDES, 3), float32, of the tube along ``path``; rings turn with the path and no more.

    All are at one point if ``path`` is: there is no tube.
    """
    line = np.asarray(path)
    if not np.ptp(line, axis=0).any():
        return np.repeat(line, SIDES, axis=0).astype(np.float32)
    along = np.gradient(line, axis=0)
    along /= np.linalg.norm(along, axis=1, keepdims=True)
    across = np.empty_like(line)
    across[0] = np.cross(along[0], np.eye(3)[np.abs(along[0]).argmin()])
    for k in range(1, len(line)):
        across[k] = across[k - 1] - (across[k - 1] @ along[k]) * along[k]
    across /= np.linalg.norm(across, axis=1, keepdims=True)
    other = np.cross(along, across)
    angle = np.arange(SIDES) * 2 * np.pi / SIDES
    rim = np.cos(angle)[None, :, None] * across[:, None] + np.sin(angle)[None, :, None] * other[:, None]
    return (line[:, None] + radius * rim).reshape(-1, 3).astype(np.float32)


def place(thing: Any, path: list[Point], radius: float) -> None:
    """Lay the tube along ``path``."""
    thing.data.vertices.foreach_set("co", vertices(path, radius).ravel())
    thing.data.update()
