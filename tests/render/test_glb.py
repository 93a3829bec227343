"""The GLB: read back by another program and by its own rules, its bodies are where data.json has them."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest

from render import glb
from render.glb.document import smooth
from shared.contract import mounted, read_motion
from shared.contract.materials import MATERIALS
from shared.stage.errors import UserError
from shared.stage.paths import Out
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
def test_what_points_up_is_y(out_root: Path, gravity: tuple[float, float]) -> None:
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
