"""Arrows and arcs of forces and torques in Blender."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from render.blender.scene.materials import Graph
from render.film.scene import ArcSpec, ArrowSpec, Colour, Point, across_axes
from shared.contract.parts import Z

# Arrows: a thin shaft and a cone on an empty that moves and turns them, and a ball where it begins; their lengths are
# animated by scale.

# pyright: reportAttributeAccessIssue=false
# bpy fills itself in when it is imported, its stubs are empty.


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
    """Return the factor of all thicknesses and the length of the shaft, for arrows of ``length`` (n,) (m).

    The cone is the rest.

    """
    factor = np.minimum(1.0, length / (STOUT * spec.point))
    return factor, length - factor * spec.point


def channels(
    arrow: Arrow, spec: ArrowSpec, tails: np.ndarray, tips: np.ndarray
) -> list[tuple[Any, str, list[np.ndarray]]]:
    """Return the animated channels for tails and tips (n, 3): object, property, values of its components."""
    across = tips - tails
    length = np.linalg.norm(across, axis=1)
    there = length > 0
    turned = turns_from_x(across)
    if there.any():  # what is gone keeps the direction in which it went
        kept = np.maximum.accumulate(np.where(there, np.arange(len(there)), there.argmax()))
        turned = turned[kept]
    length = np.maximum(length, GONE)
    factor, shaft = sizes(spec, length)
    zero = np.zeros(len(length))
    return [
        (arrow.root, "location", list(tails.T)),
        (arrow.root, "rotation_quaternion", list(going_on(turned).T)),
        (arrow.shaft, "scale", [shaft, factor * spec.shaft, factor * spec.shaft]),
        (arrow.head, "location", [shaft, zero, zero]),
        (arrow.head, "scale", [factor * spec.point, factor * spec.head, factor * spec.head]),
        (arrow.ball, "scale", [factor * BALL * spec.shaft] * 3),
    ]


def turns_from_x(ways: np.ndarray) -> np.ndarray:
    """Return unit quaternions (n, 4) of the shortest turns of the x axis to directions (n, 3); in a plane about z."""
    length = np.linalg.norm(ways, axis=1)
    out = np.stack([length + ways[:, 0], 0 * length, -ways[:, 2], ways[:, 1]], axis=1)
    out[np.linalg.norm(out, axis=1) <= 1e-9 * length] = (0.0, 0.0, 0.0, 1.0)
    out[length == 0.0] = (1.0, 0.0, 0.0, 0.0)
    return out / np.linalg.norm(out, axis=1, keepdims=True)


def going_on(turned: np.ndarray) -> np.ndarray:
    """Return the same rotations as quaternions (n, 4), each with the sign nearer to the one before."""
    flips = np.where((turned[1:] * turned[:-1]).sum(axis=1) < 0.0, -1.0, 1.0)
    return turned * np.cumprod(np.concatenate([[1.0], flips]))[:, None]


def build_arrow(scene: Any, spec: ArrowSpec) -> Arrow:
    """Return the objects of one arrow, in ``scene``."""
    import bpy

    root = bpy.data.objects.new(f"arrow {spec.name}", None)
    root.empty_display_size = spec.head
    root.rotation_mode = "QUATERNION"
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
    """Return the head from its neck (x = 0) to its tip (x = 1), whose half width is 1 in y and z."""
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
    """Return upright prisms over outlines in the plane of the motion, from -half to half."""
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
    """Return a body of revolution about x, closed at both ends, from places along x and the radii there."""
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
    """Return its own light, darker towards the rim, so that it reads as round in any studio."""
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
    """Return linear value of a colour as the picture has it (sRGB, IEC 61966-2-1)."""
    return c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4


# Curved arrows: a thin tube round a pivot with a cone at its end, a mesh whose vertices follow the sweep.

# pyright: reportAttributeAccessIssue=false
# bpy fills itself in when it is imported, its stubs are empty.


ARC_SIDES = 24
RINGS = 64
"""Number of rings of the tube; two more are the cone."""
FRONT = -math.pi / 2
"""Angle (rad) of the middle of every arc: towards the camera."""


def build_arc(scene: Any, spec: ArcSpec) -> Any:
    """Return the mesh object, whose vertices :func:`place_arc` moves."""
    import bpy

    mesh = bpy.data.meshes.new(f"arc {spec.name}")
    sides, ends = arc_faces()
    mesh.from_pydata([(0.0, 0.0, 0.0)] * ((RINGS + 2) * ARC_SIDES), [], [*sides, *ends])
    smooth = np.arange(len(sides) + len(ends)) < len(sides)
    smooth[(RINGS - 1) * ARC_SIDES : RINGS * ARC_SIDES] = False  # behind the cone
    mesh.polygons.foreach_set("use_smooth", smooth)
    mesh.materials.append(paint(spec.name, spec.colour))
    thing = bpy.data.objects.new(mesh.name, mesh)
    thing.visible_shadow = thing.visible_diffuse = thing.visible_glossy = False
    scene.collection.objects.link(thing)
    return thing


def arc_faces() -> tuple[list[tuple[int, ...]], list[tuple[int, ...]]]:
    """Return numbers of the vertices of each face: round the tube and its cone, and at the two ends."""
    around: list[tuple[int, ...]] = []
    for ring in range(RINGS + 1):
        for side in range(ARC_SIDES):
            a, b = ring * ARC_SIDES + side, ring * ARC_SIDES + (side + 1) % ARC_SIDES
            around.append((a, b, b + ARC_SIDES, a + ARC_SIDES))
    last = (RINGS + 1) * ARC_SIDES
    return around, [tuple(reversed(range(ARC_SIDES))), tuple(range(last, last + ARC_SIDES))]


def arc_vertices(spec: ArcSpec, centre: Point, sweep: float, axis: Point = Z) -> np.ndarray:
    """Return vertices ((RINGS + 2) * SIDES, 3), float32, of an arc of ``sweep`` (rad) about ``centre`` (m).

    Its middle is at FRONT; arcs shorter than STOUT cones shrink as a whole.
    """
    length = max(abs(sweep) * spec.radius, GONE)
    factor = min(1.0, length / (STOUT * spec.point))
    way = math.copysign(1.0, sweep)
    start, end = FRONT - sweep / 2, FRONT + sweep / 2
    neck = end - way * min(factor * spec.point, 0.9 * length) / spec.radius
    angle = np.concatenate([np.linspace(start, neck, RINGS), [neck, end]])
    thick = factor * np.concatenate([np.full(RINGS, spec.shaft), [spec.head, 1e-3 * spec.head]])
    x, y = (axes[0] for axes in across_axes(np.array([axis])))
    out = np.cos(angle)[:, None] * x + np.sin(angle)[:, None] * y
    turn = -way * math.tau * np.arange(ARC_SIDES) / ARC_SIDES  # faces look outwards whichever way it goes
    rim = np.cos(turn)[None, :, None] * out[:, None] + np.sin(turn)[None, :, None] * np.array(axis)
    tube = np.asarray(centre) + spec.radius * out[:, None] + thick[:, None, None] * rim
    return tube.reshape(-1, 3).astype(np.float32)


def place_arc(thing: Any, spec: ArcSpec, centre: Point, sweep: float, axis: Point = Z) -> None:
    """Let the arc reach ``sweep`` (rad) round ``centre`` about ``axis``; it is not there where that is 0."""
    thing.data.vertices.foreach_set("co", arc_vertices(spec, centre, sweep, axis).ravel())
    thing.data.update()
