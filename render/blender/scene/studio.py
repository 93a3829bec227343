"""The studio: a backdrop without a horizon, softboxes, rim lights. Sized by what is filmed, turned with the camera.

Places are (right, away, up) as the camera stands, in radii of the swept motion around its middle. A light's power
grows with the square of its distance, so a mechanism of any size is lit alike.
"""

# pyright: reportAttributeAccessIssue=false
# bpy fills itself in when it is imported, its stubs are empty.
from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

from render.blender.scene.nodes import Graph
from render.film.scene import Colour, StudioSpec


@dataclass(frozen=True)
class Softbox:
    """An area light; ``power`` is W for a radius of one metre."""

    name: str
    place: tuple[float, float, float]
    size: tuple[float, float]
    power: float
    colour: Colour = (1.0, 1.0, 1.0)
    aim: tuple[float, float, float] = (0.0, 0.0, 0.0)
    spread: float = 180.0
    fades: bool = False
    """Dims towards its rim, so that its edge in a reflection is a gradient; costs a little render time."""


@dataclass(frozen=True)
class Look:
    """A light setting by name."""

    floor: Colour
    floor_roughness: float
    world: Colour
    exposure: float
    contrast: str
    softboxes: tuple[Softbox, ...]


LOOKS = {
    "studio": Look(
        floor=(0.016, 0.019, 0.026),
        floor_roughness=0.34,
        world=(0.016, 0.018, 0.024),
        exposure=0.1,
        contrast="AgX - High Contrast",
        softboxes=(
            Softbox("overhead", (-0.3, 3.4, 2.5), (5.0, 2.0), 68.0, (1.0, 0.985, 0.96), (0.0, 0.3, 0.0), fades=True),
            Softbox("pool", (1.3, -0.3, 4.2), (0.6, 0.6), 70.0, (1.0, 0.97, 0.94), (0.15, 0.4, -0.3), 48.0),
            Softbox("rim cool", (-3.2, 1.4, 0.9), (0.6, 2.8), 105.0, (0.42, 0.68, 1.0)),
            Softbox("rim warm", (3.2, 0.9, 0.8), (0.6, 2.8), 90.0, (1.0, 0.58, 0.28)),
            Softbox("fill", (-1.2, -3.8, 1.6), (3.4, 1.6), 52.0, (0.84, 0.91, 1.0)),
        ),
    ),
    "daylight": Look(
        floor=(0.62, 0.62, 0.61),
        floor_roughness=0.55,
        world=(0.32, 0.34, 0.37),
        exposure=0.0,
        contrast="AgX - Base Contrast",
        softboxes=(
            Softbox("overhead", (-0.6, 1.8, 3.2), (3.4, 2.4), 46.0, (1.0, 0.98, 0.95)),
            Softbox("rim cool", (-3.0, 1.4, 1.4), (0.8, 2.6), 14.0, (0.80, 0.90, 1.0)),
            Softbox("rim warm", (3.0, 1.2, 1.2), (0.8, 2.6), 12.0, (1.0, 0.88, 0.74)),
        ),
    ),
}


def build(scene: Any, studio: StudioSpec) -> None:
    """Put backdrop, lights and world around the mechanism and set the view."""
    look = LOOKS[studio.look]
    _world(scene, look)
    _backdrop(scene, studio, look)
    for box in look.softboxes:
        _softbox(scene, studio, box)
    view = scene.view_settings
    view.view_transform = "AgX"
    view.look = look.contrast
    view.exposure = look.exposure


def _world(scene: Any, look: Look) -> None:
    import bpy

    scene.world = bpy.data.worlds.new("studio")
    scene.world.use_nodes = True
    graph = Graph(scene.world.node_tree).clear()
    graph.add("OutputWorld", Surface=graph.add("Background", Color=look.world, Strength=1.0).outputs[0])


def _backdrop(scene: Any, studio: StudioSpec, look: Look) -> None:
    """A floor that bends upwards far behind: a profile swept sideways."""
    import bpy

    radius, half = studio.radius, 14.0
    bend_start, bend = 5.0, 3.0
    profile = [(-12.0, 0.0), (bend_start, 0.0)]
    for step in range(1, 33):
        angle = math.pi / 2 * step / 32
        profile.append((bend_start + bend * math.sin(angle), bend * (1 - math.cos(angle))))
    profile.append((bend_start + bend, 14.0))
    corners = [(side * half * radius, away * radius, up * radius) for away, up in profile for side in (-1, 1)]
    faces = [(2 * i, 2 * i + 1, 2 * i + 3, 2 * i + 2) for i in range(len(profile) - 1)]
    mesh = bpy.data.meshes.new("backdrop")
    mesh.from_pydata(corners, [], faces)
    mesh.polygons.foreach_set("use_smooth", [True] * len(faces))
    thing = bpy.data.objects.new("backdrop", mesh)
    thing.location = (studio.centre[0], studio.centre[1], studio.floor)
    thing.rotation_euler = (0.0, 0.0, studio.azimuth)
    scene.collection.objects.link(thing)

    paint = bpy.data.materials.new("backdrop")
    paint.use_nodes = True
    graph = Graph(paint.node_tree).clear()
    shader = graph.add("BsdfPrincipled", Base_Color=look.floor, Roughness=look.floor_roughness, Specular_IOR_Level=0.5)
    graph.add("OutputMaterial", Surface=shader.outputs[0])
    mesh.materials.append(paint)


def _softbox(scene: Any, studio: StudioSpec, box: Softbox) -> None:
    import bpy
    from mathutils import Matrix, Vector

    radius = studio.radius
    turn = Matrix.Rotation(studio.azimuth, 4, "Z")
    centre = Vector(studio.centre)
    place = centre + turn @ (Vector(box.place) * radius)
    aim = centre + turn @ (Vector(box.aim) * radius)
    light = bpy.data.lights.new(box.name, "AREA")
    light.shape = "RECTANGLE"
    light.size, light.size_y = box.size[0] * radius, box.size[1] * radius
    light.energy = box.power * radius**2
    light.color = box.colour
    light.spread = math.radians(box.spread)
    if box.fades:
        _fade_to_rim(light)
    thing = bpy.data.objects.new(box.name, light)
    thing.location = place
    thing.rotation_euler = (aim - place).to_track_quat("-Z", "Y").to_euler()
    scene.collection.objects.link(thing)


def _fade_to_rim(light: Any) -> None:
    """Bright along its lower edge, gone at its upper: level faces far off catch more of it than near ones."""
    light.use_nodes = True
    graph = Graph(light.node_tree).clear()
    across = graph.add("SeparateXYZ", Vector=graph.add("NewGeometry").outputs["Parametric"])
    sides = graph.math("MULTIPLY", graph.math("PINGPONG", across.outputs["X"], 0.5), 2.0)
    soft = graph.math("SMOOTH_MIN", graph.math("MULTIPLY", sides, 2.0), 1.0, 0.5)
    down = graph.math("POWER", graph.math("SUBTRACT", 1.0, across.outputs["Y"]), 1.5)
    strength = graph.math("MULTIPLY", graph.math("MULTIPLY", soft, down), 2.6)
    graph.add("OutputLight", Surface=graph.add("Emission", Strength=strength).outputs[0])
