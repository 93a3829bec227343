"""Solids that a section cuts open: what is beyond all its planes goes, and the cut faces are hatched."""

# pyright: reportAttributeAccessIssue=false
# bpy fills itself in when it is imported, its stubs are empty.
from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from render.blender.scene.materials import hatched
from render.film.hatches import hatch_of
from render.film.scene import Plane, SurfaceSpec

CUT = "cut"
"""Attribute of faces: k on those of the cut along the k-th plane, counted from 1."""
WELDED = 1e-7
"""Corners nearer than this (m) are one."""


def cut_open(mesh: Any, planes: Sequence[Plane], sharp: float) -> None:
    """Cut away what is beyond all planes and close the mesh; edges that turn by more than ``sharp`` (rad) are sharp.

    Only closed meshes are closed again, as those of parts are.
    """
    import bmesh

    cut = bmesh.new()
    cut.from_mesh(mesh)
    bmesh.ops.remove_doubles(cut, verts=cut.verts[:], dist=WELDED)
    caps = [_cap(cut, planes, k) for k in range(len(planes))]
    for plane in planes:
        _bisected(cut, plane)
    gone = [face for face in cut.faces if all(_beyond(face.calc_center_median(), plane) for plane in planes)]
    bmesh.ops.delete(cut, geom=gone, context="FACES")
    layer = cut.faces.layers.int.new(CUT)
    for k, triangles in enumerate(caps, 1):
        for corners in triangles:
            face = cut.faces.new([cut.verts.new(corner) for corner in corners])
            face[layer] = k
    bmesh.ops.remove_doubles(cut, verts=cut.verts[:], dist=WELDED)
    bmesh.ops.triangulate(cut, faces=[face for face in cut.faces if len(face.verts) > 3])
    cut.to_mesh(mesh)
    cut.free()
    mesh.set_sharp_from_angle(angle=sharp)


def _cap(solid: Any, planes: Sequence[Plane], k: int) -> list[list[Any]]:
    """Corners of the triangles that close the k-th plane, as far as they are beyond all others."""
    import bmesh

    cap, normal = solid.copy(), planes[k][:3]
    made = _bisected(cap, planes[k], clear_outer=True)
    rim = [part for part in made["geom_cut"] if isinstance(part, bmesh.types.BMEdge)]
    filled = bmesh.ops.triangle_fill(cap, edges=rim, use_beauty=True, normal=normal)
    kept = {part for part in filled["geom"] if isinstance(part, bmesh.types.BMFace)}
    bmesh.ops.delete(cap, geom=[face for face in cap.faces if face not in kept], context="FACES")
    for other in (plane for j, plane in enumerate(planes) if j != k):
        _bisected(cap, other, clear_inner=True)
    bmesh.ops.triangulate(cap, faces=cap.faces[:])
    cap.normal_update()
    out = []
    for face in cap.faces:
        corners = [vert.co.copy() for vert in face.verts]
        out.append(corners if sum(a * b for a, b in zip(face.normal, normal, strict=True)) > 0 else corners[::-1])
    cap.free()
    return out


def _bisected(mesh: Any, plane: Plane, clear_outer: bool = False, clear_inner: bool = False) -> Any:
    import bmesh

    x, y, z, place = plane
    return bmesh.ops.bisect_plane(
        mesh, geom=[*mesh.verts, *mesh.edges, *mesh.faces], dist=WELDED, plane_co=(x * place, y * place, z * place),
        plane_no=(x, y, z), clear_outer=clear_outer, clear_inner=clear_inner,
    )  # fmt: skip


def _beyond(point: Any, plane: Plane) -> bool:
    return sum(a * b for a, b in zip(point, plane[:3], strict=True)) > plane[3] + WELDED / 10


def hatch(mesh: Any, surface: SurfaceSpec, name: str, radius: float, planes: Sequence[Plane]) -> None:
    """Paint the faces of the cut; lines of neighbours lean to either side, as their names have it."""
    faces = np.zeros(len(mesh.polygons), np.int32)
    mesh.attributes[CUT].data.foreach_get("value", faces)
    paints = np.zeros(len(mesh.polygons), np.int32)
    mesh.polygons.foreach_get("material_index", paints)
    for k, plane in enumerate(planes, 1):
        mesh.materials.append(hatched(surface, f"{name} cut {k}", radius, hatch_of(name, plane)))
        paints = np.where(faces == k, len(mesh.materials) - 1, paints)
    mesh.polygons.foreach_set("material_index", paints.astype(np.int32))
