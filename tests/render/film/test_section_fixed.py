"""A section whose planes stand still while bodies move through them: another cut at every moment, and closed."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from render.film.film import Film
from render.film.section import Cut, cuts_of
from render.film.solids import read_triangles
from render.glb.cut import cut_open, pieces_of, said_of
from render.view.solid import solid
from shared.contract import read_motion, read_parts
from shared.contract.shot import Section, Shot
from shared.stage.paths import ROOT, Out
from tools.fixtures import film_fixture

PASSES = """
import json, math
import bpy, bmesh
from render.blender.scene.cut import cut_in_passing
from render.film.scene import PieceSpec, Scene, StudioSpec, SurfaceSpec
from render.looks import STUDIO
scene = bpy.context.scene
mesh = bpy.data.meshes.new("solid")
made = bmesh.new()
bmesh.ops.create_cube(made, size=0.04)
made.to_mesh(mesh)
mesh.materials.append(bpy.data.materials.new("own"))
solid = bpy.data.objects.new("arm/arm", mesh)
scene.collection.objects.link(solid)
surface = SurfaceSpec(colour=(0.5, 0.5, 0.5), finish="plastic", roughness=0.5)
piece = PieceSpec(body="arm", name="arm", stl="", sha256="", surface=surface, fixed=True,
                  cut=((1.0, 0.0, 0.0, 0.1), (0.0, 0.0, 1.0, 0.0)))
studio = StudioSpec(look=STUDIO, centre=(0.0, 0.0, 0.0), radius=0.2, floor=0.0, azimuth=0.0)
spec = Scene(mechanism="m", fps=30, pieces=[piece], trails=[], labels=[], studio=studio)
cut_in_passing(scene, spec, {"arm/arm": solid}, painted=True)
rows = []
for x, turn in ((0.05, 0.0), (0.09, 0.0), (0.1, math.pi / 4), (0.2, 0.0)):
    solid.location.x, solid.rotation_euler.z = x, turn
    bpy.context.view_layer.update()
    seen = solid.evaluated_get(bpy.context.evaluated_depsgraph_get())
    made = bmesh.new()
    made.from_mesh(seen.to_mesh())
    names = [slot.material.name for slot in seen.material_slots]
    areas = {}
    for face in made.faces:
        areas[names[face.material_index]] = areas.get(names[face.material_index], 0.0) + face.calc_area()
    rows.append((made.calc_volume(signed=True), sum(not edge.is_manifold for edge in made.edges), areas))
