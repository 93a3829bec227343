"""The payload of the page has what the files say, orders and places of gaps included."""

from __future__ import annotations

import json
import math
import os
import subprocess
from pathlib import Path

import numpy as np
import pytest
import trimesh
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp

from mbsd.results.orders import Orders
from render.film.solids import read_triangles
from render.view.bundle import PAGE, bundle, node, node_modules
from render.view.document import document, encode
from render.view.loads import middle
from render.view.payload import payload, read_payload
from render.view.solid import Meshes, shapes
from shared.contract import read_motion
from shared.contract.quantity import written
from shared.contract.skeleton import read_skeleton, write_skeleton
from shared.stage.errors import UserError
from shared.stage.paths import Out
from tests.render.test_plot_pages import motion_of
from tests.render.view.decoded import decoded
from tests.results.test_couples import two_cylinders
from tests.running.needs import needed
from tools.fixtures import film_fixture
from tools.models.motions import plain_skeleton

KINDS = st.sampled_from([np.float32, np.float64, np.uint8, np.int8, np.int16, np.uint16, np.uint32])


@pytest.fixture
def out(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Out:
    monkeypatch.setenv("MBSD_OUT", str(tmp_path))
    return film_fixture.write()


@settings(max_examples=60, deadline=None)
@given(
    array=KINDS.flatmap(lambda kind: hnp.arrays(kind, st.integers(0, 40))),
    word=st.text(max_size=9),
    plain=st.booleans(),
)
def test_bytes_give_the_payload_back(array: np.ndarray, word: str, plain: bool) -> None:
    back = decoded(encode({"a": array, "deep": [{"b": array[::-1], "word": word}, None, True]}, compress=not plain))
    assert back["a"].dtype == array.dtype
    assert back["a"].tobytes() == array.tobytes()
    assert back["deep"][0]["b"].tobytes() == array[::-1].tobytes()
    assert back["deep"][0]["word"] == word
    assert back["deep"][1:] == [None, True]


def test_the_payload_holds_what_the_files_say_and_is_the_same_each_time(out: Out) -> None:
    content = encode(read_payload(out))
    assert content == encode(read_payload(out))
    back, motion = decoded(content), read_motion(out.motion)
    assert back["time"] == pytest.approx(motion.time, abs=0)
    for name, body in motion.bodies.items():
        assert back["bodies"][name]["x"] == pytest.approx(np.float32(body.x), abs=0)
        turned = (np.array(body.theta) - back["bodies"][name]["theta"]) / math.tau
        assert turned == pytest.approx(np.round(turned), abs=1e-6)
    for name, joint in motion.joints.items():
        at, k = back["joints"][name]["at"], 77
        x, y, theta = 0.0, 0.0, 0.0
        if at["body"] in motion.bodies:
            body = motion.bodies[at["body"]]
            x, y, theta = body.x[k], body.y[k], body.theta[k]
        u, v, c, s = at["x"], at["y"], math.cos(theta), math.sin(theta)
        assert (x + c * u - s * v, y + s * u + c * v) == pytest.approx((joint.x[k], joint.y[k]), abs=1e-9)
    pieces = back["solid"]["pieces"]
    assert {(piece["body"], piece["name"]) for piece in pieces} >= {("crank", "crank"), ("ground", "base")}
    assert len(back["solid"]["meshes"]) < len(pieces), "balls of one size are one mesh"


def test_meshes_lie_where_the_stl_files_do(out: Out) -> None:
    files = sorted(out.parts_folder.glob("*.stl"))
    meshes = Meshes(0.2)
    for file, shape in zip(files, shapes(files), strict=True):
        number, low = meshes.add(shape)
        mesh = meshes.list[number]
        count = mesh["count"]
        places = np.cumsum(mesh["positions"].astype(np.int64), axis=1) % 65536
        places = low + meshes.step * places.T
        differences = mesh["triangles"].astype(np.int64)
        differences = np.where(differences % 2, -(differences + 1) // 2, differences // 2)
        first = np.cumsum(differences[0])
        corners = np.stack([first, first + differences[1], first + differences[2]], axis=1)
        assert corners.min() >= 0
        assert corners.max() < count
        wanted = read_triangles(file)
        assert _volume(places[corners]) == pytest.approx(_volume(wanted), rel=1e-3)
        assert np.ptp(places, axis=0) == pytest.approx(np.ptp(wanted.reshape(-1, 3), axis=0), abs=2 * meshes.step)
        u, v = mesh["normals"].astype(float) / 127
        z = 1 - np.abs(u) - np.abs(v)
        u, v = (
            np.where(z < 0, (1 - np.abs(v)) * np.where(u >= 0, 1, -1), u),
            np.where(z < 0, (1 - np.abs(u)) * np.where(v >= 0, 1, -1), v),
        )
        normals = np.stack([u, v, z], axis=1) / np.linalg.norm([u, v, z], axis=0)[:, None]
        assert normals == pytest.approx(shape[1], abs=0.02)


def test_shapes_of_hundreds_of_metres_are_told_apart(tmp_path: Path) -> None:
    files = []
    for length in (300.0, 400.0):
        file = tmp_path / f"floor_{length:.0f}.stl"
        trimesh.creation.box((1000.0 * length, 1000.0, 1000.0)).export(file)  # mm
        files.append(file)
    spans = [float(np.ptp(positions[:, 0])) for positions, *_ in shapes(files)]
    assert spans == pytest.approx([300.0, 400.0], rel=1e-6)


def test_a_skeleton_from_before_is_refused_with_the_remedy(out: Out) -> None:
    skeleton = read_skeleton(out.skeleton)
    skeleton.moving = None
    write_skeleton(out.skeleton, skeleton)
    with pytest.raises(UserError, match="make solve-four-bar again"):
        read_payload(out)


def test_without_parts_there_is_the_skeleton_alone(out: Out) -> None:
    out.parts.unlink()
    payload = read_payload(out)
    assert payload["solid"] is None
    assert len(payload["skeleton"]["strokes"]) == 3
    assert all(arrow["z"] == 0 for arrow in payload["arrows"]["list"])


def _volume(triangles: np.ndarray) -> float:
    a, b, c = triangles[:, 0], triangles[:, 1], triangles[:, 2]
    return float((a * np.cross(b, c)).sum() / 6)


def largest(orders: Orders, unit: str, order: float) -> str:
    return f"order {order:g} {written(float(orders.largest[orders.index(order)]), unit)}"


def test_bars_name_the_largest_orders_of_what_is_chosen(tmp_path: Path) -> None:
    chromium = needed("chromium")
    m = two_cylinders()
    m.bodies["piston_1"].mass = 0.7
    motion, sol = motion_of(m), m.sweep(steps=360)
    content = encode(payload(motion, plain_skeleton(motion).moving))
    (tmp_path / "view.html").write_bytes(document("Twin", content, bundle()))
    done = subprocess.run(
        [str(node()), str(Path(__file__).with_name("orders.cjs")), str(tmp_path / "view.html")],
        env=os.environ
        | {
            "NODE_PATH": str(node_modules()),
            "CHROMIUM": str(chromium),
            "PAGE_BROWSER": str(PAGE / "browser" / "browser.cjs"),
        },
        capture_output=True, text=True, timeout=200, check=False,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr[-3000:]
    seen = json.loads(done.stdout)
    assert not seen["errors"]
    shown = {chart["title"]: chart for chart in seen["whole"]}
    force, torque = sol.orders(sol.shaking().force), sol.orders(sol.driver("motor").effort)
    assert shown["Orders of the shaking force"]["named"][:2] == [largest(force, "N", order) for order in (2, 1)]
    assert shown["Orders of motor"]["named"][0] == largest(torque, "N m", 2)
    assert all(chart["inked"] for chart in seen["whole"])
    (driver,) = seen["driver"]
    assert driver["title"] == "Orders of the effort"
    assert driver["named"] == shown["Orders of motor"]["named"]
    assert not seen["body"]


def box(size: tuple[float, float, float], at: tuple[float, float, float]) -> np.ndarray:
    from trimesh import creation

    return np.asarray(creation.box(size).apply_translation(at).triangles, float)


@settings(max_examples=20, deadline=None)
@given(gap=st.floats(1e-4, 5e-3), scale=st.sampled_from([0.1, 1.0, 30.0]), shift=st.floats(-0.02, 0.02))
def test_between_two_boxes(gap: float, scale: float, shift: float) -> None:
    plate = box((0.2 * scale, 0.1 * scale, 0.01 * scale), (0, 0, 0))
    bar = box((0.02 * scale, 0.02 * scale, 0.05 * scale), (0.05 * scale, shift * scale, (0.03 + gap) * scale))
    x, y, z = middle(plate, bar) / scale
    assert abs(z - (0.005 + gap / 2)) < 0.25 * gap + 2e-4
    assert abs(x - 0.05) <= 0.0108
    assert abs(y - shift) <= 0.0108
