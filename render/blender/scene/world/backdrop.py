"""The floor, and what it ends in: a bend without a horizon, a wall, or the haze of the distance."""

# pyright: reportAttributeAccessIssue=false
# bpy fills itself in when it is imported, its stubs are empty.
from __future__ import annotations

import math
from typing import Any

from render.blender.scene.world import ground
from render.film.scene import StudioSpec
from render.looks.look import Ground

HALF, BEFORE = 14.0, -12.0
BEND, HIGH = 3.0, 14.0
OPEN = 300.0
"""How far an open ground goes, in radii."""
PLASTER = (0.58, 0.57, 0.55)


def build(scene: Any, studio: StudioSpec, bounce: float) -> Any:
    """One sheet around the origin under the machine's middle, its x along the picture."""
    import bpy

    look, radius = studio.look, studio.radius
    if look.wall is None:
        corners = [(a * OPEN, b * OPEN, 0.0) for a, b in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
        faces = [(0, 1, 2, 3)]
    else:
        profile = _bent(look.wall.away) if look.wall.kind == "sweep" else [(BEFORE, 0.0), (HALF, 0.0)]
        corners = [(side * HALF, away, up) for away, up in profile for side in (-1, 1)]
        faces = [(2 * i, 2 * i + 1, 2 * i + 3, 2 * i + 2) for i in range(len(profile) - 1)]
    mesh = bpy.data.meshes.new("backdrop")
    mesh.from_pydata([tuple(radius * c for c in corner) for corner in corners], [], faces)
    mesh.polygons.foreach_set("use_smooth", [True] * len(faces))
    thing = bpy.data.objects.new("backdrop", mesh)
    thing.location = (studio.centre[0], studio.centre[1], studio.floor)
    thing.rotation_euler = (0.0, 0.0, studio.azimuth)
    scene.collection.objects.link(thing)
    haze = look.sky.horizon if look.wall is None else None
    mesh.materials.append(ground.paint(look.ground, radius, haze, bounce))
    return thing


def wall(scene: Any, studio: StudioSpec) -> Any:
    """A wall in the plane of the motion, at which the machine hangs."""
    import bpy

    look, radius = studio.look, studio.radius
    mesh = bpy.data.meshes.new("wall")
    corners = [(a * HALF, 0.0, b * HIGH) for a, b in ((-1, 0), (1, 0), (1, 1), (-1, 1))]
    mesh.from_pydata([tuple(radius * c for c in corner) for corner in corners], [], [(0, 1, 2, 3)])
    thing = bpy.data.objects.new("wall", mesh)
    thing.location = (studio.centre[0], studio.wall or 0.0, studio.floor)
    scene.collection.objects.link(thing)
    plaster = look.wall.colour if look.wall is not None else PLASTER
    mesh.materials.append(ground.paint(Ground(texture="paint", colour=plaster, roughness=0.7), radius))
    return thing


def _bent(away: float) -> list[tuple[float, float]]:
    """A profile (away, up) that bends upwards."""
    profile = [(BEFORE, 0.0), (away, 0.0)]
    for step in range(1, 33):
        angle = math.pi / 2 * step / 32
        profile.append((away + BEND * math.sin(angle), BEND * (1 - math.cos(angle))))
    return [*profile, (away + BEND, HIGH)]
