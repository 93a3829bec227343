"""The light of a scene: sky, lamps, and environments that are painted."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any, NamedTuple

from render.blender.scene.materials import Graph, new_material
from render.film.scene import StudioSpec
from render.looks import Colour, Sky, Softbox, Sun

# Things far behind the machine with their light painted on: worked out from the lamps, without a ray.
#
# A lamp of power P and unit axis n_l that a face of unit normal n sees at the distance d along l gives
#
#     E = P (n . l)+ (-n_l . l)+ / (pi d^2),    radiance = colour E / pi
#
# and a lamp with a grid that times Cycles' fall-off (tan(spread / 2) - tan(angle))+ / (tan(spread / 2) - spread / 2).
# Nothing stands between, and what shines is a lobe around the mirror's direction (Phong 1975, Comm. ACM 18, 311).

# pyright: reportAttributeAccessIssue=false
# bpy fills itself in when it is imported, its stubs are empty.


Vector3 = tuple[float, float, float]
TOWARDS_EYE: Vector3 = (0.0, -0.99, 0.14)
"""From a wall behind the machine, as the camera stands."""
WIDE = 179.0
"""Degrees: a lamp that spreads so far has no grid."""


class Lamp(NamedTuple):
    """An area light in the axes of the thing that it shines on."""

    place: Vector3
    axis: Vector3
    """Unit vector along which it shines."""
    power: float
    colour: Colour
    spread: float
    """Degrees."""


class Shine(NamedTuple):
    """Reflections of a face."""

    strength: float
    """How bright the lobe is against what is matt."""
    sharp: float = 12.0
    """The lobe is the cosine from the mirror's direction to this power."""
    room: tuple[float, float] | None = None
    """Heights (m) between which the room that is mirrored grows lighter, as behind a bench below a lamp."""


def painted(
    name: str, colour: Colour, lamps: Sequence[Lamp], at: Vector3, ambient: float, shine: Shine | None = None
) -> Any:
    """Return a matt ``colour`` under ``lamps`` as seen from ``at``, and ``ambient`` light from all around."""
    made, graph = new_material(name)
    made.cycles.emission_sampling = "NONE"
    coordinates = graph.add("TexCoord")
    place, normal = coordinates.outputs["Object"], coordinates.outputs["Normal"]
    mirrored = _mirrored(graph, normal) if shine is not None else None
    light: Any = (ambient,) * 3
    for lamp in lamps:
        towards, strength = _seen_from(lamp, at)
        if strength == 0.0:
            continue
        lit = graph.math("MAXIMUM", _dot(graph, normal, towards), 0.0)
        if shine is not None:
            lobe = graph.math("POWER", graph.math("MAXIMUM", _dot(graph, mirrored, towards), 0.0), shine.sharp)
            lit = graph.math("MULTIPLY_ADD", lobe, shine.strength, lit)
        light = graph.vector("MULTIPLY_ADD", tuple(strength * part for part in lamp.colour), lit, light)
    if shine is not None and shine.room is not None:
        low, high = shine.room
        up = graph.add("SeparateXYZ", Vector=place).outputs["Z"]
        part = graph.add(
            "MapRange",
            {"interpolation_type": "SMOOTHSTEP"},
            Value=up,
            From_Min=low,
            From_Max=high,
            To_Min=0.45,
            To_Max=1.5,
        )
        light = graph.vector("SCALE", light, Scale=part.outputs[0])
    graph.add("OutputMaterial", Surface=graph.add("Emission", Color=graph.vector("MULTIPLY", light, colour)).outputs[0])
    return made


def _seen_from(lamp: Lamp, at: Vector3) -> tuple[Vector3, float]:
    """Return the direction of a lamp from a place, and E / (pi n . l) there."""
    away = tuple(there - here for there, here in zip(lamp.place, at, strict=True))
    far = math.hypot(*away)
    towards = (away[0] / far, away[1] / far, away[2] / far)
    cosine = -sum(a * b for a, b in zip(towards, lamp.axis, strict=True))
    if cosine <= 0.0:
        return towards, 0.0
    strength = lamp.power * cosine / (math.pi * far) ** 2
    if lamp.spread < WIDE:
        half = math.radians(lamp.spread) / 2.0
        strength *= max(math.tan(half) - math.sqrt(1.0 - min(cosine, 1.0) ** 2) / cosine, 0.0) / (math.tan(half) - half)
    return towards, strength


