"""Sections of what moves: through planes that stand still, and of springs, ropes and belts."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

import msgspec
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from render.blender.scene.tubes import SIDES
from render.film.film import Film
from render.film.section import Cut, cuts_of
from render.film.solids import read_triangles
from render.film.tubes.stretched import helix
from render.glb.build import glb
from render.glb.cut import cut_open, front_of, pieces_of, said_of
from render.glb.tubes import Tube, below, tube
from render.view.solid import solid
from shared.contract import read_motion, read_parts
from shared.contract.shot import Section, Shot
from shared.stage.paths import ROOT, Out
from tests.render.film import test_springs
from tests.render.glb_file import GlbFile
from tools.fixtures import film_fixture

PASSES_FIXED = """
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
    done = subprocess.run([sys.executable, "-c", PASSES_FIXED], cwd=ROOT, capture_output=True, text=True, check=False)
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


def test_pieces_along_a_plane_or_cut_from_the_front_are_cut_once(out_root: Path) -> None:
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


PASSES_BETWEEN = """
import json
import bpy, bmesh
from render.blender.scene import cut, tubes
from render.film.framing import CameraPose
from render.film.scene import Scene, State, StudioSpec, SurfaceSpec, TubeSpec
from render.looks import STUDIO
surface = SurfaceSpec(colour=(0.5, 0.5, 0.5), finish="plastic", roughness=0.5)
planes = ((0.0, 0.0, 1.0, 0.0), (1.0, 0.0, 0.0, 0.05))
specs = [TubeSpec(name=name, surface=surface, radius=0.01, points=2, cut=planes) for name in ("rod", "aside")]
studio = StudioSpec(look=STUDIO, centre=(0.0, 0.0, 0.0), radius=0.2, floor=0.0, azimuth=0.0)
spec = Scene(mechanism="m", fps=30, pieces=[], trails=[], labels=[], studio=studio, tubes=specs)
aside = [(-0.3, 0.0, 0.0), (-0.2, 0.0, 0.0)]
rows = [[(0.0, y, z), (0.1, y, z)] for y, z in ((0.0, 0.0), (0.3, 0.0), (0.0, 0.05), (0.0, -0.05))]
camera = CameraPose(position=(0.0, 0.0, 1.0), azimuth=0.0, elevation=1.0, lens=50.0, focus=1.0, fstop=10.0)
states = [State(bodies={}, trails=[], labels=[], camera=camera, tubes=[row, aside]) for row in rows]
scene = bpy.context.scene
things = [tubes.build_tube(scene, each, 0.2) for each in specs]
cut.cut_tubes(scene, spec, states, things, painted=True)
seen = []
for row in rows:
    tubes.place_tube(things[0], row, 0.01)
    bpy.context.view_layer.update()
    left = things[0].evaluated_get(bpy.context.evaluated_depsgraph_get())
    made = bmesh.new()
    made.from_mesh(left.to_mesh())
    seen.append((made.calc_volume(signed=True), sum(not edge.is_manifold for edge in made.edges)))
print("SEEN", json.dumps([seen, [len(thing.modifiers) for thing in things]]))
"""


def filmed(section: Section | float) -> Film:
    plain = test_springs.film()
    return Film(plain.motion, plain.parts, msgspec.structs.replace(plain.shot, section=section), plain.folder)


def volume(shape: Tube) -> float:
    """Return the volume within a tube (m^3), by the divergence theorem."""
    a, b, c = np.moveaxis(shape[0][shape[2].reshape(-1, 3)], 1, 0)
    return float((a * np.cross(b, c)).sum() / 6)


