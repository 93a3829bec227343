"""Softboxes and the sun, as Blender's lights."""

# pyright: reportAttributeAccessIssue=false
# bpy fills itself in when it is imported, its stubs are empty.
from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

from render.blender.scene.nodes import Graph
from render.blender.scene.world.painted_light import Lamp
from render.film.scene import StudioSpec
from render.looks.look import Softbox, Sun

PANE, BAR, COLUMNS, ROWS = 1.6, 0.11, 6, 5
"""A window's panes and bars, in radii."""
WINDOW_AWAY = 7.0


def softbox(scene: Any, studio: StudioSpec, box: Softbox) -> Any:
    """An area light of a look."""
    import bpy

    radius = studio.radius
    place, aim = _placed_and_aimed(studio, box)
    light = bpy.data.lights.new(box.name, "AREA")
    light.shape = "RECTANGLE"
    light.size, light.size_y = box.size[0] * radius, box.size[1] * radius
    light.energy = box.power * radius**2
    light.color = box.colour
    light.spread = math.radians(box.spread)
    if box.fades:
        _fade_to_rim(light)
    return _placed(scene, light, place, aim)


def _placed_and_aimed(studio: StudioSpec, box: Softbox) -> tuple[Any, Any]:
    from mathutils import Matrix, Vector

    turn, centre = Matrix.Rotation(studio.azimuth, 4, "Z"), Vector(studio.centre)
    return tuple(centre + turn @ (Vector(place) * studio.radius) for place in (box.place, box.aim))  # pyright: ignore[reportReturnType]


def lamps_seen_from(root: Any, studio: StudioSpec, boxes: Sequence[Softbox]) -> list[Lamp]:
    """The lamps of a look in the axes of a thing's ``root``."""
    back = root.matrix_basis.inverted()
    lamps = []
    for box in boxes:
        place, aim = _placed_and_aimed(studio, box)
        axis = back.to_3x3() @ (aim - place).normalized()
        lamps.append(Lamp(tuple(back @ place), tuple(axis), box.power * studio.radius**2, box.colour, box.spread))
    return lamps


def sun(scene: Any, studio: StudioSpec, shining: Sun) -> list[Any]:
    """Parallel light, and the window that it falls through."""
    import bpy
    from mathutils import Matrix, Vector

    turn = Matrix.Rotation(studio.azimuth, 4, "Z")
    centre = Vector(studio.centre)
    toward = (turn @ Vector(shining.place)).normalized()
    light = bpy.data.lights.new("sun", "SUN")
    light.energy = shining.power
    light.color = shining.colour
    light.angle = math.radians(shining.angle)
    lamp = _placed(scene, light, centre + toward * WINDOW_AWAY * studio.radius, centre)
    return [lamp, _window(scene, studio, toward)] if shining.window else [lamp]


def _placed(scene: Any, light: Any, place: Any, aim: Any) -> Any:
    import bpy

    thing = bpy.data.objects.new(light.name, light)
    thing.location = place
    thing.rotation_euler = (aim - place).to_track_quat("-Z", "Y").to_euler()
    scene.collection.objects.link(thing)
    return thing


def _window(scene: Any, studio: StudioSpec, toward: Any) -> Any:
    """Bars across the sun's way and a wall around them, which only throw shadows."""
    import bpy
    from mathutils import Vector

    wide, high = COLUMNS * PANE / 2, ROWS * PANE / 2
    bars = [(-wide + k * PANE, 0.0, BAR / 2, high) for k in range(1, COLUMNS)]
    bars += [(0.0, -high + k * PANE, wide, BAR / 2) for k in range(1, ROWS)]
    far = 40.0
    bars += [(side * (wide + far), 0.0, far, far) for side in (-1, 1)]
    bars += [(0.0, side * (high + far), wide, far) for side in (-1, 1)]
    corners, faces = [], []
    for x, y, half, tall in bars:
        at = len(corners)
        corners += [(x + a * half, y + b * tall, 0.0) for a, b in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
        faces.append((at, at + 1, at + 2, at + 3))
    mesh = bpy.data.meshes.new("window")
    mesh.from_pydata([tuple(studio.radius * c for c in corner) for corner in corners], [], faces)
    thing = bpy.data.objects.new("window", mesh)
    thing.location = Vector(studio.centre) + toward * WINDOW_AWAY * studio.radius
    thing.rotation_euler = (-toward).to_track_quat("-Z", "Y").to_euler()
    thing.visible_camera = thing.visible_diffuse = thing.visible_glossy = thing.visible_transmission = False
    scene.collection.objects.link(thing)
    return thing


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
