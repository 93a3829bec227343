"""The stencil: a card before the camera with holes where a picture is rendered. Only the camera sees it.

The plate is painted on the card, so that the denoiser finds no edge where a hole ends. A ray that meets the card costs
little, and one that passes a hole is the same as without the card. Since the lens is open, the card is blurred by the
angle c = D (1/d - 1/f) at a distance d, for an aperture D and a focus at f. So the holes are wider by half of it than
what is seen through them.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from render.film.framing import half_field
from render.film.scene import CameraPose, StudioSpec

# pyright: reportAttributeAccessIssue=false
# bpy fills itself in when it is imported, its stubs are empty.

Array = np.ndarray
BEFORE = 1.05
"""From the middle of the machine to the card, in radii of the motion."""
NEAREST = 0.3
"""Distance of the card, at least, in parts of that of the middle."""
PICTURE = "picture"
"""Name of the node with what is painted on the card."""
BEYOND = 1.2
"""Part of the picture's half width that the card covers: more than all."""


def distance_of(pose: CameraPose, studio: StudioSpec) -> float:
    """Return how far before the camera the card stands (m): before all that moves."""
    middle = math.dist(pose.position, studio.centre)
    return max(NEAREST * middle, middle - BEFORE * studio.radius)


def blur_of(pose: CameraPose, distance: float, aspect: float) -> float:
    """Return half the width of the card's blurred edges, in parts of the picture's width."""
    if pose.fstop <= 0:
        return 0.0
    aperture = pose.lens / 1000 / pose.fstop
    angle = aperture * abs(1 / distance - 1 / pose.focus)
    return angle / 2 / (2 * half_field(pose.lens, aspect)[0])


def build_stencil(scene: Any, camera: Any) -> Any:
    """Return the card without its mesh, fixed to the camera and hidden."""
    import bpy

    from render.blender.scene.materials import new_material

    paint, graph = new_material("stencil")
    window = graph.add("TexCoord").outputs["Window"]
    picture = graph.add("TexImage", {"interpolation": "Closest", "extension": "EXTEND"}, Vector=window)
    picture.name = PICTURE
    graph.add("OutputMaterial", Surface=graph.add("Emission", Color=picture.outputs["Color"]).outputs[0])
    paint.cycles.emission_sampling = "NONE"
    mesh = bpy.data.meshes.new("stencil")
    mesh.materials.append(paint)
    card = bpy.data.objects.new("stencil", mesh)
    for rays in ("diffuse", "glossy", "transmission", "volume_scatter", "shadow"):
        setattr(card, f"visible_{rays}", False)
    card.parent = camera
    card.hide_render = True
    scene.collection.objects.link(card)
    return card


def paint_stencil(card: Any, light: Array) -> None:
    """Paint the whole picture (H, W, 3), linear, on the card, the upper row first."""
    import bpy

    node = card.data.materials[0].node_tree.nodes[PICTURE]
    if node.image is not None:
        bpy.data.images.remove(node.image)
    height, width, _ = light.shape
    pixels = np.ones((height, width, 4), np.float32)
    pixels[..., :3] = light[::-1]
    node.image = bpy.data.images.new("stencil", width, height, float_buffer=True)
    node.image.pixels.foreach_set(pixels.ravel())
    node.image.update()


def cut_holes(card: Any, holes: Array, lens: float, distance: float) -> None:
    """Give the card ``holes`` (h, w), True where the picture is rendered, the upper row first."""
    corners, faces = strips(holes)
    height, width = holes.shape
    across, up = half_field(lens, width / height)
    x = (2 * corners[:, 1] / width - 1) * across * distance
    y = (1 - 2 * corners[:, 0] / height) * up * distance
    edges = (corners[:, 1] == 0) | (corners[:, 1] == width), (corners[:, 0] == 0) | (corners[:, 0] == height)
    x, y = np.where(edges[0], BEYOND * x, x), np.where(edges[1], BEYOND * y, y)
    mesh = card.data
    mesh.clear_geometry()
    mesh.from_pydata(np.column_stack([x, y, np.full(len(x), -distance)]).tolist(), [], faces.tolist())
    mesh.update()


def strips(holes: Array) -> tuple[Array, Array]:
    """Return corners (n, 2), rows and columns, and faces (m, 4) of strips that cover all but the holes."""
    closed = np.pad(~holes, ((0, 0), (1, 1)))
    edges = np.diff(closed.astype(np.int8), axis=1)
    rows, starts = np.nonzero(edges == 1)
    _, ends = np.nonzero(edges == -1)
    corners = np.stack([[rows, starts], [rows, ends], [rows + 1, ends], [rows + 1, starts]], axis=-1)
    return corners.transpose(1, 2, 0).reshape(-1, 2).astype(float), np.arange(4 * len(rows)).reshape(-1, 4)