def test_springs_and_ropes_are_cut_where_everything_that_moves_is(out_root: Path) -> None:
    whole, front = filmed(0.0), filmed(0.3)
    assert not whole.cut
    [(x, y, z, place)] = front.cut
    assert (x, y, z) == (0.0, 0.0, 1.0)
    assert {piece.cut[0][3] for piece in front.scene.pieces if piece.cut} == {place}
    assert all(spec.cut == front.cut for spec in front.scene.tubes)
    assert not filmed(Section(right=0.5)).cut, "what stands still alone is cut"
    assert not filmed(Section(front=0.3, only=("rocker",))).cut
    both = filmed(Section(front=0.3, right=0.4, fixed=True))
    assert [plane[:3] for plane in both.cut] == [(0.0, 0.0, 1.0), (1.0, 0.0, 0.0)]
    assert solid(both)["still"] == [list(plane) for plane in both.cut]
    assert said_of(both).endswith("springs, ropes and belts are whole, as the film's are not")
    assert "springs" not in said_of(front)
    assert (front_of(front), front_of(both), front_of(whole)) == (place, np.inf, np.inf)


def test_the_file_ends_at_the_plane(out_root: Path) -> None:
    whole, film = (GlbFile(glb(filmed(section))) for section in (0.0, 0.3))
    place = filmed(0.3).cut[0][3]
    for read, top in ((whole, np.inf), (film, place)):
        matrices, heights = read.matrices(0.2), []
        for name in (name for name in read.nodes if name.startswith("spring")):
            for primitive in read.json["meshes"][read.nodes[name]["mesh"]]["primitives"]:
                points = read.array(primitive["attributes"]["POSITION"])
                corners = np.unique(read.array(primitive["indices"]))
                world = points[corners] @ matrices[name][:3, :3].T + matrices[name][:3, 3]
                heights.append(world[:, 1].max())  # y is up there
        assert max(heights) < top + 1e-7
    assert len(whole.nodes) >= len(film.nodes)


@given(st.floats(-1.5, 1.5))
def test_a_level_tube_is_cut_to_the_segment_of_its_circle(part: float) -> None:
    radius, long = 0.01, 0.2
    made = tube(np.array([[0.0, 0.0, 0.03], [long / 3, 0.0, 0.03], [long, 0.0, 0.03]]), radius)
    left = below(made, 0.03 + part * radius)
    d = np.clip(part, -1.0, 1.0)
    area = radius**2 * (np.pi - np.arccos(d) + d * np.sqrt(1 - d * d))
    assert volume(left) == pytest.approx(area * long, abs=0.12 * np.pi * radius**2 * long)
    assert len(left[2]) or part < -0.97
    assert below(made, 1.0)[2].tolist() == made[2].tolist()


def test_an_upright_tube_is_shorter_and_a_coil_is_halved() -> None:
    made = tube(np.array([[0.0, 0, 0], [0, 0, 0.1]]), 0.01)
    area = SIDES / 2 * np.sin(2 * np.pi / SIDES) * 0.01**2
    assert volume(below(made, 0.04)) == pytest.approx(0.04 * area, rel=1e-5)
    assert not len(below(made, -0.01)[2])
    coil = tube(helix(np.zeros(3), np.array([0.2, 0.0, 0.0]), 0.02, 8), 0.003)
    half = below(coil, 0.0)
    assert volume(half) == pytest.approx(volume(coil) / 2, rel=0.03)
    assert half[0][half[2]][:, 2].max() <= 0.0


def test_blender_cuts_a_tube_in_every_state_and_leaves_alone_what_is_never_beyond() -> None:
    done = subprocess.run([sys.executable, "-c", PASSES_BETWEEN], cwd=ROOT, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr[-2000:]
    rows, modifiers = json.loads(done.stdout.split("SEEN ")[1].splitlines()[0])
    area = SIDES / 2 * np.sin(2 * np.pi / SIDES) * 0.01**2
    assert [row[0] for row in rows] == pytest.approx([part * area * 0.1 for part in (0.75, 0.75, 0.5, 1.0)], rel=1e-4)
    assert all(row[1] == 0 for row in rows)
    assert modifiers == [1, 0]
