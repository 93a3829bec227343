"""The GLB read back by another program: bodies, belts, springs and hatches are where the film has them."""

from __future__ import annotations

import math
from pathlib import Path

import msgspec
import numpy as np
import pytest
import trimesh

from mbsd import Mechanism, constant_rate
from mechanisms.stages.solve.motion_file import to_motion
from render import glb
from render.blender.scene.tubes import SIDES
from render.film.film import Film
from render.film.poses import Moment, Poses
from render.film.scene import TubeSpec
from render.film.section import LIGHT, Hatch, dark_of, hatch_of, light_of
from render.film.solids import read_triangles
from render.film.tubes.belts import Belt, belts
from render.glb import build
from render.glb.cut import along_rim, faces_of, pieces_of, striped
from render.glb.document import Animation, Document, Paints, smooth
from render.glb.tubes import add_belt
from shared.contract import Held, mounted, read_motion, read_parts
from shared.contract.materials import MATERIALS
from shared.contract.shot import Section, Shot
from shared.stage.errors import UserError
from shared.stage.paths import Out
from tests.render.film import test_springs
from tests.render.film.test_belts import drive, filmed
from tests.render.glb_file import GlbFile
from tools.fixtures import film_fixture


@pytest.fixture
def out(out_root: Path) -> Out:
    out = film_fixture.write()
    glb.run("four_bar")
    return out


def test_every_body_is_where_data_json_has_it(out: Out) -> None:
    read, motion = GlbFile(out.glb.read_bytes()), read_motion(out.motion)
    corner = np.array([0.1, 0.02, 0.03, 1.0])  # a point of each body, 0.1 m from its frame
    for k in [*range(0, len(motion.time), 7), len(motion.time) - 1]:
        matrices = read.matrices(motion.time[k])
        for name, body in motion.bodies.items():
            c, s = math.cos(body.theta[k]), math.sin(body.theta[k])
            x, y = body.x[k] + c * corner[0] - s * corner[1], body.y[k] + s * corner[0] + c * corner[1]
            assert matrices[name] @ corner == pytest.approx([x, corner[2], -y, 1.0], abs=1e-5)  # glTF's y is up
        assert matrices["ground"] @ corner == pytest.approx([0.1, 0.03, -0.02, 1.0], abs=1e-6)


def test_between_samples_it_is_as_near(out: Out) -> None:
    read, motion = GlbFile(out.glb.read_bytes()), read_motion(out.motion)
    for k in (10, 100, 299):
        t = (motion.time[k] + motion.time[k + 1]) / 2
        place = read.matrices(t)["coupler"] @ np.array([0.0, 0.0, 0.0, 1.0])
        angle = 2 * math.pi * t
        assert place[:3] == pytest.approx([0.04 * math.cos(angle), 0.0, -0.04 * math.sin(angle)], abs=1e-5)


@pytest.mark.parametrize("gravity", [(0.0, 0.0), (0.0, -9.81), (3.0, 4.0)])
def test_the_upward_axis_is_y(out_root: Path, gravity: tuple[float, float]) -> None:
    """On a desk z, else the direction against gravity; the normal of a plane that stands comes towards the viewer."""
    mount = mounted(gravity)
    written = film_fixture.write(mount=mount)
    glb.run("four_bar")
    root = GlbFile(written.glb.read_bytes()).matrices(0.0)["ground"]
    assert root[:3, :3] @ mount.up == pytest.approx([0.0, 1.0, 0.0])
    if mount.kind != "desk":
        assert root[:3, :3] @ [0.0, 0.0, 1.0] == pytest.approx([0.0, 0.0, 1.0])


def test_another_program_reads_the_same_solids(out: Out) -> None:
    import trimesh

    scene = trimesh.load_scene(out.glb)
    meshes = film_fixture.solids()
    names = {f"{body}/{piece}" for body, pieces in meshes.items() for piece in pieces}
    assert names <= set(scene.graph.nodes)
    for body, pieces in meshes.items():
        for piece, (mesh, _) in pieces.items():
            _, key = scene.graph[f"{body}/{piece}"]
            solid = trimesh.Trimesh(scene.geometry[key].vertices, scene.geometry[key].faces)
            solid.merge_vertices(merge_norm=True)
            assert solid.volume * 1e9 == pytest.approx(mesh.volume, rel=1e-5)
            assert solid.bounds * 1000 == pytest.approx(mesh.bounds, abs=1e-3)
            assert solid.is_watertight


def test_surfaces_are_those_of_the_materials(out: Out) -> None:
    read = GlbFile(out.glb.read_bytes())
    mesh = read.json["meshes"][read.nodes["crank/start"]["mesh"]]
    paint = read.json["materials"][mesh["primitives"][0]["material"]]["pbrMetallicRoughness"]
    brass = MATERIALS["brass"]
    assert paint["baseColorFactor"] == pytest.approx([*brass.colour, 1.0])
    assert (paint["metallicFactor"], paint["roughnessFactor"]) == (1.0, brass.roughness)
    normals = read.array(mesh["primitives"][0]["attributes"]["NORMAL"])
    assert np.linalg.norm(normals, axis=1) == pytest.approx(1.0, abs=1e-6)


