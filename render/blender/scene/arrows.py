"""Arrows: a thin shaft and a cone on an empty that moves and turns them, and a ball where it begins; their lengths are
animated by scale.
"""

# pyright: reportAttributeAccessIssue=false
# bpy fills itself in when it is imported, its stubs are empty.
from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from render.blender.scene.nodes import Graph
from render.film.scene import ArrowSpec, Colour

SIDES = 32
ROUND = [(-math.cos(math.pi * k / 12), max(math.sin(math.pi * k / 12), 1e-3)) for k in range(13)]
"""Places and radii of a ball of radius 1."""
STOUT = 2.2
"""Arrows shorter than so many cones shrink as a whole."""
BALL = 1.9
"""Radius of the ball, in radii of the shaft: of arrows on one line it shows where each begins."""
BACK, NECK = 0.72, 0.3
"""How far the second point of a head lies behind the first, in lengths of it, and its radius where they meet."""
WIDE, BARB = 1.45, 0.3
"""Half width of an open head in that of a cone, and how thick its two barbs are along the arrow."""
GONE = 1e-7
"""Length (m) for Blender of an arrow that is not there: no matrix is singular."""


@dataclass
class Arrow:
    """The empty that carries the meshes."""

    root: Any
    shaft: Any
    head: Any
    ball: Any


def sizes(spec: ArrowSpec, length: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Factor of all thicknesses, and length of the shaft, for arrows of ``length`` (n,) (m); the cone is the rest."""
    factor = np.minimum(1.0, length / (STOUT * spec.point))
    return factor, length - factor * spec.point


def channels(
    arrow: Arrow, spec: ArrowSpec, tails: np.ndarray, tips: np.ndarray
) -> list[tuple[Any, str, list[np.ndarray]]]:
    """What is animated: an object, its property, and the values of its components, for tails and tips (n, 3)."""
    across = tips - tails
    length = np.hypot(across[:, 0], across[:, 1])
    there = length > 0
    angle = np.unwrap(np.arctan2(across[:, 1], across[:, 0]))
    if there.any():  # what is gone keeps the direction in which it went
        kept = np.maximum.accumulate(np.where(there, np.arange(len(there)), there.argmax()))
        angle = angle[kept]
    length = np.maximum(length, GONE)
    factor, shaft = sizes(spec, length)
    zero = np.zeros(len(length))
    return [
        (arrow.root, "location", list(tails.T)),
        (arrow.root, "rotation_euler", [zero, zero, angle]),
        (arrow.shaft, "scale", [shaft, factor * spec.shaft, factor * spec.shaft]),
        (arrow.head, "location", [shaft, zero, zero]),
        (arrow.head, "scale", [factor * spec.point, factor * spec.head, factor * spec.head]),
        (arrow.ball, "scale", [factor * BALL * spec.shaft] * 3),
    ]


def build(scene: Any, spec: ArrowSpec) -> Arrow:
    """The objects of one arrow, in ``scene``."""
    import bpy

    root = bpy.data.objects.new(f"arrow {spec.name}", None)
    root.empty_display_size = spec.head
    scene.collection.objects.link(root)
    made = paint(spec.name, spec.colour)
    things = []
    meshes = (
        _turned(f"shaft {spec.name}", [(0.0, 1.0), (1.0, 1.0)]),
        _tip(f"head {spec.name}", spec),
        _turned(f"ball {spec.name}", ROUND),
    )
    for mesh in meshes:
        mesh.materials.append(made)
        thing = bpy.data.objects.new(mesh.name, mesh)
        thing.parent = root
        thing.visible_shadow = thing.visible_diffuse = thing.visible_glossy = False
        scene.collection.objects.link(thing)
        things.append(thing)
    return Arrow(root, *things)


def _tip(name: str, spec: ArrowSpec) -> Any:
    """The head from its neck (x = 0) to its tip (x = 1), whose half width is 1 in y and z."""
    if spec.tip == "solid":
        return _turned(name, [(0.0, 1.0), (1.0, 1e-3)])
    if spec.tip == "solid double":
        return _turned(name, [(-BACK, 1.0), (BACK * NECK, NECK), (BACK * NECK, 1.0), (1.0, 1e-3)])
    thick = spec.shaft / spec.head
    prisms = [[(0.0, -thick), (0.9, -thick), (0.9, thick), (0.0, thick)]]
    for back in (0.0, BACK) if spec.tip == "open double" else (0.0,):
        outline = [(1.0, 0.0), (0.0, WIDE), (-BARB, WIDE), (1.0 - 1.6 * BARB, 0.0), (-BARB, -WIDE), (0.0, -WIDE)]
        prisms.append([(x - back, y) for x, y in outline])
    return _flat(name, prisms, thick)


def _flat(name: str, outlines: Sequence[Sequence[tuple[float, float]]], half: float) -> Any:
    """Upright prisms over outlines in the plane of the motion, from -half to half."""
    import bpy

    corners: list[tuple[float, float, float]] = []
    faces: list[tuple[int, ...]] = []
    for outline in outlines:
        of, count = len(corners), len(outline)
        corners += [(x, y, z) for z in (-half, half) for x, y in outline]
        faces += [tuple(reversed(range(of, of + count))), tuple(range(of + count, of + 2 * count))]
        faces += [(of + k, of + (k + 1) % count, of + count + (k + 1) % count, of + count + k) for k in range(count)]
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata(corners, [], faces)
    return mesh


def _turned(name: str, profile: Sequence[tuple[float, float]]) -> Any:
    """A body of revolution about x, closed at both ends, from places along x and the radii there."""
    import bpy

    turn = [math.tau * k / SIDES for k in range(SIDES)]
    rings = [(x, r * math.cos(a), r * math.sin(a)) for x, r in profile for a in turn]
    last = SIDES * (len(profile) - 1)
    faces: list[tuple[int, ...]] = [
        (of + k, of + (k + 1) % SIDES, of + SIDES + (k + 1) % SIDES, of + SIDES + k)
        for of in range(0, last, SIDES)
        for k in range(SIDES)
    ]
    faces.append(tuple(reversed(range(SIDES))))
    faces.append(tuple(range(last, last + SIDES)))
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata(rings, [], faces)
    mesh.polygons.foreach_set("use_smooth", [True] * last + [False] * 2)
    return mesh


def paint(name: str, colour: Colour) -> Any:
    """Its own light, darker towards the rim, so that it reads as round in any studio."""
    import bpy

    made = bpy.data.materials.new(f"arrow {name}")
    made.use_nodes = True
    made.cycles.emission_sampling = "NONE"
    graph = Graph(made.node_tree).clear()
    rim = graph.math("POWER", graph.add("LayerWeight", Blend=0.5).outputs["Facing"], 1.6)
    strength = graph.math("SUBTRACT", 1.0, graph.math("MULTIPLY", rim, 0.72))
    light = graph.add("Emission", Color=tuple(_linear(c) for c in colour), Strength=strength)
    graph.add("OutputMaterial", Surface=light.outputs[0])
    return made


def _linear(c: float) -> float:
    """Linear value of a colour as the picture has it (sRGB, IEC 61966-2-1)."""
    return c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4
