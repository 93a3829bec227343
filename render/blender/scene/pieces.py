"""Pieces in Blender: meshes, worked edges and labels."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from render.blender.scene.cut import cut_open, hatch
from render.blender.scene.materials import EDGE, WORN, flat, ink, material
from render.film.scene import Colour, LabelSpec, PieceSpec, SurfaceSpec
from render.film.solids import MILLIMETRE

# Traces of tools in the faces of a solid: chamfers, whose edges wear, and engraving, which is filled with paint.

# pyright: reportAttributeAccessIssue=false
# bpy fills itself in when it is imported, its stubs are empty.


Array = np.ndarray
SLOPE = 0.4, 0.93
"""Height of a chamfer's unit normal."""
DEPTH = 0.00015, 0.0007
"""How deep engraving is (m)."""
LEVEL = 0.999
"""Height of the unit normal of a level face."""


def mark_chamfers(mesh: Any) -> None:
    """Set the attribute EDGE to 1 on chamfers, which slope between top and wall and end at a sharp edge."""
    sharp = np.zeros(len(mesh.edges), bool)
    mesh.attributes["sharp_edge"].data.foreach_get("value", sharp)
    edges = np.empty(len(mesh.loops), np.int32)
    mesh.loops.foreach_get("edge_index", edges)
    slope = np.abs(_normals(mesh)[:, 2])
    ends = sharp[edges].reshape(-1, 3).any(axis=1)
    marks = (ends & (slope > SLOPE[0]) & (slope < SLOPE[1])).astype(np.float32)
    mesh.attributes.new(EDGE, "FLOAT", "FACE").data.foreach_set("value", marks)


def engraved(mesh: Any) -> Array:
    """Return (n,) True for triangles that are floor or wall of an engraving in the largest level face."""
    places = np.empty((len(mesh.vertices), 3), np.float32)
    mesh.vertices.foreach_get("co", places.ravel())
    corners = np.empty(len(mesh.loops), np.int32)
    mesh.loops.foreach_get("vertex_index", corners)
    heights = places[corners, 2].reshape(-1, 3)
    areas = np.empty(len(mesh.polygons), np.float32)
    mesh.polygons.foreach_get("area", areas)
    return sunk(heights, _normals(mesh)[:, 2], areas)


def sunk(heights: Array, up: Array, areas: Array) -> Array:
    """Return (n,) True for triangles of what is cut a little into the largest level face: floors and walls.

    ``heights`` (n, 3) are those of the corners (m), ``up`` (n,) those of the unit normals.
    """
    level = up > LEVEL
    if not level.any():
        return np.zeros(len(up), bool)
    steps, which = np.unique(np.round(heights[level, 0], 5), return_inverse=True)
    top = steps[np.bincount(which, areas[level]).argmax()]
    deep = top - heights
    floor = level & (deep > DEPTH[0]).all(axis=1) & (deep < DEPTH[1]).all(axis=1)
    wall = (np.abs(up) < 1 - LEVEL) & (deep > -1e-5).all(axis=1) & (deep < DEPTH[1]).all(axis=1)
    return floor | (wall & floor.any())


def _normals(mesh: Any) -> Array:
    normals = np.empty((len(mesh.polygons), 3), np.float32)
    mesh.polygon_normals.foreach_get("vector", normals.ravel())
    return normals


# Short texts that float over joints and face the camera.

# pyright: reportAttributeAccessIssue=false
# bpy fills itself in when it is imported, its stubs are empty.


def build_label(scene: Any, label: LabelSpec) -> Any:
    """Return the text object; its place and rotation are animated."""
    import bpy

    curve = bpy.data.curves.new(f"label {label.text}", "FONT")
    curve.body = label.text
    curve.size = label.size
    curve.align_x = "CENTER"
    curve.align_y = "BOTTOM"
    curve.materials.append(flat(label.colour, f"label {label.text}"))
    thing = bpy.data.objects.new(curve.name, curve)
    thing.visible_shadow = thing.visible_diffuse = thing.visible_glossy = False
    scene.collection.objects.link(thing)
    return thing


# Bodies and their solids: an empty per body that the motion moves, the meshes fixed to it.

# pyright: reportAttributeAccessIssue=false
# bpy fills itself in when it is imported, its stubs are empty.


LIGHT = 0.3
"""Brightest channel of a surface on which dark paint reads."""
SHARP = math.radians(32)
"""Edges that turn by more stay sharp; the facets of round walls are smoothed."""


def build_pieces(
    scene: Any,
    pieces: list[PieceSpec],
    radius: float,
    only_flat: dict[str, Colour] | None = None,
    solids: dict[str, Any] | None = None,
) -> dict[str, Any]:
    """Load every piece; return the empties of bodies and of pieces that turn against theirs.

    ``radius`` is that of the swept motion (m). The pieces themselves are put into ``solids``, by ``body/piece``.

    With ``only_flat`` just those pieces, in one flat colour.
    """
    from mathutils import Matrix

    bodies: dict[str, Any] = {}
    paints: dict[SurfaceSpec, Any] = {}
    inks: dict[bool, Any] = {}
    for piece in pieces:
        name = f"{piece.body}/{piece.name}"
        carrier = piece.body if piece.turns_about is None else name
        if carrier not in bodies:
            bodies[carrier] = _empty(scene, carrier)
        if only_flat is not None and name not in only_flat:
            continue
        solid = _load(piece.stl, name)
        solid.parent = bodies[carrier]
        if solids is not None:
            solids[name] = solid
        if piece.cut and not piece.fixed:
            cut_open(solid.data, piece.cut, SHARP)
        if piece.turns_about is not None:
            x, y = piece.turns_about
            solid.data.transform(Matrix.Translation((-x, -y, 0.0)))
        if only_flat is not None:
            paint = flat(only_flat[name], name)
        else:
            paint = paints.get(piece.surface) or material(piece.surface, name, radius)
            paints[piece.surface] = paint
            if piece.surface.finish in WORN:
                mark_chamfers(solid.data)
        solid.data.materials.clear()
        solid.data.materials.append(paint)
        if only_flat is None:
            _fill_engraving(solid.data, piece.surface, inks)
            if piece.cut and not piece.fixed:
                hatch(solid.data, piece.surface, name, radius, piece.cut)
    return bodies


def _fill_engraving(mesh: Any, surface: SurfaceSpec, inks: dict[bool, Any]) -> None:
    """Paint in what is engraved: light on dark metal, dark on light."""
    faces = engraved(mesh)
    if faces.any():
        dark = max(surface.colour) < LIGHT
        if dark not in inks:
            inks[dark] = ink(dark)
        mesh.materials.append(inks[dark])
        mesh.polygons.foreach_set("material_index", faces.astype(np.int32))


def _empty(scene: Any, name: str) -> Any:
    import bpy

    thing = bpy.data.objects.new(name, None)
    thing.empty_display_size = 0.01
    scene.collection.objects.link(thing)
    return thing


def _load(path: str, name: str) -> Any:
    import bpy

    bpy.ops.wm.stl_import(filepath=path, global_scale=MILLIMETRE, use_scene_unit=False, forward_axis="Y", up_axis="Z")
    solid = bpy.context.active_object
    solid.name = solid.data.name = name
    # The importer scales the object; the mesh itself shall be in metres, for textures and bevels alike.
    solid.data.transform(solid.matrix_world)
    solid.matrix_world.identity()
    solid.data.polygons.foreach_set("use_smooth", [True] * len(solid.data.polygons))
    solid.data.set_sharp_from_angle(angle=SHARP)
    return solid
