"""A section: where it cuts, what is left of the pieces, and closed solids with the volume that is below the plane."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from render.film.film import Film
from render.film.pieces import piece_specs
from render.film.section import cut_height
from render.film.solids import read_triangles
from render.glb.build import glb
from render.glb.cut import cut_open
from render.view.solid import solid
from shared.contract import read_motion, read_parts
from shared.contract.shot import Shot
from shared.stage.errors import UserError
from shared.stage.paths import ROOT
from tools.fixtures import film_fixture

CUT = """
import json, sys
import bpy, bmesh
from render.blender.scene.cut import CUT, cut_open
mesh = bpy.data.meshes.new("solid")
made = bmesh.new()
bmesh.ops.create_cone(made, cap_ends=True, segments=64, radius1=0.02, radius2=0.02, depth=0.04)
hole = bmesh.ops.create_cone(made, cap_ends=True, segments=64, radius1=0.01, radius2=0.01, depth=0.04)
bmesh.ops.reverse_faces(made, faces=list({face for vert in hole["verts"] for face in vert.link_faces}))
made.to_mesh(mesh)
cut_open(mesh, 0.005, 0.5)
seen = bmesh.new()
seen.from_mesh(mesh)
layer = seen.faces.layers.int[CUT]
print("SEEN", json.dumps({
    "volume": seen.calc_volume(signed=True),
    "open": sum(len(edge.link_faces) != 2 for edge in seen.edges),
    "top": max(vert.co.z for vert in seen.verts),
    "area": sum(face.calc_area() for face in seen.faces if face[layer]),
    "up": min(face.normal.z for face in seen.faces if face[layer]),
}))
"""


def test_a_tube_is_cut_open_and_closed_again() -> None:
    done = subprocess.run([sys.executable, "-c", CUT], cwd=ROOT, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr[-2000:]
    seen = json.loads(done.stdout.split("SEEN ")[1].splitlines()[0])
    polygon = 32 * 0.09801714032956060  # 64 / 2 sin(2 pi / 64)
    ring = polygon * (0.02**2 - 0.01**2)
    assert seen["open"] == 0
    assert seen["top"] == pytest.approx(0.005, abs=1e-8)
    assert seen["volume"] == pytest.approx(ring * 0.025, rel=1e-4)
    assert seen["area"] == pytest.approx(ring, rel=1e-4)
    assert seen["up"] > 0.999


def test_pieces_above_the_plane_go_and_those_it_meets_are_cut(out_root: Path) -> None:
    out = film_fixture.write()
    parts = read_parts(out.parts)
    every = piece_specs(parts, Shot(), out.parts_folder)
    assert all(spec.cut_above is None for spec in every)
    heights = {
        (body, name): piece.z_range for body, each in parts.bodies.items() for name, piece in each.pieces.items()
    }
    low, high = min(low for low, _ in heights.values()), max(high for _, high in heights.values())
    middle = sorted((low + high) / 2 for low, high in heights.values())[len(heights) // 2] + 1e-6
    cut = (high - middle) / (high - low)
    assert cut_height(parts, cut) == pytest.approx(middle)
    left = {(spec.body, spec.name): spec.cut_above for spec in piece_specs(parts, Shot(section=cut), out.parts_folder)}
    assert set(left) == {key for key, (bottom, _) in heights.items() if bottom < middle}
    assert len(left) < len(heights)
    for key, height in left.items():
        assert (height is not None) == (heights[key][1] > middle)


def test_the_page_has_all_parts_and_begins_with_the_section(out_root: Path) -> None:
    out = film_fixture.write(Shot(section=0.4))
    shown = solid(Film(read_motion(out.motion), read_parts(out.parts), Shot(section=0.4), out.parts_folder))
    assert shown["section"] == 0.4
    assert len(shown["pieces"]) == len(piece_specs(read_parts(out.parts), Shot(), out.parts_folder))


def test_the_glb_is_cut_open_and_closed_again(out_root: Path) -> None:
    out = film_fixture.write(Shot(section=0.3))
    parts = read_parts(out.parts)
    specs = {(spec.body, spec.name): spec for spec in piece_specs(parts, Shot(section=0.3), out.parts_folder)}
    cut = [spec for spec in specs.values() if spec.cut_above is not None]
    assert cut
    for spec in cut:
        triangles = read_triangles(Path(spec.stl))
        rest, caps = cut_open(triangles, spec)
        both = np.concatenate([rest, caps])
        assert both[..., 2].max() == pytest.approx(spec.cut_above)
        assert both[..., 2].min() == pytest.approx(triangles[..., 2].min())
        assert 0 < volume(both) < volume(triangles)
        area = np.cross(caps[:, 1] - caps[:, 0], caps[:, 2] - caps[:, 0]).sum(axis=0) / 2
        below = np.cross(rest[:, 1] - rest[:, 0], rest[:, 2] - rest[:, 0]).sum(axis=0) / 2
        assert area == pytest.approx(-below, abs=1e-9), "closed: all faces together face nowhere"
        assert area[2] > 0
    content = glb(Film(read_motion(out.motion), parts, Shot(section=0.3), out.parts_folder))
    document = json.loads(content[20 : 20 + int.from_bytes(content[12:16], "little")])
    assert sum(len(mesh["primitives"]) == 2 for mesh in document["meshes"]) == len(cut)


def volume(triangles: np.ndarray) -> float:
    """The volume within closed triangles (n, 3, 3)."""
    return float(np.einsum("ij,ij->i", triangles[:, 0], np.cross(triangles[:, 1], triangles[:, 2])).sum() / 6)


def test_a_section_that_cuts_nothing_is_refused_with_where_pieces_are() -> None:
    pieces = {"low": SimpleNamespace(z_range=(0.0, 1.0)), "high": SimpleNamespace(z_range=(2.0, 3.0))}
    parts: Any = SimpleNamespace(mechanism="press", bodies={"ground": SimpleNamespace(pieces=pieces)})
    with pytest.raises(UserError, match=r"press: shot.section = 0.5 cuts no piece open; .* are at 0\.17, 0\.83"):
        cut_height(parts, 0.5)
    assert cut_height(parts, 0.25) == pytest.approx(2.25)
    assert cut_height(parts, 0.0) is None
