"""Curved arrows: a thin tube round a pivot with a cone at its end, a mesh whose vertices follow the sweep."""

# pyright: reportAttributeAccessIssue=false
# bpy fills itself in when it is imported, its stubs are empty.
from __future__ import annotations

import math
from typing import Any

import numpy as np

from render.blender.scene.arrows import GONE, STOUT, paint
from render.film.scene import ArcSpec, Point

SIDES = 24
RINGS = 64
"""Number of rings of the tube; two more are the cone."""
FRONT = -math.pi / 2
"""Angle (rad) of the middle of every arc: towards the camera."""


def build(scene: Any, spec: ArcSpec) -> Any:
    """The mesh object, whose vertices :func:`place` moves."""
    import bpy

    mesh = bpy.data.meshes.new(f"arc {spec.name}")
    sides, ends = faces()
    mesh.from_pydata([(0.0, 0.0, 0.0)] * ((RINGS + 2) * SIDES), [], [*sides, *ends])
    smooth = np.arange(len(sides) + len(ends)) < len(sides)
    smooth[(RINGS - 1) * SIDES : RINGS * SIDES] = False  # behind the cone
    mesh.polygons.foreach_set("use_smooth", smooth)
    mesh.materials.append(paint(spec.name, spec.colour))
    thing = bpy.data.objects.new(mesh.name, mesh)
    thing.visible_shadow = thing.visible_diffuse = thing.visible_glossy = False
    scene.collection.objects.link(thing)
    return thing


def faces() -> tuple[list[tuple[int, ...]], list[tuple[int, ...]]]:
    """Numbers of the vertices of each face: round the tube and its cone, and at the two ends."""
    around: list[tuple[int, ...]] = []
    for ring in range(RINGS + 1):
        for side in range(SIDES):
            a, b = ring * SIDES + side, ring * SIDES + (side + 1) % SIDES
            around.append((a, b, b + SIDES, a + SIDES))
    last = (RINGS + 1) * SIDES
    return around, [tuple(reversed(range(SIDES))), tuple(range(last, last + SIDES))]


def vertices(spec: ArcSpec, centre: Point, sweep: float) -> np.ndarray:
    """Vertices ((RINGS + 2) * SIDES, 3), float32, of an arc about ``centre`` (m) that reaches ``sweep`` (rad) round it.

    Its middle is at FRONT; arcs shorter than STOUT cones shrink as a whole.
    """
    length = max(abs(sweep) * spec.radius, GONE)
    factor = min(1.0, length / (STOUT * spec.point))
    way = math.copysign(1.0, sweep)
    start, end = FRONT - sweep / 2, FRONT + sweep / 2
    neck = end - way * min(factor * spec.point, 0.9 * length) / spec.radius
    angle = np.concatenate([np.linspace(start, neck, RINGS), [neck, end]])
    thick = factor * np.concatenate([np.full(RINGS, spec.shaft), [spec.head, 1e-3 * spec.head]])
    out = np.stack([np.cos(angle), np.sin(angle), 0 * angle], axis=1)
    turn = -way * math.tau * np.arange(SIDES) / SIDES  # faces look outwards whichever way it goes
    rim = np.cos(turn)[None, :, None] * out[:, None] + np.sin(turn)[None, :, None] * np.array([0.0, 0.0, 1.0])
    tube = np.asarray(centre) + spec.radius * out[:, None] + thick[:, None, None] * rim
    return tube.reshape(-1, 3).astype(np.float32)


def place(thing: Any, spec: ArcSpec, centre: Point, sweep: float) -> None:
    """Let the arc reach ``sweep`` (rad) round ``centre``; it is not there where that is 0."""
    thing.data.vertices.foreach_set("co", vertices(spec, centre, sweep).ravel())
    thing.data.update()