def _mirrored(graph: Graph, normal: Any) -> Any:
    """Return the direction from which the eye sees a mirror of this normal shine."""
    along = graph.math("MULTIPLY", _dot(graph, normal, TOWARDS_EYE), 2.0)
    return graph.vector("SUBTRACT", graph.vector("SCALE", normal, Scale=along), TOWARDS_EYE)


def _dot(graph: Graph, a: Any, b: Any) -> Any:
    node = graph.add("VectorMath", {"operation": "DOT_PRODUCT"})
    for index, value in enumerate((a, b)):
        graph.set(node, index, value)
    return node.outputs["Value"]


# Softboxes and the sun, as Blender's lights.

# pyright: reportAttributeAccessIssue=false
# bpy fills itself in when it is imported, its stubs are empty.


PANE, BAR, COLUMNS, ROWS = 1.6, 0.11, 6, 5
"""A window's panes and bars, in radii."""
WINDOW_AWAY = 7.0


def softbox(scene: Any, studio: StudioSpec, box: Softbox) -> Any:
    """Return an area light of a look."""
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
    """Return the lamps of a look in the axes of a thing's ``root``."""
    back = root.matrix_basis.inverted()
    lamps = []
    for box in boxes:
        place, aim = _placed_and_aimed(studio, box)
        axis = back.to_3x3() @ (aim - place).normalized()
        lamps.append(Lamp(tuple(back @ place), tuple(axis), box.power * studio.radius**2, box.colour, box.spread))
    return lamps


def sun(scene: Any, studio: StudioSpec, shining: Sun) -> list[Any]:
    """Return parallel light, and the window that it falls through."""
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
    """Return bars across the sun's way and a wall around them, which only throw shadows."""
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
    """Fade from a bright lower edge to nothing: far level faces catch more of it than near ones."""
    light.use_nodes = True
    graph = Graph(light.node_tree).clear()
    across = graph.add("SeparateXYZ", Vector=graph.add("NewGeometry").outputs["Parametric"])
    sides = graph.math("MULTIPLY", graph.math("PINGPONG", across.outputs["X"], 0.5), 2.0)
    soft = graph.math("SMOOTH_MIN", graph.math("MULTIPLY", sides, 2.0), 1.0, 0.5)
    down = graph.math("POWER", graph.math("SUBTRACT", 1.0, across.outputs["Y"]), 1.5)
    strength = graph.math("MULTIPLY", graph.math("MULTIPLY", soft, down), 2.6)
    graph.add("OutputLight", Surface=graph.add("Emission", Strength=strength).outputs[0])


# Light from all around.

# pyright: reportAttributeAccessIssue=false
# bpy fills itself in when it is imported, its stubs are empty.


def build(scene: Any, sky: Sky, up: tuple[float, float, float]) -> None:
    """Build the world of a scene: one colour, or a gradient along ``up``."""
    import bpy

    scene.world = bpy.data.worlds.new("sky")
    scene.world.use_nodes = True
    graph = Graph(scene.world.node_tree).clear()
    colour: Any = sky.zenith
    if not sky.zenith == sky.horizon == sky.below:
        height = graph.add("VectorMath", {"operation": "DOT_PRODUCT"})
        graph.set(height, 0, graph.add("TexCoord").outputs["Generated"])
        graph.set(height, 1, up)
        part = graph.math("ADD", 0.5, graph.math("MULTIPLY", height.outputs["Value"], 0.5))
        colour = graph.ramp(part, [(0.0, sky.below), (0.485, sky.horizon), (0.503, sky.horizon), (0.62, sky.zenith)])
    scene.world.cycles.sampling_method = "NONE"  # it is everywhere: rays that leave find it
    graph.add("OutputWorld", Surface=graph.add("Background", Color=colour, Strength=1.0).outputs[0])