def test_a_ball_is_smooth_and_a_box_has_edges() -> None:
    from trimesh import creation

    ball, box = creation.icosphere(subdivisions=3), creation.box()
    places, normals, corners = smooth(ball.triangles)
    assert len(places) == len(ball.vertices)
    assert (places * normals).sum(axis=1) == pytest.approx(1.0, abs=1e-3)
    assert len(corners) == 3 * len(ball.faces)
    places, normals, corners = smooth(box.triangles)
    assert len(places) == 24
    assert np.abs(normals).max(axis=1) == pytest.approx(1.0)
    assert places[corners].reshape(-1, 3, 3) == pytest.approx(box.triangles)


def test_it_is_written_once_with_the_same_bytes(out: Out, capsys: pytest.CaptureFixture[str]) -> None:
    content = out.glb.read_bytes()
    capsys.readouterr()
    glb.run("four_bar")
    assert "nothing to do" in capsys.readouterr().out
    out.glb.unlink()
    glb.run("four_bar")
    assert out.glb.read_bytes() == content


def test_without_parts_it_says_what_to_make(out_root: Path) -> None:
    with pytest.raises(UserError, match="run make solve-four-bar first"):
        glb.run("four_bar")


NEAR = 1e-5
"""m, over the whole motion."""


def written(belt: Belt, poses: Poses) -> GlbFile:
    """A file with nothing but the belt, its axes those of data.json."""
    document = Document()
    animation = Animation(document, poses.motion)
    nodes = add_belt(document, animation, Paints(document), poses, belt)
    document.add("nodes", {"name": "root", "children": nodes})
    document.add("scenes", {"nodes": [len(nodes)]})
    document.json["scene"] = 0
    document.add("animations", animation.content())
    return GlbFile(document.content())


@pytest.mark.parametrize("crossed", [False, True])
def test_marks_run_on_their_loop(crossed: bool) -> None:
    belt, poses = filmed(drive(crossed))
    read = written(belt, poses)
    assert len({node["mesh"] for name, node in read.nodes.items() if "mark" in name}) == 1
    for k in (0, 7, 48):
        time = poses.time[k]
        loop, *marks = (np.array(path) for path in belt.paths(poses, Moment(time, 0)))
        matrices = read.matrices(time - poses.time[0])
        for number, mark in enumerate(marks, start=1):
            matrix = matrices[f"belt mark {number}"]
            assert matrix[:3, 3] == pytest.approx(mark[2], abs=NEAR)
            way = (mark[4] - mark[0])[:2]
            assert matrix[:2, 0] == pytest.approx(way / np.hypot(*way), abs=1e-5)
        assert off_the_middle(read, loop, matrices) == pytest.approx(belt.radius, rel=0.05)


def off_the_middle(read: GlbFile, loop: np.ndarray, matrices: dict[str, np.ndarray]) -> np.ndarray:
    """How far some points of the loop's surface are from the points of its middle line (m)."""
    [primitive] = read.json["meshes"][read.nodes["belt"]["mesh"]]["primitives"]
    points = read.array(primitive["attributes"]["POSITION"])[::37]
    placed = points @ matrices["belt"][:3, :3].T + matrices["belt"][:3, 3]
    return np.linalg.norm(placed[:, None] - loop, axis=2).min(axis=1)


@pytest.mark.parametrize(("teeth", "meshes"), [((16, 32), 2), ((15, 30), 2)])
def test_links_of_a_chain_reach_from_roller_to_roller(teeth: tuple[int, int], meshes: int) -> None:
    belt, poses = filmed(drive(teeth=teeth))
    read = written(belt, poses)
    assert len({node["mesh"] for name, node in read.nodes.items() if "link" in name}) == (1 if belt.alike else meshes)
    for k in (0, 11, 30):
        time = poses.time[k]
        rollers = np.array(belt.paths(poses, Moment(time, 0))[: belt.count])
        middles = rollers.mean(axis=1)
        matrices = read.matrices(time - poses.time[0])
        links = np.array([matrices[f"belt link {number}"] for number in range(1, belt.count + 1)])
        assert np.abs(links[:, :3, 3] - middles).max() < NEAR
        ahead = np.roll(middles, -1, axis=0) - middles
        length = np.linalg.norm(ahead, axis=1)
        assert np.abs(links[:, :3, 0] - ahead / length[:, None]).max() < 1e-5
        assert np.ptp(length) < 0.02 * length.mean()  # one mesh serves on strands and on pulleys


