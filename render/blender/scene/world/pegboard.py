"""A wall of pegboard with tools on it: screwdrivers, spanners, a try square, a hammer, a rule."""

# pyright: reportAttributeAccessIssue=false
# bpy fills itself in when it is imported, its stubs are empty.
from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

from render.blender.scene.materials import new_material
from render.blender.scene.world.ground import glow
from render.blender.scene.world.painted_light import Lamp, Shine, painted
from render.blender.scene.world.shapes import Thing
from render.looks.look import Colour

PITCH, HOLE = 0.135, 0.026
WIDE, HIGH = 9.0, 6.0
BESIDE = 0.2
"""From the machine to the first tool on each side."""
STEEL, BLACK = (0.125, 0.128, 0.132), (0.03, 0.03, 0.032)
RED, AMBER = (0.40, 0.035, 0.02), (0.62, 0.30, 0.03)
BATTEN, ASH = (0.42, 0.27, 0.14), (0.50, 0.33, 0.17)
AROUND = 0.12
"""Light on the tools that comes from no lamp."""


def build(thing: Thing, colour: Colour, away: float, clear: float, bounce: float, lamps: Sequence[Lamp]) -> None:
    """The wall at y = ``away`` from the floor up, the origin of ``thing`` at the floor; tools hang beside ``clear``.

    Only the eye sees the tools, so far off their light is not missed; that of ``lamps``, in the axes of ``thing``, is
    painted on them: rays from them took a tenth of a frame. ``bounce``: see Light in render/looks/look.py.
    """
    board = _board(colour, thing.radius, bounce)
    thing.box((-WIDE, away, 0.10), (WIDE, away + 0.05, HIGH), board, 0.0)
    thing.box((-WIDE, away - 0.03, 0.0), (WIDE, away + 0.05, 0.13), _paint(BATTEN), 0.006)
    thing.seen_only = True
    front = away - 0.05
    radius, left, right = thing.radius, -clear - BESIDE, clear + BESIDE

    def paint(colour: Colour, x: float, z: float, shine: Shine | None = None) -> Any:
        return painted("tool", colour, lamps, (x * radius, front * radius, z * radius), AROUND, shine)

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
    """Painted hardboard; its holes are black."""
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
    """Mat paint: what runs along the whole wall meets most of the light that bounces, so it mirrors nothing."""
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
