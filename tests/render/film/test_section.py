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
from render.film.scene import PieceSpec
from render.film.section import Cut, cuts_of
from render.film.solids import read_triangles
from render.glb.build import glb
from render.glb.cut import cut_open
from render.view.solid import solid
from shared.contract import read_motion, read_parts
from shared.contract.shot import Section, Shot, read_shot, write_shot
from shared.stage.errors import UserError
from shared.stage.paths import ROOT, Out
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
cut_open(mesh, json.loads(sys.argv[1]), 0.5)
seen = bmesh.new()
seen.from_mesh(mesh)
layer = seen.faces.layers.int[CUT]
print("SEEN", json.dumps({
    "volume": seen.calc_volume(signed=True),
    "open": sum(len(edge.link_faces) != 2 for edge in seen.edges),
    "top": max(vert.co.z for vert in seen.verts),
    "areas": [sum(face.calc_area() for face in seen.faces if face[layer] == k) for k in (1, 2)],
    "normals": [list(face.normal) for face in seen.faces if face[layer]],
    "inside": [list(face.calc_center_median()) for face in seen.faces],
}))
"""


RING = 32 * 0.09801714032956060 * (0.02**2 - 0.01**2)
"""Volume of the tube, a polygon of 64 sides: 64 / 2 sin(2 pi / 64) (R^2 - r^2)."""


def tube(*planes: tuple[float, float, float, float]) -> dict[str, Any]:
    """Return the part that Blender leaves of a tube along z, 40 mm long, of radii 10 and 20 mm.

    It stands about the origin.
    """
    command = [sys.executable, "-c", CUT, json.dumps(planes)]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr[-2000:]
    return json.loads(done.stdout.split("SEEN ")[1].splitlines()[0])


def test_a_tube_is_cut_open_and_closed_again() -> None:
    seen = tube((0.0, 0.0, 1.0, 0.005))
    assert seen["open"] == 0
    assert seen["top"] == pytest.approx(0.005, abs=1e-8)
    assert seen["volume"] == pytest.approx(RING * 0.025, rel=1e-4)
    assert seen["areas"][0] == pytest.approx(RING, rel=1e-4)
    assert min(z for _, _, z in seen["normals"]) > 0.999


def test_a_quarter_of_a_tube_is_cut_away() -> None:
    """Between two planes through its axis, and of a corner that a third plane leaves."""
    seen = tube((1.0, 0.0, 0.0, 0.0), (0.0, -1.0, 0.0, 0.0))
    assert seen["volume"] == pytest.approx(0.75 * RING * 0.04, rel=1e-4)
    assert seen["areas"] == pytest.approx([0.01 * 0.04, 0.01 * 0.04], rel=1e-4)
    faces = [normal for normal in seen["normals"] if any(normal)]  # those of no area have none
    assert all(abs(x - 1) < 1e-3 or abs(y + 1) < 1e-3 for x, y, _ in faces)
    assert not any(x > 1e-6 and y < -1e-6 for x, y, _ in seen["inside"])
    corner = tube((1.0, 0.0, 0.0, 0.0), (0.0, 0.0, 1.0, 0.01))
    assert corner["volume"] == pytest.approx(RING * 0.04 - RING / 2 * 0.01, rel=1e-4)
    assert corner["areas"] == pytest.approx([2 * 0.01 * 0.01, RING / 2], rel=1e-4)


def test_pieces_above_the_plane_go_and_those_it_meets_are_cut(out_root: Path) -> None:
    out = film_fixture.write()
    parts = read_parts(out.parts)
    every = piece_specs(parts, Shot(), out.parts_folder)
    assert all(not spec.cut for spec in every)
    heights = {
        (body, name): piece.z_range for body, each in parts.bodies.items() for name, piece in each.pieces.items()
    }
    low, high = min(low for low, _ in heights.values()), max(high for _, high in heights.values())
    middle = sorted((low + high) / 2 for low, high in heights.values())[len(heights) // 2] + 1e-6
    cut = (high - middle) / (high - low)
    left = {(spec.body, spec.name): spec.cut for spec in piece_specs(parts, Shot(section=cut), out.parts_folder)}
    assert set(left) == {key for key, (bottom, _) in heights.items() if bottom < middle}
    assert len(left) < len(heights)
    for key, planes in left.items():
        assert bool(planes) == (heights[key][1] > middle)
        assert all(plane == pytest.approx((0.0, 0.0, 1.0, middle)) for plane in planes)


def test_the_page_has_all_parts_and_begins_with_the_section(out_root: Path) -> None:
    out = film_fixture.write(Shot(section=0.4))
    shown = solid(Film(read_motion(out.motion), read_parts(out.parts), Shot(section=0.4), out.parts_folder))
    assert shown["section"] == 0.4
    assert len(shown["pieces"]) == len(piece_specs(read_parts(out.parts), Shot(), out.parts_folder))


def test_the_glb_is_cut_open_and_closed_again(out_root: Path) -> None:
    out = film_fixture.write(Shot(section=0.3))
    parts = read_parts(out.parts)
    specs = {(spec.body, spec.name): spec for spec in piece_specs(parts, Shot(section=0.3), out.parts_folder)}
    cut = [spec for spec in specs.values() if spec.cut]
    assert cut
    for spec in cut:
        triangles = read_triangles(Path(spec.stl))
        rest, [caps] = cut_open(triangles, spec)
        both = np.concatenate([rest, caps])
        assert both[..., 2].max() == pytest.approx(spec.cut[0][3])
        assert both[..., 2].min() == pytest.approx(triangles[..., 2].min())
        assert 0 < volume(both) < volume(triangles)
        area = np.cross(caps[:, 1] - caps[:, 0], caps[:, 2] - caps[:, 0]).sum(axis=0) / 2
        below = np.cross(rest[:, 1] - rest[:, 0], rest[:, 2] - rest[:, 0]).sum(axis=0) / 2
        assert area == pytest.approx(-below, abs=1e-9), "closed: all faces together face nowhere"
        assert area[2] > 0
    content = glb(Film(read_motion(out.motion), parts, Shot(section=0.3), out.parts_folder))
    document = json.loads(content[20 : 20 + int.from_bytes(content[12:16], "little")])
    assert sum(len(mesh["primitives"]) == 3 for mesh in document["meshes"]) == len(cut)


def volume(triangles: np.ndarray) -> float:
    """The volume within closed triangles (n, 3, 3)."""
    return float(np.einsum("ij,ij->i", triangles[:, 0], np.cross(triangles[:, 1], triangles[:, 2])).sum() / 6)


def test_a_section_that_cuts_nothing_is_refused_with_where_pieces_are() -> None:
    pieces = {
        "low": SimpleNamespace(z_range=(0.0, 1.0), stl="", rolls=None),
        "high": SimpleNamespace(z_range=(2.0, 3.0), stl="", rolls=None),
    }
    parts: Any = SimpleNamespace(mechanism="press", bodies={"ground": SimpleNamespace(pieces=pieces)})
    with pytest.raises(UserError, match=r"press: shot.section = 0.5 cuts no piece open; .* are at 0\.17, 0\.83"):
        cuts_of(parts, 0.5, Path(), None)
    with pytest.raises(UserError, match=r"press: shot.section = front=0.5 cuts .* at 0\.17, 0\.83 from front"):
        cuts_of(parts, Section(front=0.5), Path(), None)
    assert cuts_of(parts, 0.25, Path(), None) == {
        ("ground", "high"): Cut(((0.0, 0.0, 1.0, pytest.approx(2.25)),))  # pyright: ignore[reportArgumentType]
    }
    assert cuts_of(parts, 0.0, Path(), None) == {}
    del parts.bodies["ground"]
    parts.bodies["arm"] = SimpleNamespace(pieces=pieces)
    with pytest.raises(UserError, match=r"ground has no solids; name bodies in section.only: arm"):
        cuts_of(parts, Section(right=0.5), Path(), None)


def specs_of(out: Out, section: Section) -> dict[tuple[str, str], PieceSpec]:
    made = piece_specs(read_parts(out.parts), Shot(section=section), out.parts_folder, read_motion(out.motion))
    return {(spec.body, spec.name): spec for spec in made}


def test_from_the_side_what_stands_still_is_cut(out_root: Path) -> None:
    out = film_fixture.write()
    specs = specs_of(out, Section(right=0.25, above=0.5))
    assert {body for (body, _), spec in specs.items() if spec.cut} == {"ground"}
    box = read_triangles(Path(specs["ground", "base"].stl)).reshape(-1, 3)
    low, high = box.min(axis=0), box.max(axis=0)
    right, above = specs["ground", "base"].cut
    assert right == pytest.approx((1.0, 0.0, 0.0, high[0] - 0.25 * (high[0] - low[0])))
    assert above == pytest.approx((0.0, 1.0, 0.0, (low[1] + high[1]) / 2))


def test_a_body_that_is_named_is_cut_as_it_stands_at_the_start(out_root: Path) -> None:
    out = film_fixture.write()
    motion = read_motion(out.motion)
    specs = specs_of(out, Section(above=0.5, only=("rocker/rocker",)))
    assert [key for key, spec in specs.items() if spec.cut] == [("rocker", "rocker")]
    (x, y, z, place), moved = specs["rocker", "rocker"].cut[0], motion.bodies["rocker"]
    theta = moved.theta[0]
    c, s = np.cos(theta), np.sin(theta)
    assert (c * x - s * y, s * x + c * y, z) == pytest.approx((0.0, 1.0, 0.0), abs=1e-12)
    corners = read_triangles(Path(specs["rocker", "rocker"].stl)).reshape(-1, 3)
    heights = moved.y[0] + corners @ np.array([s, c, 0.0])
    assert place + moved.y[0] == pytest.approx((heights.min() + heights.max()) / 2)


def test_a_quarter_goes_from_the_glb_and_the_rest_is_closed(out_root: Path) -> None:
    out = film_fixture.write()
    spec = specs_of(out, Section(right=0.5, above=0.5))["ground", "base"]
    triangles = read_triangles(Path(spec.stl))
    rest, [right, above] = cut_open(triangles, spec)
    caps = np.concatenate([right, above])
    assert volume(np.concatenate([rest, caps])) == pytest.approx(0.75 * volume(triangles))
    faces = np.cross(caps[:, 1] - caps[:, 0], caps[:, 2] - caps[:, 0])
    areas = faces.sum(axis=0) / 2
    box = np.ptp(triangles.reshape(-1, 3), axis=0)
    assert areas == pytest.approx([box[1] / 2 * box[2], box[0] / 2 * box[2], 0.0], rel=1e-6, abs=1e-12)


def test_the_page_has_the_planes_of_each_piece_that_the_film_cuts(out_root: Path) -> None:
    out = film_fixture.write()
    motion, parts, shot = read_motion(out.motion), read_parts(out.parts), Shot(section=Section(front=0.2, right=0.5))
    shown = solid(Film(motion, parts, shot, out.parts_folder))
    specs = specs_of(out, shot.section)  # pyright: ignore[reportArgumentType]
    assert shown["sawn"]
    for piece in shown["pieces"]:
        key = piece["body"], piece["name"]
        assert piece.get("gone", False) == (key not in specs)
        if key in specs:
            assert [tuple(plane) for plane in piece.get("cut", [])] == list(specs[key].cut)
    assert not solid(Film(motion, parts, Shot(section=0.4), out.parts_folder))["sawn"]


def test_named_pieces_of_a_section_exist_and_sides_fit_together(tmp_path: Path, out_root: Path) -> None:
    out = film_fixture.write()
    motion, parts = read_motion(out.motion), read_parts(out.parts)
    for shot, words in (
        (Shot(section=Section(front=0.5, only=("crnk",))), r"section.only\[0\] names 'crnk'.*crank"),
        (Shot(transparent=("ground/bse",)), r"transparent\[0\] names 'ground/bse'.*ground/base"),
    ):
        with pytest.raises(UserError, match=words):
            Film(motion, parts, shot, out.parts_folder)
    with pytest.raises(UserError, match="cuts from right and from left"):
        write_shot(tmp_path / "shot.json", Shot(section=Section(right=0.5, left=0.5)))
    with pytest.raises(UserError, match="cuts from no side"):
        write_shot(tmp_path / "shot.json", Shot(section=Section(only=("crank",))))
    write_shot(tmp_path / "shot.json", Shot(section=Section(above=0.5, front=0.5, only=("crank",))))
    assert read_shot(tmp_path / "shot.json").section == Section(above=0.5, front=0.5, only=("crank",))


def test_a_transparent_piece_is_glass_of_its_tint(out_root: Path) -> None:
    out = film_fixture.write()
    parts = read_parts(out.parts)
    plain, seen = (
        {(spec.body, spec.name): spec.surface for spec in piece_specs(parts, shot, out.parts_folder)}
        for shot in (Shot(), Shot(transparent=("ground", "crank/start")))
    )
    assert {key for key, surface in seen.items() if surface.finish == "glass"} == {
        ("ground", "base"),
        ("crank", "start"),
    }
    for key, surface in seen.items():
        if surface.finish == "glass":
            assert min(surface.colour) >= 0.4
            assert np.argmax(surface.colour) == np.argmax(plain[key].colour)
