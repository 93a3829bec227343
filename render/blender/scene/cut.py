"""Sections in Blender: pieces that are cut, and pieces that pass through the plane."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from render.blender.scene.materials import hatched
from render.film.scene import PieceSpec, Plane, Point, Scene, State, StudioSpec, SurfaceSpec, TubeSpec
from render.film.section import hatch_of
from shared.stage.errors import UserError

# Solids that a section cuts open: what is beyond all its planes goes, and the cut faces are hatched.

# pyright: reportAttributeAccessIssue=false
# bpy fills itself in when it is imported, its stubs are empty.


CUT = "cut"
"""Attribute of faces: k on those of the cut along the k-th plane, counted from 1."""
WELDED = 1e-7
"""Corners nearer than this (m) are one."""


def cut_open(mesh: Any, planes: Sequence[Plane], sharp: float) -> None:
    """Cut away what is beyond all planes and close the mesh.

    Edges that turn by more than ``sharp`` (rad) are sharp. Only closed meshes are closed again, as those of parts are.
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
    """Return corners of the triangles that close the k-th plane, as far as they are beyond all others."""
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


# Bodies that move through planes that stand still: Blender cuts them anew at every moment, also in a saved scene.
#
# The room beyond all planes is a box, for sides of a section are along axes; it is taken from each solid by a boolean
# modifier, which leaves the box's faces, with their paint, as the cut faces.

# pyright: reportAttributeAccessIssue=false
# bpy fills itself in when it is imported, its stubs are empty.


BEYOND = 4.0
"""How far a box reaches beyond all that moves, in radii."""


def cut_in_passing(scene: Any, spec: Scene, solids: dict[str, Any], painted: bool) -> None:
    """Cut the ``solids`` (by ``body/piece``) of pieces whose planes are fixed.

    ``painted`` hatches the cut faces. Raises UserError for one that is not closed.
    """
    reach = math.hypot(*spec.studio.centre) + BEYOND * spec.studio.radius
    for piece in spec.pieces:
        name = f"{piece.body}/{piece.name}"
        if piece.fixed and name in solids:
            _close(solids[name], name)
            paints = _paints(piece, name, spec.studio) if painted else []
            _take_away(solids[name], _box(scene, f"{name} cut", piece.cut, reach, paints), painted)


def cut_tubes(scene: Any, spec: Scene, states: Sequence[State], tubes: Sequence[Any], painted: bool) -> None:
    """Cut the ``tubes`` of a scene as far as they are beyond their planes in any state."""
    reach = math.hypot(*spec.studio.centre) + BEYOND * spec.studio.radius
    boxes: dict[SurfaceSpec, Any] = {}
    for k, (tube, thing) in enumerate(zip(spec.tubes, tubes, strict=True)):
        if not tube.cut or not _ever_beyond([state.tubes[k] for state in states], tube):
            continue
        if tube.surface not in boxes:
            paints = [
                hatched(tube.surface, f"{tube.name} cut {j}", spec.studio.radius, hatch_of(tube.name, plane), True)
                for j, plane in enumerate(tube.cut if painted else (), 1)
            ]
            boxes[tube.surface] = _box(scene, f"{tube.name} cut", tube.cut, reach, paints)
        _take_away(thing, boxes[tube.surface], painted)


def _ever_beyond(paths: Sequence[Sequence[Point]], tube: TubeSpec) -> bool:
    """Return True if any of it is beyond all planes along any of these paths."""
    points = np.array(paths).reshape(-1, 3)
    far = [points @ np.array(plane[:3]) > plane[3] - tube.radius for plane in tube.cut]
    return bool(np.all(far, axis=0).any())


def _paints(piece: PieceSpec, name: str, studio: StudioSpec) -> list[Any]:
    return [
        hatched(piece.surface, f"{name} cut {k}", studio.radius, hatch_of(name, plane), fixed=True)
        for k, plane in enumerate(piece.cut, 1)
    ]


def _take_away(solid: Any, box: Any, painted: bool) -> None:
    cut = solid.modifiers.new("section", "BOOLEAN")
    cut.operation, cut.solver, cut.object = "DIFFERENCE", "MANIFOLD", box
    cut.material_mode = "TRANSFER" if painted else "INDEX"
    solid.cycles.use_deform_motion = False  # its triangles are others in every frame


def _box(scene: Any, name: str, planes: Sequence[Plane], reach: float, paints: list[Any]) -> Any:
    """Return the box beyond all planes; its k-th face lies along the k-th plane."""
    import bmesh
    import bpy

    low, high = [-reach] * 3, [reach] * 3
    for *normal, place in planes:
        axis = max(range(3), key=lambda axis: abs(normal[axis]))
        ends = low if normal[axis] > 0 else high
        ends[axis] = place * normal[axis]
    made, mesh = bmesh.new(), bpy.data.meshes.new(name)
    bmesh.ops.create_cube(made, size=1.0)
    for corner in made.verts:
        corner.co = [high[axis] if corner.co[axis] > 0 else low[axis] for axis in range(3)]
    made.normal_update()
    for face in made.faces:
        turned = [sum(a * b for a, b in zip(face.normal, plane[:3], strict=True)) for plane in planes]
        face.material_index = turned.index(min(turned)) if paints else 0
    made.to_mesh(mesh)
    made.free()
    for paint in paints:
        mesh.materials.append(paint)
    box = bpy.data.objects.new(name, mesh)
    box.hide_render = box.hide_viewport = True
    scene.collection.objects.link(box)
    return box


def _close(solid: Any, name: str) -> None:
    """Weld corners that are one, as those of an STL may not be.

    Raises UserError if the solid is open nevertheless.
    """
    import bmesh

    mesh = bmesh.new()
    mesh.from_mesh(solid.data)
    if any(not edge.is_manifold for edge in mesh.edges):
        bmesh.ops.remove_doubles(mesh, verts=mesh.verts[:], dist=WELDED)
        if any(not edge.is_manifold for edge in mesh.edges):
            raise UserError(f"piece {name} is not closed, so no section can cut it; make the parts again")
        mesh.to_mesh(solid.data)
    mesh.free()