def test_a_belt_on_a_carrier_goes_round_with_it() -> None:
    """A pulley of ground, and one on an arm that turns twice in the motion."""
    m = Mechanism("carried")
    arm, planet = m.body("arm"), m.body("b")
    m.revolute("A", m.ground.at(0.01, 0.02), arm.origin)
    m.revolute("B", arm.at(0.12, 0), planet.origin)
    m.belt("belt", m.ground.at(0.01, 0.02), planet.origin, 0.02, 0.04)
    m.drive_angle("motor", arm, constant_rate(2 * math.pi, 0.3))
    m.start_near(arm=17, b=40)
    motion = to_motion(m.sweep(2.0, steps=361), None, "", {}, dict.fromkeys(("arm", "b"), "mechanism"))
    [belt] = belts(motion, {"belt": Held(z=0.01, radius=0.001)})
    poses = Poses(motion)
    read = written(belt, poses)
    for time in (0.0, 0.61, 1.3, 2.0):
        loop, *marks = (np.array(path) for path in belt.paths(poses, Moment(time, 0)))
        matrices = read.matrices(time)
        assert off_the_middle(read, loop, matrices) == pytest.approx(belt.radius, rel=0.05)
        for number, mark in enumerate(marks, start=1):
            assert matrices[f"belt mark {number}"][:3, 3] == pytest.approx(mark[2], abs=5 * NEAR)


UPRIGHT = np.array([[1.0, 0, 0], [0, 0, 1], [0, -1, 0]])
"""From z up to y up."""


def middles(read: GlbFile, node: str, matrices: dict[str, np.ndarray]) -> np.ndarray:
    """Middles (n, 3) of the rings of a tube, world axes of the mechanism (z up)."""
    [primitive] = read.json["meshes"][read.nodes[node]["mesh"]]["primitives"]
    points = read.array(primitive["attributes"]["POSITION"]).astype(float)
    for weight, target in zip(read.weights[node], primitive.get("targets", []), strict=True):
        points = points + weight * read.array(target["POSITION"])
    rings = points[: len(points) - 2 * SIDES].reshape(-1, SIDES, 3).mean(axis=1)
    return (np.column_stack([rings, np.ones(len(rings))]) @ matrices[node].T)[:, :3] @ UPRIGHT


def film_paths(film: Film, time: float) -> list[tuple[TubeSpec, np.ndarray]]:
    at = Moment(time, 0)
    drawn = (*film.stretched, *film.spirals)
    paths = [np.array(path) for spring in drawn for path in spring.paths(film.poses, at)]
    return list(zip([spec for spring in drawn for spec in spring.specs], paths, strict=True))


@pytest.mark.parametrize("stiff", [True, False])
def test_coils_and_cylinders_are_where_the_film_has_them(out_root: Path, stiff: bool):
    film = test_springs.film(stiff=stiff)
    read = GlbFile(build.glb(film))
    for k in (0, 77, 180, 359):
        time = film.motion.time[k]
        matrices = read.matrices(time)
        for spec, path in film_paths(film, time):
            assert middles(read, spec.name, matrices) == pytest.approx(path, abs=2e-6), spec.name


def test_a_rope_is_links_along_its_path(out_root: Path):
    film = test_springs.film(rope=0.6)
    read = GlbFile(build.glb(film))
    links = sorted((name for name in read.nodes if name.startswith("rope ") and name.split()[1].isdigit()), key=len)
    assert len(links) == 24
    for k in (0, 120, 300):
        matrices = read.matrices(film.motion.time[k])
        path = {spec.name: path for spec, path in film_paths(film, film.motion.time[k])}["rope"]
        ends = np.concatenate([middles(read, f"rope {n + 1}", matrices) for n in range(24)])
        assert ends[0] == pytest.approx(path[0], abs=2e-6)
        assert ends[-1] == pytest.approx(path[-1], abs=2e-6)
        assert ends[1:-1:2] == pytest.approx(ends[2::2], abs=2e-6)  # each begins where the one before ends
        away = np.linalg.norm(ends[:, None] - path[None], axis=2).min(axis=1)
        assert away.max() < 2e-6


def test_a_torsion_spring_winds_as_in_the_film(out_root: Path):
    out = film_fixture.write()
    motion = test_springs.with_spring(read_motion(out.motion))
    film = Film(motion, read_parts(out.parts), Shot(), out.parts_folder)
    [spring] = film.spirals
    read = GlbFile(build.glb(film))
    for k in (0, 111, 250):
        matrices = read.matrices(motion.time[k])
        for spec, path in film_paths(film, motion.time[k]):
            blended = 0.02 * spring.rim if spec.name == "spring" else 2e-6
            assert middles(read, spec.name, matrices) == pytest.approx(path, abs=blended), spec.name
        assert sum(read.weights["spring"]) <= 1 + 1e-6


