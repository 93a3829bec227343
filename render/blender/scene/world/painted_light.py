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


def painted(
    name: str, colour: Colour, lamps: Sequence[Lamp], at: Vector3, ambient: float, shine: Shine | None = None
) -> Any:
    """A material of a matt ``colour`` under ``lamps`` as seen from ``at``, and ``ambient`` light from all around."""
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
    """The direction of a lamp from a place, and E / (pi n . l) there."""
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
    """The direction from which the eye sees a mirror of this normal shine."""
    along = graph.math("MULTIPLY", _dot(graph, normal, TOWARDS_EYE), 2.0)
    return graph.vector("SUBTRACT", graph.vector("SCALE", normal, Scale=along), TOWARDS_EYE)


def _dot(graph: Graph, a: Any, b: Any) -> Any:
    node = graph.add("VectorMath", {"operation": "DOT_PRODUCT"})
    for index, value in enumerate((a, b)):
        graph.set(node, index, value)
    return node.outputs["Value"]
