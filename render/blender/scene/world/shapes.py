"""Boxes, rods and outlines with rounded edges, from which the things of a workshop are put together. In radii."""

# pyright: reportAttributeAccessIssue=false
# bpy fills itself in when it is imported, its stubs are empty.
from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np

Corner = tuple[float, float, float]
AROUND = 32
"""Corners of a round."""


class Thing:
    """Solids under one origin; ``radius`` scales radii to metres."""

    def __init__(self, scene: Any, name: str, radius: float, place: Any, azimuth: float) -> None:
        import bpy

        self.scene, self.radius = scene, radius
        self.seen_only = False
        """Whether light that bounces passes through what is added from now on."""
        self.root = bpy.data.objects.new(name, None)
        self.root.location = place
        self.root.rotation_euler = (0.0, 0.0, azimuth)
        scene.collection.objects.link(self.root)

    def box(self, low: Corner, high: Corner, paint: Any, bevel: float = 0.008) -> None:
        """An upright box between two corners."""
        (x0, y0, z0), (x1, y1, z1) = low, high
        self.outline([(x0, y0), (x1, y0), (x1, y1), (x0, y1)], z0, z1, paint, bevel)

    def outline(self, around: Sequence[tuple[float, float]], low: float, high: float, paint: Any, bevel: float) -> None:
        """A prism over a counter-clockwise outline (x, y), from ``low`` to ``high``."""
        self._solid([[(x, y, z) for x, y in around] for z in (low, high)], paint, bevel)

    def hung(self, around: Sequence[tuple[float, float]], front: float, back: float, paint: Any, bevel: float) -> None:
        """A prism over an outline (x, z), from ``front`` to ``back`` in y."""
        self._solid([[(x, y, z) for x, z in around] for y in (back, front)], paint, bevel)

    def rod(self, start: Corner, end: Corner, widths: Sequence[tuple[float, float]], paint: Any) -> None:
        """A turned rod; ``widths`` are (part of its length, radius) from start to end."""
        first, axis = np.array(start), np.array(end) - np.array(start)
        along = axis / np.linalg.norm(axis)
        across = np.cross(along, np.eye(3)[np.abs(along).argmin()])
        across /= np.linalg.norm(across)
        other = np.cross(along, across)
        angles = [math.tau * k / AROUND for k in range(AROUND)]
        rings = [
            [tuple(first + part * axis + r * (math.cos(a) * across + math.sin(a) * other)) for a in angles]
            for part, r in widths
        ]
        self._solid(rings, paint, 0.0)

    def _solid(self, rings: Sequence[Sequence[Any]], paint: Any, bevel: float) -> None:
        """Rings of as many corners each, closed at both ends."""
        import bpy

        count = len(rings[0])
        faces: list[tuple[int, ...]] = [tuple(reversed(range(count)))]
        faces.append(tuple(range((len(rings) - 1) * count, len(rings) * count)))
        for ring in range(len(rings) - 1):
            for k in range(count):
                a, b = ring * count + k, ring * count + (k + 1) % count
                faces.append((a, b, b + count, a + count))
        mesh = bpy.data.meshes.new(self.root.name)
        mesh.from_pydata([tuple(self.radius * c for c in corner) for ring in rings for corner in ring], [], faces)
        mesh.polygons.foreach_set("use_smooth", [True] * len(faces))
        mesh.set_sharp_from_angle(angle=math.radians(35))
        mesh.materials.append(paint)
        thing = bpy.data.objects.new(mesh.name, mesh)
        thing.parent = self.root
        thing.visible_diffuse = thing.visible_glossy = not self.seen_only
        self.scene.collection.objects.link(thing)
        if bevel:
            rounded = thing.modifiers.new("bevel", "BEVEL")
            rounded.width, rounded.segments, rounded.limit_method = bevel * self.radius, 3, "ANGLE"
            rounded.harden_normals = True
