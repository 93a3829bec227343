"""Tubes and trails in Blender."""

from __future__ import annotations

from typing import Any

import numpy as np

from render.blender.scene.materials import Graph, material
from render.film.scene import Point, TrailSpec, TubeSpec

# Tubes of even thickness along paths that change: coils, rods, ropes.

# pyright: reportAttributeAccessIssue=false
# bpy fills itself in when it is imported, its stubs are empty.


SIDES = 16


def build_tube(scene: Any, spec: TubeSpec, radius: float) -> Any:
    """Return the tube with flat ends, whose vertices :func:`place_tube` moves.

    ``radius`` is the motion's (m).
    """
    import bpy

    mesh = bpy.data.meshes.new(spec.name)
    faces = _round_faces(spec.points, SIDES)
    round_ones = len(faces)
    faces += [tuple(reversed(range(SIDES))), tuple(range((spec.points - 1) * SIDES, spec.points * SIDES))]
    mesh.from_pydata([(0.0, 0.0, 0.0)] * (spec.points * SIDES), [], faces)
    mesh.polygons.foreach_set("use_smooth", [True] * round_ones + [False] * 2)
    mesh.materials.append(material(spec.surface, spec.name, radius))
    thing = bpy.data.objects.new(mesh.name, mesh)
    scene.collection.objects.link(thing)
    return thing


def tube_vertices(path: list[Point], radius: float) -> np.ndarray:
    """Return vertices (points * SIDES, 3), float32, of the tube along ``path``.

    Rings turn with the path and no more. All are at one point if ``path`` is: there is no tube.
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


def place_tube(thing: Any, path: list[Point], radius: float) -> None:
    """Lay the tube along ``path``."""
    _move(thing, tube_vertices(path, radius))


def _round_faces(rings: int, sides: int) -> list[tuple[int, ...]]:
    """Return the faces between neighbouring rings of ``sides`` vertices."""
    faces: list[tuple[int, ...]] = []
    for ring in range(rings - 1):
        for side in range(sides):
            a, b = ring * sides + side, ring * sides + (side + 1) % sides
            faces.append((a, b, b + sides, a + sides))
    return faces


def _move(thing: Any, vertices: np.ndarray) -> None:
    thing.data.vertices.foreach_set("co", vertices.ravel())
    thing.data.update()


# The trace of a point: a luminous tube that is thick and bright at the point and fades towards its end.

# pyright: reportAttributeAccessIssue=false
# bpy fills itself in when it is imported, its stubs are empty.


TRAIL_SIDES = 10
CAP = 4
"""Rings of the round end at the point."""


def build_trail(scene: Any, trail: TrailSpec) -> Any:
    """Return the tube as a mesh object whose vertices :func:`place_trail` moves."""
    import bpy

    mesh = bpy.data.meshes.new(f"trail {trail.name}")
    rings = trail.rings + CAP
    faces = _round_faces(rings, TRAIL_SIDES)
    faces.append(tuple(reversed(range(TRAIL_SIDES))))
    mesh.from_pydata([(0.0, 0.0, 0.0)] * (rings * TRAIL_SIDES), [], faces)
    mesh.polygons.foreach_set("use_smooth", [True] * len(mesh.polygons))
    fade = mesh.attributes.new("fade", "FLOAT", "POINT")
    values = np.concatenate([np.ones(CAP), _fade(trail.rings)])
    fade.data.foreach_set("value", np.repeat(values, TRAIL_SIDES).astype(np.float32))
    mesh.materials.append(_light(trail))
    thing = bpy.data.objects.new(mesh.name, mesh)
    thing.visible_shadow = False
    thing.visible_diffuse = False
    scene.collection.objects.link(thing)
    return thing


def trail_vertices(path: list[Point], radius: float) -> np.ndarray:
    """Return vertices ((CAP + rings) * SIDES, 3), float32, of the tube along ``path``, last point first."""
    line = np.asarray(path)
    along = np.gradient(line[:, :2], axis=0)
    length = np.linalg.norm(along, axis=1, keepdims=True)
    moving = np.flatnonzero(length[:, 0] > 1e-12)
    if len(moving):  # where the point stood still, the tube goes on as it did beside
        nearest = moving[np.abs(np.arange(len(line))[:, None] - moving).argmin(axis=1)]
        along = along[nearest] / length[nearest]
    else:
        along = np.tile([1.0, 0.0], (len(line), 1))
    across = np.column_stack([-along[:, 1], along[:, 0], np.zeros(len(line))])
    up = np.array([0.0, 0.0, 1.0])
    angle = np.arange(TRAIL_SIDES) * 2 * np.pi / TRAIL_SIDES
    rim = np.cos(angle)[None, :, None] * across[:, None, :] + np.sin(angle)[None, :, None] * up
    thickness = radius * (0.30 + 0.70 * _fade(len(line)) ** 0.8)
    tube = line[:, None, :] + rim * thickness[:, None, None]
    angle = np.linspace(0.1, 1.0, CAP, endpoint=False)[:, None, None] * np.pi / 2
    ahead = np.append(-along[0], 0.0)
    cap = line[0] + radius * (np.cos(angle) * ahead + np.sin(angle) * rim[0])
    return np.concatenate([cap, tube]).reshape(-1, 3).astype(np.float32)


def place_trail(thing: Any, path: list[Point], radius: float) -> None:
    """Lay the tube along ``path``."""
    _move(thing, trail_vertices(path, radius))


def _fade(rings: int) -> np.ndarray:
    """Return the fade: 1 at the point, 0 at the end of the tail."""
    return (1 - np.linspace(0, 1, rings)) ** 1.5


def _light(trail: TrailSpec) -> Any:
    import bpy

    made = bpy.data.materials.new(f"trail {trail.name}")
    made.use_nodes = True
    made.cycles.emission_sampling = "NONE"  # a thin light sampled at random is all noise
    graph = Graph(made.node_tree).clear()
    fade = graph.add("Attribute", {"attribute_name": "fade"}).outputs["Fac"]
    strength = graph.math("MULTIPLY", graph.math("ADD", 0.25, graph.math("MULTIPLY", fade, 0.75)), trail.strength)
    light = graph.add("Emission", Color=trail.colour, Strength=strength).outputs[0]
    gone = graph.add("BsdfTransparent").outputs[0]
    mix = graph.add("MixShader", Fac=graph.math("MINIMUM", 1.0, graph.math("MULTIPLY", fade, 4.0)))
    graph.set(mix, 1, gone)
    graph.set(mix, 2, light)
    graph.add("OutputMaterial", Surface=mix.outputs[0])
    return made
