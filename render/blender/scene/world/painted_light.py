"""Things far behind the machine with their light painted on: worked out from the lamps, without a ray.

A lamp of power P and unit axis n_l that a face of unit normal n sees at the distance d along l gives

    E = P (n . l)+ (-n_l . l)+ / (pi d^2),    radiance = colour E / pi

and a lamp with a grid that times Cycles' fall-off (tan(spread / 2) - tan(angle))+ / (tan(spread / 2) - spread / 2).
Nothing stands between, and what shines is a lobe around the mirror's direction (Phong 1975, Comm. ACM 18, 311).
"""

# pyright: reportAttributeAccessIssue=false
# bpy fills itself in when it is imported, its stubs are empty.
from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any, NamedTuple

from render.blender.scene.materials import new_material
from render.blender.scene.nodes import Graph
from render.looks.look import Colour

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
    """What a face mirrors."""

    strength: float
    """How bright the lobe is against what is matt."""
    sharp: float = 12.0
    """The lobe is the cosine from the mirror's direction to this power."""
    room: tuple[float, float] | None = None
    """Heights (m) between which the room that is mirrored grows lighter, as behind a bench below a lamp."""


def painted(name: str, colour: Colour, lamps: Sequence[Lamp], ambient: float, shine: Shine | None = None) -> Any:
    """A material of a matt ``colour`` under ``lamps`` and light from all around (radiance of white)."""
    made, graph = new_material(name)
    made.cycles.emission_sampling = "NONE"
    coordinates = graph.add("TexCoord")
    place, normal = coordinates.outputs["Object"], coordinates.outputs["Normal"]
    mirrored = _mirrored(graph, normal) if shine else None
    light: Any = (ambient,) * 3
    for lamp in lamps:
        to_lamp = graph.vector("SUBTRACT", lamp.place, place)
        unit = graph.vector("NORMALIZE", to_lamp)
        strength = _strength(graph, lamp, to_lamp, unit)
        lit = graph.math("MAXIMUM", _dot(graph, normal, unit), 0.0)
        if shine is not None:
            lobe = graph.math("POWER", graph.math("MAXIMUM", _dot(graph, mirrored, unit), 0.0), shine.sharp)
            lit = graph.math("MULTIPLY_ADD", lobe, shine.strength, lit)
        light = graph.vector("MULTIPLY_ADD", lamp.colour, graph.math("MULTIPLY", lit, strength), light)
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


def _strength(graph: Graph, lamp: Lamp, to_lamp: Any, unit: Any) -> Any:
    """E / (pi n . l) of a lamp."""
    square = _dot(graph, to_lamp, to_lamp)
    cosine = graph.math("MAXIMUM", graph.math("MULTIPLY", _dot(graph, unit, lamp.axis), -1.0), 1e-4)
    falling = graph.math("DIVIDE", graph.math("MULTIPLY", cosine, lamp.power / math.pi**2), square)
    if lamp.spread >= WIDE:
        return falling
    half = math.radians(lamp.spread) / 2.0
    sine = graph.math("SQRT", graph.math("MULTIPLY_ADD", graph.math("MULTIPLY", cosine, -1.0), cosine, 1.0))
    left = graph.math("MAXIMUM", graph.math("SUBTRACT", math.tan(half), graph.math("DIVIDE", sine, cosine)), 0.0)
    return graph.math("MULTIPLY", falling, graph.math("MULTIPLY", left, 1.0 / (math.tan(half) - half)))


def _mirrored(graph: Graph, normal: Any) -> Any:
    """The direction from which the eye sees a mirror of this normal shine."""
    along = graph.math("MULTIPLY", _dot(graph, normal, TOWARDS_EYE), 2.0)
    return graph.vector("SUBTRACT", graph.vector("SCALE", normal, Scale=along), TOWARDS_EYE)


def _dot(graph: Graph, a: Any, b: Any) -> Any:
    node = graph.add("VectorMath", {"operation": "DOT_PRODUCT"})
    for index, value in enumerate((a, b)):
        graph.set(node, index, value)
    return node.outputs["Value"]
