"""The workbench of a scene: pegboard, vice, and their shapes."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from render.blender.scene.materials import new_material
from render.blender.scene.world.ground import glow
from render.blender.scene.world.lights import Lamp, Shine, painted
from render.looks import Colour

# Boxes, rods and outlines with rounded edges, from which the things of a workshop are put together. In radii.

# pyright: reportAttributeAccessIssue=false
# bpy fills itself in when it is imported, its stubs are empty.


Corner = tuple[float, float, float]
AROUND = 32
"""Corners of a round."""


class Thing:
    """Solids under one origin; ``radius`` scales radii to metres."""

    def __init__(self, scene: Any, name: str, radius: float, place: Any, azimuth: float) -> None:
        import bpy

        self.scene, self.radius = scene, radius
        self.seen_only = False
        """True if light that bounces passes through what is added from now on."""
        self.root = bpy.data.objects.new(name, None)
        self.root.location = place
        self.root.rotation_euler = (0.0, 0.0, azimuth)
        scene.collection.objects.link(self.root)

    def box(self, low: Corner, high: Corner, paint: Any, bevel: float = 0.008) -> None:
        """Add an upright box between two corners."""
        (x0, y0, z0), (x1, y1, z1) = low, high
        self.outline([(x0, y0), (x1, y0), (x1, y1), (x0, y1)], z0, z1, paint, bevel)

    def outline(self, around: Sequence[tuple[float, float]], low: float, high: float, paint: Any, bevel: float) -> None:
        """Add a prism over a counter-clockwise outline (x, y), from ``low`` to ``high``."""
        self._solid([[(x, y, z) for x, y in around] for z in (low, high)], paint, bevel)

    def hung(self, around: Sequence[tuple[float, float]], front: float, back: float, paint: Any, bevel: float) -> None:
        """Add a prism over an outline (x, z), from ``front`` to ``back`` in y."""
        self._solid([[(x, y, z) for x, z in around] for y in (back, front)], paint, bevel)

    def rod(self, start: Corner, end: Corner, widths: Sequence[tuple[float, float]], paint: Any) -> None:
        """Add a turned rod; ``widths`` are (part of its length, radius) from start to end."""
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
        """Add rings of as many corners each, closed at both ends."""
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


# A bench vice: cast body and sliding jaw, steel cheeks, a screw with its bar.

ENAMEL, VICE_STEEL = (0.030, 0.073, 0.064), (0.10, 0.102, 0.106)
VICE_LIGHT = 0.04
"""Light that comes from no lamp."""


def build_vice(thing: Thing, lamps: Sequence[Lamp], scale: float = 1.0) -> None:
    """Build a vice on the floor at the origin of ``thing``, its screw towards -y.

    It is 0.5 wide and 0.45 high at scale 1. ``lamps`` are in the axes of ``thing``; their light is painted on it, as
    lights.py has it.
    """
    middle = (0.0, 0.0, 0.25 * scale * thing.radius)
    enamel = painted("enamel", ENAMEL, lamps, middle, VICE_LIGHT, Shine(0.9, 20.0))
    steel = painted("cheek", VICE_STEEL, lamps, middle, VICE_LIGHT, Shine(5.0, 9.0))

    def box(low: Any, high: Any, paint: Any, bevel: float) -> None:
        thing.box(tuple(scale * c for c in low), tuple(scale * c for c in high), paint, scale * bevel)

    def rod(start: Any, end: Any, widths: list[tuple[float, float]], paint: Any) -> None:
        turned = [(part, scale * r) for part, r in widths]
        thing.rod(tuple(scale * c for c in start), tuple(scale * c for c in end), turned, paint)

    rod((0, 0.06, 0.0), (0, 0.06, 0.09), [(0, 0.21), (0.6, 0.21), (0.75, 0.19), (1, 0.15)], enamel)
    for x, y in ((-0.165, 0.06), (0.165, 0.06)):
        rod((x, y, 0.05), (x, y, 0.085), [(0, 0.026), (0.9, 0.026), (1, 0.02)], steel)
    box((-0.105, -0.06, 0.085), (0.105, 0.25, 0.24), enamel, 0.03)
    box((-0.18, 0.05, 0.20), (0.18, 0.17, 0.40), enamel, 0.022)
    box((-0.17, 0.012, 0.315), (0.17, 0.052, 0.405), steel, 0.004)
    box((-0.075, -0.34, 0.10), (0.075, 0.0, 0.215), enamel, 0.02)
    box((-0.18, -0.19, 0.19), (0.18, -0.085, 0.40), enamel, 0.022)
    box((-0.17, -0.086, 0.315), (0.17, -0.048, 0.405), steel, 0.004)
    rod(
        (0, -0.33, 0.155),
        (0, -0.43, 0.155),
        [(0, 0.058), (0.3, 0.058), (0.35, 0.045), (0.92, 0.045), (1, 0.036)],
        steel,
    )
    rod((-0.20, -0.40, 0.235), (0.17, -0.40, 0.07), [(0, 0.016), (1, 0.016)], steel)
    for place, other in (((-0.20, -0.40, 0.235), (-0.225, -0.40, 0.246)), ((0.17, -0.40, 0.07), (0.195, -0.40, 0.059))):
        rod(place, other, [(0, 0.02), (0.2, 0.03), (0.8, 0.03), (1, 0.02)], steel)


# A wall of pegboard with tools on it: screwdrivers, spanners, a try square, a hammer, a rule.

# pyright: reportAttributeAccessIssue=false
# bpy fills itself in when it is imported, its stubs are empty.


PITCH, HOLE = 0.135, 0.026
WIDE, HIGH = 9.0, 6.0
BESIDE = 0.2
"""From the machine to the first tool on each side."""
STEEL, BLACK = (0.125, 0.128, 0.132), (0.03, 0.03, 0.032)
RED, AMBER = (0.40, 0.035, 0.02), (0.62, 0.30, 0.03)
BATTEN, ASH = (0.42, 0.27, 0.14), (0.50, 0.33, 0.17)
TOOL_LIGHT = 0.12
"""Light on the tools that comes from no lamp."""


def build_pegboard(
    thing: Thing, colour: Colour, away: float, clear: float, bounce: float, lamps: Sequence[Lamp]
) -> None:
    """Build the wall at y = ``away``, with the origin of ``thing`` at the floor.

    Tools hang beside ``clear``. Only the eye sees the tools, so far off their light is not missed. That of ``lamps``,
    in the axes of ``thing``, is painted on them: rays from them took a tenth of a frame. ``bounce``: see Light in
    render/looks.py.
    """
    board = _board(colour, thing.radius, bounce)
    thing.box((-WIDE, away, 0.10), (WIDE, away + 0.05, HIGH), board, 0.0)
    thing.box((-WIDE, away - 0.03, 0.0), (WIDE, away + 0.05, 0.13), _paint(BATTEN), 0.006)
    thing.seen_only = True
    front = away - 0.05
    radius, left, right = thing.radius, -clear - BESIDE, clear + BESIDE

    def paint(colour: Colour, x: float, z: float, shine: Shine | None = None) -> Any:
        return painted("tool", colour, lamps, (x * radius, front * radius, z * radius), TOOL_LIGHT, shine)

    metal, plastic = Shine(7.0, 9.0, (0.85 * radius, 1.75 * radius)), Shine(0.25)
    for k in range(4):
        x = left - 0.22 * k
        grip = paint((RED, AMBER)[k % 2], x, 1.4, plastic)
        _screwdriver(thing, x, front, 1.56 + 0.02 * k, 0.335 + 0.055 * k, paint(STEEL, x, 1.1, metal), grip)
    _square(thing, left - 1.5, front, 1.02, paint(STEEL, left - 1.5, 1.3, metal), paint(ASH, left - 1.3, 1.6))
    for k, x in enumerate((0.0, 0.20, 0.38, 0.54, 0.68)):
        steel = paint(STEEL, right + x, 1.3, metal)
        _spanner(thing, right + x, front, 1.66, 0.78 - 0.09 * k, 0.072 - 0.008 * k, steel)
    x = right + 1.23
    _hammer(thing, x, front, 1.55, paint(STEEL, x, 1.5, metal), paint(ASH, x, 1.0), paint(BLACK, x, 1.4))


def _board(colour: Colour, radius: float, bounce: float) -> Any:
    """Return painted hardboard; its holes are black."""
    made, graph = new_material("pegboard")
    made.cycles.emission_sampling = "NONE"
    place = graph.add("TexCoord").outputs["Object"]
    cell = graph.vector("MULTIPLY", place, (1 / (PITCH * radius), 0.0, 1 / (PITCH * radius)))
    middle = graph.vector("SUBTRACT", graph.vector("FRACTION", cell), (0.5, 0.0, 0.5))
    apart = graph.add("VectorMath", {"operation": "LENGTH"}, Vector=middle).outputs["Value"]
    solid = graph.add(
        "MapRange", {"interpolation_type": "SMOOTHSTEP"}, Value=apart,
        From_Min=0.9 * HOLE / PITCH, From_Max=1.1 * HOLE / PITCH, To_Min=0.16,
    )  # fmt: skip
    shade = graph.vector("SCALE", colour, Scale=solid.outputs[0])
    shader = graph.add("BsdfDiffuse", Color=shade)
    surface = graph.mixed("Is Camera Ray", glow(graph, colour, bounce), shader.outputs[0])
    graph.add("OutputMaterial", Surface=surface)
    return made


def _paint(colour: Colour) -> Any:
    """Return matt paint that mirrors nothing, since the whole wall meets most of the light that bounces."""
    made, graph = new_material("batten")
    graph.add("OutputMaterial", Surface=graph.add("BsdfDiffuse", Color=colour).outputs[0])
    return made


def _screwdriver(thing: Thing, x: float, y: float, top: float, length: float, steel: Any, grip: Any) -> None:
    handle = 0.30
    thing.rod(
        (x, y, top),
        (x, y, top - handle),
        [(0, 0.03), (0.05, 0.048), (0.2, 0.056), (0.6, 0.05), (0.8, 0.036), (0.9, 0.046), (1, 0.03)],
        grip,
    )
    thing.rod((x, y, top - handle), (x, y, top - handle - length), [(0, 0.016), (0.9, 0.016), (1, 0.010)], steel)


def _spanner(thing: Thing, x: float, y: float, top: float, length: float, head: float, steel: Any) -> None:
    """Open at the lower end, a ring at the upper."""
    neck = 0.42 * head
    low = top - length
    shank = [(x - neck, low + head), (x + neck, low + head), (x + neck, top - head), (x - neck, top - head)]
    thing.hung(shank, y - 0.012, y + 0.012, steel, 0.006)
    around = [(x + head * math.cos(a), top - head + head * math.sin(a)) for a in _angles(0.0, math.tau, 24)[:-1]]
    thing.hung(around, y - 0.02, y + 0.02, steel, 0.006)
    jaw = [(x + 1.1 * head * math.cos(a), low + 1.1 * head * math.sin(a)) for a in _angles(-0.9, math.pi + 0.9, 20)]
    mouth = [
        (x - 0.5 * head, low - 0.35 * head),
        (x - 0.5 * head, low + 0.2 * head),
        (x + 0.5 * head, low + 0.2 * head),
    ]
    thing.hung([*jaw, *mouth, (x + 0.5 * head, low - 0.35 * head)], y - 0.02, y + 0.02, steel, 0.004)


def _square(thing: Thing, x: float, y: float, low: float, steel: Any, wood: Any) -> None:
    thing.hung([(x, low), (x + 0.09, low), (x + 0.09, low + 0.55), (x, low + 0.55)], y - 0.006, y + 0.006, steel, 0.002)
    thing.hung(
        [(x, low + 0.53), (x + 0.46, low + 0.53), (x + 0.46, low + 0.66), (x, low + 0.66)],
        y - 0.035,
        y + 0.035,
        wood,
        0.01,
    )


def _hammer(thing: Thing, x: float, y: float, top: float, steel: Any, wood: Any, black: Any) -> None:
    thing.rod((x, y, top), (x, y, top - 1.05), [(0, 0.03), (0.3, 0.028), (0.6, 0.038), (0.95, 0.042), (1, 0.034)], wood)
    thing.rod(
        (x - 0.21, y, top),
        (x + 0.03, y, top),
        [(0, 0.075), (0.06, 0.082), (0.3, 0.082), (0.42, 0.055), (1, 0.06)],
        steel,
    )
    peen = [(x, top - 0.062), (x + 0.20, top - 0.03), (x + 0.20, top + 0.035), (x, top + 0.062)]
    thing.hung(peen, y - 0.055, y + 0.055, steel, 0.012)
    for side in (-0.1, 0.1):
        thing.rod((x + side, y + 0.06, top - 0.1), (x + side, y - 0.07, top - 0.1), [(0, 0.012), (1, 0.012)], black)


def _angles(start: float, end: float, count: int) -> list[float]:
    return [start + (end - start) * k / (count - 1) for k in range(count)]