print("SEEN", json.dumps(rows))
"""


def film_of(out: Out, section: Section) -> Film:
    return Film(read_motion(out.motion), read_parts(out.parts), Shot(section=section), out.parts_folder)


def cuts(out: Out, section: Section) -> dict[tuple[str, str], Cut]:
    return cuts_of(read_parts(out.parts), section, out.parts_folder, read_motion(out.motion))


def test_blender_cuts_what_passes_at_every_moment_and_closes_it() -> None:
    """A cube of 40 mm that goes through the corner of two planes: x = 0.1 and z = 0, with a cut face along each."""
    done = subprocess.run([sys.executable, "-c", PASSES], cwd=ROOT, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr[-2000:]
    whole, part, turned, beyond = json.loads(done.stdout.split("SEEN ")[1].splitlines()[0])
    assert all(row[1] == 0 for row in (whole, part, turned, beyond))
    assert whole[0] == pytest.approx(0.04**3, rel=1e-5)
    assert set(whole[2]) == {"own"}
    assert part[0] == pytest.approx(0.04**3 - 0.01 * 0.04 * 0.02, rel=1e-5)
    assert part[2]["arm/arm cut 1"] == pytest.approx(0.04 * 0.02, rel=1e-4)
    assert part[2]["arm/arm cut 2"] == pytest.approx(0.01 * 0.04, rel=1e-4)
    assert turned[0] == pytest.approx(0.75 * 0.04**3, rel=1e-5)
    assert turned[2]["arm/arm cut 1"] == pytest.approx(0.04 * 2**0.5 * 0.02, rel=1e-4)
    assert beyond[0] == pytest.approx(0.04**3 / 2, rel=1e-5)


def test_planes_are_parts_of_the_whole_motion_and_all_bodies_are_cut(out_root: Path) -> None:
    out = film_fixture.write()
    made = cuts(out, Section(right=0.3, fixed=True))
    assert {body for (body, _), cut in made.items() if cut.fixed} == {"crank", "coupler", "rocker"} & {
        body for body, _ in made
    }
    assert not made["ground", "base"].fixed
    places = {plane[3] for cut in made.values() for plane in cut.planes}
    assert len(places) == 1
    motion, reach = read_motion(out.motion), []
    for body, solids in read_parts(out.parts).bodies.items():
        poses = motion.bodies.get(body)
        for piece in solids.pieces.values():
            corners = read_triangles(out.parts_folder / piece.stl).reshape(-1, 3)
            for k in range(0, len(motion.time), 3):
                x, turn = (poses.x[k], poses.theta[k]) if poses else (0.0, 0.0)
                along = x + corners @ np.array([np.cos(turn), -np.sin(turn), 0.0])
                reach += [along.min(), along.max()]
    assert places.pop() == pytest.approx(max(reach) - 0.3 * np.ptp(reach), abs=1e-4)


def test_what_moves_along_a_plane_or_is_cut_from_the_front_is_cut_once(out_root: Path) -> None:
    out = film_fixture.write()
    assert not any(cut.fixed for cut in cuts(out, Section(front=0.4, fixed=True)).values())
    parts, motion = read_parts(out.parts), read_motion(out.motion)
    coupler = motion.bodies["coupler"]
    coupler.theta = [0.2] * len(motion.time)  # it goes along x now, and another plane meets it at every moment
    coupler.y = [0.1] * len(motion.time)
    only = ("coupler",)
    assert not any(
        cut.fixed
        for cut in cuts_of(parts, Section(above=0.5, only=only, fixed=True), out.parts_folder, motion).values()
    )
    across = cuts_of(parts, Section(right=0.5, only=only, fixed=True), out.parts_folder, motion)
    assert across["coupler", "coupler"].fixed
    assert not across["coupler", "coupler"].gone


def test_files_of_meshes_are_cut_as_they_start_and_say_of_whom(out_root: Path) -> None:
    out = film_fixture.write()
    film = film_of(out, Section(right=0.5, fixed=True))
    assert all(not piece.fixed for piece in pieces_of(film))
    moving = sorted({piece.body for piece in film.scene.pieces if piece.fixed})
    assert moving
    assert said_of(film).startswith("four_bar: ")
    assert all(body in said_of(film) for body in moving)
    assert said_of(film_of(out, Section(front=0.5))) == ""
    [place] = {plane[3] for piece in film.scene.pieces if piece.fixed for plane in piece.cut}
    for piece in pieces_of(film):
        triangles = read_triangles(Path(piece.stl))
        if piece.cut:
            rest, [cap] = cut_open(triangles, piece)
            assert len(cap)
            triangles = np.concatenate([rest, cap])
        x, _, theta = film.poses.body(piece.body, film.clock.moment(0))
        world = x + triangles.reshape(-1, 3) @ np.array([np.cos(theta), -np.sin(theta), 0.0])
        assert world.max() < place + 1e-7


def test_the_page_keeps_the_planes_in_the_world(out_root: Path) -> None:
    out = film_fixture.write()
    film = film_of(out, Section(right=0.5, fixed=True))
    sawn = {(piece["body"], piece["name"]): piece for piece in solid(film)["pieces"] if "cut" in piece}
    for piece in film.scene.pieces:
        if piece.cut:
            record = sawn[piece.body, piece.name]
            assert record["fixed"] == piece.fixed
            assert [tuple(plane) for plane in record["cut"]] == list(piece.cut)
