"""Solids that a section cuts open: what is above a height goes, and the cut faces are hatched."""

# pyright: reportAttributeAccessIssue=false
# bpy fills itself in when it is imported, its stubs are empty.
from __future__ import annotations

import zlib
from typing import Any

import numpy as np

from render.blender.scene.materials import hatched
from render.film.scene import SurfaceSpec

CUT = "cut"
"""Attribute of faces: 1 on those of the cut."""
WELDED = 1e-7
"""Corners nearer than this (m) are one."""


def cut_open(mesh: Any, height: float, sharp: float) -> None:
    """Cut away what is above ``height`` (m) and close the mesh; edges that turn by more than ``sharp`` (rad) are sharp.

    Only closed meshes are closed again, as those of parts are.
    """
    import bmesh

    cut = bmesh.new()
    cut.from_mesh(mesh)
    bmesh.ops.remove_doubles(cut, verts=cut.verts[:], dist=WELDED)
    everything = [*cut.verts, *cut.edges, *cut.faces]
    made = bmesh.ops.bisect_plane(
        cut, geom=everything, dist=WELDED, plane_co=(0, 0, height), plane_no=(0, 0, 1), clear_outer=True
    )
    rim = [part for part in made["geom_cut"] if isinstance(part, bmesh.types.BMEdge)]
    layer = cut.faces.layers.int.new(CUT)
    filled = bmesh.ops.triangle_fill(cut, edges=rim, use_beauty=True, normal=(0, 0, 1))
    for part in filled["geom"]:
        if isinstance(part, bmesh.types.BMFace):
            part[layer] = 1
            part.smooth = False
            if part.normal.z < 0:
                part.normal_flip()
    bmesh.ops.triangulate(cut, faces=[face for face in cut.faces if len(face.verts) > 3])
    cut.to_mesh(mesh)
    cut.free()
    mesh.set_sharp_from_angle(angle=sharp)


def hatch(mesh: Any, surface: SurfaceSpec, name: str, radius: float) -> None:
    """Paint the faces of the cut; lines of neighbours lean to either side, as their names have it."""
    faces = np.zeros(len(mesh.polygons), np.int32)
    mesh.attributes[CUT].data.foreach_get("value", faces)
    paints = np.zeros(len(mesh.polygons), np.int32)
    mesh.polygons.foreach_get("material_index", paints)
    mesh.materials.append(hatched(surface, f"{name} cut", radius, zlib.crc32(name.encode()) % 4))
    mesh.polygons.foreach_set("material_index", np.where(faces == 1, len(mesh.materials) - 1, paints).astype(np.int32))
