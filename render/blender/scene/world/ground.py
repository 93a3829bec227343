"""The ground and the backdrop of a scene."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

from render.blender.scene.materials import Graph
from render.film.scene import StudioSpec
from render.looks import Colour, Ground

# Grounds: paint, boards of wood, concrete, asphalt with its marks, rippled sand. Textures are in radii.

# pyright: reportAttributeAccessIssue=false
# bpy fills itself in when it is imported, its stubs are empty.


BOARD, BOARD_LENGTH, GAP = 0.62, 6.4, 0.006
HAZE_FROM, HAZE_TO = 5.5, 34.0
"""Between these distances from the camera an open ground fades into the horizon."""
LANE = 1.55
"""From the machine to the line at the edge of its lane."""


def paint(ground: Ground, radius: float, haze: Colour | None = None, bounce: float = 0.0) -> Any:
    """Return the material of a ground around the origin of its object; it fades into ``haze`` far away.

    ``bounce``: see Light in render/looks.py.

    """
    import bpy

    made = bpy.data.materials.new(ground.texture)
    made.use_nodes = True
    made.cycles.emission_sampling = "NONE"
    graph = Graph(made.node_tree).clear()
    place = graph.add("Mapping", Vector=graph.add("TexCoord").outputs["Object"], Scale=(1 / radius,) * 3).outputs[0]
    shader = TEXTURES[ground.texture](graph, ground, place)
    if ground.texture != "paint":
        shader = _seen_only(graph, shader, ground, bounce)
    if haze is not None:
        shader = _hazed(graph, shader, haze, radius)
    graph.add("OutputMaterial", Surface=shader)
    return made


def _seen_only(graph: Graph, shader: Any, ground: Ground, bounce: float) -> Any:
    """Return the texture for the eye.

    Light that bounces meets the colour between its two: half the time of a frame.
    """
    middle: Colour = tuple((a + b) / 2 for a, b in zip(ground.colour, ground.other, strict=True))  # pyright: ignore[reportAssignmentType]
    plain = graph.add("BsdfDiffuse", Color=middle).outputs[0]
    if bounce > 0.0:
        plain = graph.mixed("Is Diffuse Ray", plain, glow(graph, middle, bounce))
    return graph.mixed("Is Camera Ray", plain, shader)


def glow(graph: Graph, colour: Colour, bounce: float) -> Any:
    """Return the glow that bounced light meets instead of a bright surface.

    It saves a tenth of the time of a frame.
    """
    return graph.add("Emission", Color=colour, Strength=bounce).outputs[0]


def _hazed(graph: Graph, shader: Any, haze: Colour, radius: float) -> Any:
    """Return a shader with haze, as the eye sees it from far.

    Light that falls on it and what it reflects stay as they are.

    """
    away = graph.math("DIVIDE", graph.add("CameraData").outputs["View Distance"], radius)
    part = graph.add(
        "MapRange", {"interpolation_type": "SMOOTHERSTEP"}, Value=away, From_Min=HAZE_FROM, From_Max=HAZE_TO
    )
    seen = graph.math("MULTIPLY", part.outputs[0], graph.add("LightPath").outputs["Is Camera Ray"])
    mix = graph.add("MixShader")
    glow = graph.add("Emission", Color=haze, Strength=1.0).outputs[0]
    for index, value in enumerate((seen, shader, glow)):
        graph.set(mix, index, value)
    return mix.outputs[0]


def _noise(graph: Graph, place: Any, scale: float | tuple[float, float, float], detail: float = 2.0) -> Any:
    if isinstance(scale, tuple):
        place, scale = graph.add("Mapping", Vector=place, Scale=scale).outputs[0], 1.0
    return graph.add(
        "TexNoise", {"noise_dimensions": "2D"}, Vector=place, Scale=scale, Detail=detail, Roughness=0.55
    ).outputs[0]


def _principled(graph: Graph, **inputs: Any) -> Any:
    return graph.add("BsdfPrincipled", Specular_IOR_Level=0.5, **inputs).outputs[0]


def _bump(graph: Graph, height: Any, strength: float, distance: float) -> Any:
    return graph.add("Bump", Height=height, Strength=strength, Distance=distance).outputs[0]


def _painted(graph: Graph, ground: Ground, place: Any) -> Any:
    return _principled(graph, Base_Color=ground.colour, Roughness=ground.roughness)


def _wood(graph: Graph, ground: Ground, place: Any) -> Any:
    """Return boards across the picture, each with its own tone and fibres."""
    split = graph.add("SeparateXYZ", Vector=place)
    across = graph.math("MULTIPLY_ADD", split.outputs["Y"], 1 / BOARD, 0.23 / BOARD)
    row = graph.math("FLOOR", across)
    along = graph.math("MULTIPLY_ADD", split.outputs["X"], 1 / BOARD_LENGTH, 2.1 / BOARD_LENGTH)
    along = graph.math("ADD", along, graph.math("FRACT", graph.math("MULTIPLY", row, 0.377)))
    column = graph.math("MULTIPLY", graph.math("FLOOR", along), 3.17)
    number = graph.math("MULTIPLY_ADD", row, 7.31, column)
    chance = graph.add("TexWhiteNoise", {"noise_dimensions": "1D"}, W=number).outputs["Value"]
    moved = graph.vector("MULTIPLY_ADD", chance, (31.0, 17.0, 0.0), place)
    rings = _noise(graph, moved, (0.55, 4.2, 4.2), 0.0)
    bands = graph.math("PINGPONG", graph.math("MULTIPLY", rings, 9.0), 0.5)
    fibres = _noise(graph, moved, (3.0, 120.0, 120.0), 0.0)
    part = graph.math("MULTIPLY_ADD", chance, 0.42, -0.21)
    part = graph.math("MULTIPLY_ADD", fibres, 0.45, part)
    part = graph.math("MULTIPLY_ADD", bands, 0.85, part)
    colour = graph.ramp(part, [(0.05, ground.colour), (0.95, ground.other)])
    edge = graph.math("MULTIPLY", graph.math("PINGPONG", across, 0.5), BOARD / GAP)
    end = graph.math("MULTIPLY", graph.math("PINGPONG", along, 0.5), BOARD_LENGTH / GAP)
    gap = graph.math("MINIMUM", graph.math("MINIMUM", edge, end), 1.0)
    shade = graph.vector("SCALE", colour, Scale=graph.math("MULTIPLY_ADD", gap, 0.88, 0.12))
    rough = graph.math("MULTIPLY_ADD", fibres, 0.18, ground.roughness - 0.06)
    return _principled(graph, Base_Color=shade, Roughness=rough)


def _concrete(graph: Graph, ground: Ground, place: Any) -> Any:
    """Return trowelled concrete: slow clouds and a fine grain."""
    clouds = _noise(graph, place, 1.1, 2.0)
    grain = _noise(graph, place, 38.0, 1.0)
    part = graph.math("ADD", graph.math("MULTIPLY", clouds, 0.75), graph.math("MULTIPLY", grain, 0.25))
    colour = graph.ramp(part, [(0.36, ground.other), (0.62, ground.colour)])
    return _principled(graph, Base_Color=colour, Roughness=ground.roughness)


def _asphalt(graph: Graph, ground: Ground, place: Any) -> Any:
    """Return stones in tar, and the lines of a lane along x."""
    stones = graph.add("TexVoronoi", {"voronoi_dimensions": "2D"}, Vector=place, Scale=90.0).outputs["Distance"]
    clouds = _noise(graph, place, 0.7, 1.0)
    part = graph.math("ADD", graph.math("MULTIPLY", stones, 0.9), graph.math("MULTIPLY", clouds, 0.45))
    colour = graph.ramp(part, [(0.30, ground.colour), (0.95, ground.other)])
    if ground.lines is not None:
        colour = _lined(graph, colour, ground.lines, place, stones)
    return _principled(graph, Base_Color=colour, Roughness=ground.roughness)


def _lined(graph: Graph, colour: Any, line: Colour, place: Any, worn: Any) -> Any:
    """Return a dashed line behind the machine and a whole one before it; tyres have worn them."""
    split = graph.add("SeparateXYZ", Vector=place)
    y = split.outputs["Y"]
    behind = graph.math("COMPARE", y, LANE, 0.055)
    dash = graph.math("LESS_THAN", graph.math("FRACT", graph.math("DIVIDE", split.outputs["X"], 2.6)), 0.55)
    before = graph.math("COMPARE", y, -LANE, 0.055)
    there = graph.math("MAXIMUM", graph.math("MULTIPLY", behind, dash), before)
    kept = graph.math("MULTIPLY", there, graph.math("SUBTRACT", 1.0, graph.math("MULTIPLY", worn, 0.75)))
    mix = graph.add("Mix", {"data_type": "RGBA"})
    graph.set(mix, 0, kept)
    graph.set(mix, 6, colour)
    graph.set(mix, 7, line)
    return mix.outputs[2]


def _sand(graph: Graph, ground: Ground, place: Any) -> Any:
    """Return sand with ripples of the wind, and grains."""
    bent = _noise(graph, place, 0.8, 1.0)
    split = graph.add("SeparateXYZ", Vector=place)
    phase = graph.math(
        "ADD", graph.math("MULTIPLY", split.outputs["Y"], 21.0), graph.math("MULTIPLY", split.outputs["X"], 5.0)
    )
    phase = graph.math("ADD", phase, graph.math("MULTIPLY", bent, 26.0))
    ripple = graph.math("POWER", graph.math("ADD", 0.5, graph.math("MULTIPLY", graph.math("SINE", phase), 0.5)), 0.8)
    fades = _noise(graph, place, 0.9, 0.0)
    ripple = graph.math("MULTIPLY", ripple, fades)
    grain = _noise(graph, place, 150.0, 0.0)
    height = graph.math("ADD", ripple, graph.math("MULTIPLY", grain, 0.16))
    part = graph.math("ADD", graph.math("MULTIPLY", ripple, 0.7), graph.math("MULTIPLY", grain, 0.4))
    colour = graph.ramp(part, [(0.15, ground.other), (0.75, ground.colour)])
    normal = _bump(graph, height, 0.75, 0.05)
    return _principled(graph, Base_Color=colour, Roughness=ground.roughness, Normal=normal)


TEXTURES: dict[str, Callable[[Graph, Ground, Any], Any]] = {
    "paint": _painted,
    "wood": _wood,
    "concrete": _concrete,
    "asphalt": _asphalt,
    "sand": _sand,
}


# The floor, and what it ends in: a bend without a horizon, a wall, or the haze of the distance.

# pyright: reportAttributeAccessIssue=false
# bpy fills itself in when it is imported, its stubs are empty.


HALF, BEFORE = 14.0, -12.0
BEND, HIGH = 3.0, 14.0
OPEN = 300.0
"""How far an open ground goes, in radii."""
PLASTER = (0.58, 0.57, 0.55)


def build(scene: Any, studio: StudioSpec, bounce: float) -> Any:
    """Return one sheet around the origin under the machine's middle, its x along the picture."""
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
    mesh.materials.append(paint(look.ground, radius, haze, bounce))
    return thing


def wall(scene: Any, studio: StudioSpec) -> Any:
    """Return a wall in the plane of the motion, at which the machine hangs."""
    import bpy

    look, radius = studio.look, studio.radius
    mesh = bpy.data.meshes.new("wall")
    corners = [(a * HALF, 0.0, b * HIGH) for a, b in ((-1, 0), (1, 0), (1, 1), (-1, 1))]
    mesh.from_pydata([tuple(radius * c for c in corner) for corner in corners], [], [(0, 1, 2, 3)])
    thing = bpy.data.objects.new("wall", mesh)
    thing.location = (studio.centre[0], studio.wall or 0.0, studio.floor)
    scene.collection.objects.link(thing)
    plaster = look.wall.colour if look.wall is not None else PLASTER
    mesh.materials.append(paint(Ground(texture="paint", colour=plaster, roughness=0.7), radius))
    return thing


def _bent(away: float) -> list[tuple[float, float]]:
    """Return a profile (away, up) that bends upwards."""
    profile = [(BEFORE, 0.0), (away, 0.0)]
    for step in range(1, 33):
        angle = math.pi / 2 * step / 32
        profile.append((away + BEND * math.sin(angle), BEND * (1 - math.cos(angle))))
    return [*profile, (away + BEND, HIGH)]
