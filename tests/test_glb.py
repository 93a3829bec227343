"""The GLB: read back by another program and by its own rules, its bodies are where data.json has them."""

from __future__ import annotations

import json
import math
import struct
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from render import glb
from render.glb.mesh import smooth
from shared.contract import read_motion
from shared.errors import UserError
from shared.materials import MATERIALS
from shared.paths import Out
from tests import film_fixture

FIELDS = {"SCALAR": 1, "VEC3": 3, "VEC4": 4}
KINDS = {5126: "<f4", 5125: "<u4", 5123: "<u2"}


class Read:
    """A GLB taken apart by the rules of its specification."""

    def __init__(self, content: bytes) -> None:
        magic, version, length = struct.unpack_from("<4sII", content)
        assert (magic, version, length) == (b"glTF", 2, len(content))
        size, kind = struct.unpack_from("<I4s", content, 12)
        assert kind == b"JSON"
        assert size % 4 == 0
        self.json: dict[str, Any] = json.loads(content[20 : 20 + size])
        size_of_rest, kind = struct.unpack_from("<I4s", content, 20 + size)
        assert kind == b"BIN\0"
        self.binary = content[28 + size :]
        assert len(self.binary) == size_of_rest == self.json["buffers"][0]["byteLength"]
        self.nodes = {node["name"]: node for node in self.json["nodes"]}

    def array(self, number: int) -> np.ndarray:
        accessor = self.json["accessors"][number]
        view = self.json["bufferViews"][accessor["bufferView"]]
        assert view["byteOffset"] % 4 == 0
        fields = FIELDS[accessor["type"]]
        values = np.frombuffer(
            self.binary, KINDS[accessor["componentType"]], accessor["count"] * fields, view["byteOffset"]
        )
        assert values.nbytes == view["byteLength"]
        values = values.reshape(-1, fields)
        if "min" in accessor:
            assert accessor["min"] == values.min(axis=0).tolist()
            assert accessor["max"] == values.max(axis=0).tolist()
        return values

    def matrices(self, t: float) -> dict[str, np.ndarray]:
        """World matrix of every node at a time (s), as a viewer plays the animation."""
        local = {k: dict(node) for k, node in enumerate(self.json["nodes"])}
        [animation] = self.json["animations"]
        for channel in animation["channels"]:
            sampler = animation["samplers"][channel["sampler"]]
            assert sampler["interpolation"] == "LINEAR"
            times, values = self.array(sampler["input"])[:, 0], self.array(sampler["output"])
            if channel["target"]["path"] == "weights":
                values = values.reshape(len(times), -1)
            assert (np.diff(times) > 0).all()
            k = int(np.clip(np.searchsorted(times, t, side="right") - 1, 0, len(times) - 2))
            part = min(max((t - times[k]) / (times[k + 1] - times[k]), 0.0), 1.0)
            target = channel["target"]
            assert np.isfinite(values).all()
            local[target["node"]][target["path"]] = _between(values[k], values[k + 1], part, target["path"])
        self.weights = {node["name"]: node.get("weights", []) for node in local.values()}
        out: dict[str, np.ndarray] = {}

        def walk(k: int, above: np.ndarray) -> None:
            here = above @ _matrix(local[k])
            out[local[k]["name"]] = here
            for child in local[k].get("children", []):
                walk(child, here)

        for root in self.json["scenes"][self.json["scene"]]["nodes"]:
            walk(root, np.eye(4))
        return out


def _between(a: np.ndarray, b: np.ndarray, part: float, path: str) -> np.ndarray:
    a, b = a.astype(float), b.astype(float)
    if path != "rotation":
        return a + part * (b - a)
    dot = float(a @ b)
    angle = math.acos(min(abs(dot), 1.0))
    if angle < 1e-3:  # straight, as viewers do; the angle of nearly equal ones is rounding
        blend = a + part * (math.copysign(1, dot) * b - a)
        return blend / np.linalg.norm(blend)
    return (math.sin((1 - part) * angle) * a + math.copysign(1, dot) * math.sin(part * angle) * b) / math.sin(angle)


def _matrix(node: dict[str, Any]) -> np.ndarray:
    x, y, z, w = node.get("rotation", (0, 0, 0, 1))
    out = np.eye(4)
    out[:3, :3] = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
        [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
        [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
    ]
    out[:3, :3] *= node.get("scale", (1, 1, 1))
    out[:3, 3] = node.get("translation", (0, 0, 0))
    return out


@pytest.fixture
def out(out_root: Path) -> Out:
    out = film_fixture.write()
    glb.run("four_bar")
    return out


def test_every_body_is_where_data_json_has_it(out: Out) -> None:
    read, motion = Read(out.glb.read_bytes()), read_motion(out.motion)
    corner = np.array([0.1, 0.02, 0.03, 1.0])  # a point of each body, 0.1 m from its frame
    for k in [*range(0, len(motion.time), 7), len(motion.time) - 1]:
        matrices = read.matrices(motion.time[k])
        for name, body in motion.bodies.items():
            c, s = math.cos(body.theta[k]), math.sin(body.theta[k])
            x, y = body.x[k] + c * corner[0] - s * corner[1], body.y[k] + s * corner[0] + c * corner[1]
            assert matrices[name] @ corner == pytest.approx([x, corner[2], -y, 1.0], abs=1e-5)  # glTF's y is up
        assert matrices["ground"] @ corner == pytest.approx([0.1, 0.03, -0.02, 1.0], abs=1e-6)


def test_between_samples_it_is_as_near(out: Out) -> None:
    read, motion = Read(out.glb.read_bytes()), read_motion(out.motion)
    for k in (10, 100, 299):
        t = (motion.time[k] + motion.time[k + 1]) / 2
        place = read.matrices(t)["coupler"] @ np.array([0.0, 0.0, 0.0, 1.0])
        angle = 2 * math.pi * t
        assert place[:3] == pytest.approx([0.04 * math.cos(angle), 0.0, -0.04 * math.sin(angle)], abs=1e-5)


def test_another_program_reads_the_same_solids(out: Out) -> None:
    import trimesh

    scene = trimesh.load_scene(out.glb)
    meshes = film_fixture.solids()
    names = {f"{body}/{piece}" for body, pieces in meshes.items() for piece in pieces}
    assert names <= set(scene.graph.nodes)
    for body, pieces in meshes.items():
        for piece, (mesh, _) in pieces.items():
            _, key = scene.graph[f"{body}/{piece}"]
            found = trimesh.Trimesh(scene.geometry[key].vertices, scene.geometry[key].faces)
            found.merge_vertices(merge_norm=True)
            assert found.volume * 1e9 == pytest.approx(mesh.volume, rel=1e-5)
            assert found.bounds * 1000 == pytest.approx(mesh.bounds, abs=1e-3)
            assert found.is_watertight


def test_surfaces_are_those_of_the_materials(out: Out) -> None:
    read = Read(out.glb.read_bytes())
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