def test_a_spring_that_nothing_moves_and_a_long_simulation(out_root: Path):
    film = test_springs.film(rope=0.6)
    motion = film.motion
    count = 4000
    bodies = {}
    for name, body in motion.bodies.items():
        still = {field: [getattr(body, field)[0]] * count for field in ("x", "y", "theta")}
        still |= {field: [0.0] * count for field in ("vx", "vy", "omega", "ax", "ay", "alpha")}
        bodies[name] = msgspec.structs.replace(body, **still)
    forces = {name: msgspec.structs.replace(force, value=[0.1] * count) for name, force in motion.forces.items()}
    still = msgspec.structs.replace(
        motion, period=None, time=np.linspace(0, 9, count).tolist(), bodies=bodies, forces=forces, points={}
    )
    seen = Film(still, film.parts, Shot(trails=()), film.folder)
    read = GlbFile(build.glb(seen))
    clocks = {read.array(sampler["input"]).size for sampler in read.json["animations"][0]["samplers"]}
    assert clocks == {count, 1440}
    matrices = read.matrices(5.0)
    assert middles(read, "spring", matrices)[0, :2] == pytest.approx(test_springs.MARKERS[0][:2], abs=1e-6)


def test_a_square_has_stripes_of_its_way_and_period() -> None:
    square = np.array([[[0, 0, 0], [1, 0, 0], [1, 1, 0]], [[0, 0, 0], [1, 1, 0], [0, 1, 0]]], float)
    light, dark = striped(square, Hatch((1.0, 0.0, 0.0), 0.25), 0.6)
    areas = [trimesh.triangles.area(part).sum() for part in (light, dark)]
    assert areas == pytest.approx([0.6, 0.4])
    assert np.all(light[..., 0].max(axis=1) % 0.25 < 0.15 + 1e-9)
    assert np.all((dark[..., 0].min(axis=1) + 1e-12) % 0.25 > 0.15 - 1e-9)
    normals = np.cross(light[:, 1] - light[:, 0], light[:, 2] - light[:, 0])
    assert (normals[:, 2] > 0).all()


def test_edges_along_a_plane_are_split_where_stripes_end() -> None:
    wall = np.array([[[0, 0, 0], [1, 0, 0], [0.5, 0, -1]], [[0, 0, -1], [0.5, 0, -1], [0, 0, 0]]], float)
    split = along_rim(wall, (0.0, 0.0, 1.0, 0.0), Hatch((1.0, 0.0, 0.0), 0.5), 0.5, 1e-9)
    assert len(split) == 1 + 4  # the other triangle has no edge in the plane
    assert trimesh.triangles.area(split).sum() == pytest.approx(trimesh.triangles.area(wall).sum())
    on_it = np.unique(split.reshape(-1, 3)[np.abs(split.reshape(-1, 3)[:, 2]) < 1e-12][:, 0])
    assert on_it == pytest.approx([0, 0.25, 0.5, 0.75, 1])


@pytest.mark.parametrize("section", [Section(front=0.3), Section(right=0.5, above=0.4), Section(right=0.4, fixed=True)])
def test_cut_pieces_are_closed_with_their_stripes(out_root: Path, section: Section) -> None:
    out = film_fixture.write()
    film = Film(read_motion(out.motion), read_parts(out.parts), Shot(section=section), out.parts_folder)
    cut = [piece for piece in pieces_of(film) if piece.cut]
    assert cut
    for piece in cut:
        (rest, own), (light, bright), (dark, shady) = faces_of(read_triangles(Path(piece.stl)), piece, 0.1)
        assert own == piece.surface
        assert (bright.colour, shady.colour) == (light_of(own.colour), dark_of(own.colour))
        parts = np.concatenate([rest, light, dark]).astype(np.float32)
        solid = trimesh.Trimesh(parts.reshape(-1, 3), np.arange(3 * len(parts)).reshape(-1, 3), process=False)
        solid.merge_vertices(digits_vertex=9)
        assert solid.is_watertight, (piece.body, piece.name)
        whole = trimesh.triangles.area(light).sum() + trimesh.triangles.area(dark).sum()
        if whole > 1e-4:  # of some stripes, not of a corner
            assert trimesh.triangles.area(light).sum() / whole == pytest.approx(LIGHT, abs=0.12)


def test_neighbours_lean_otherwise_and_faces_that_stand_have_stripes_along_z() -> None:
    kinds = {hatch_of(f"rod/pin_{k}", (0.0, 0.0, 1.0, 0.0)) for k in range(40)}
    assert len(kinds) == 4
    assert hatch_of("rod/rod", (1.0, 0.0, 0.0, 0.2)).way[:2] == (0.0, 1.0)
    assert abs(hatch_of("rod/rod", (0.0, -1.0, 0.0, 0.2)).way[2]) == 1.0
