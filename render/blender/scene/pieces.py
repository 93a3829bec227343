"""Bodies and their solids: an empty per body that the motion moves, the meshes fixed to it."""

# pyright: reportAttributeAccessIssue=false
# bpy fills itself in when it is imported, its stubs are empty.
from __future__ import annotations

import math
from typing import Any

import numpy as np

from render.blender.scene.cut import cut_open, hatch
from render.blender.scene.materials import WORN, flat, ink, material
from render.blender.scene.worked import engraved, mark_chamfers
from render.film.scene import Colour, PieceSpec, SurfaceSpec
from render.film.solids import MILLIMETRE

LIGHT = 0.3
"""Brightest channel of a surface on which dark paint reads."""
SHARP = math.radians(32)
"""Edges that turn by more stay sharp; the facets of round walls are smoothed."""


def build(
    scene: Any,
    pieces: list[PieceSpec],
    radius: float,
    only_flat: dict[str, Colour] | None = None,
    solids: dict[str, Any] | None = None,
) -> dict[str, Any]:
    """Load every piece; returns the empties that carry them: of bodies, and of pieces that turn against theirs.

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
