"""Pictures of mechanisms in space: poses between rows, arrows along any direction, and all stages of one mechanism."""

from __future__ import annotations

import json
import math
import os
import subprocess
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from mbsd.spatial import drawing
from mechanisms.heavy_top import mechanism as top
from mechanisms.stages import shot as shot_stage
from mechanisms.stages.clearance import stage as clearance_stage
from mechanisms.stages.parts import stage as parts_stage
from mechanisms.stages.solve import stage as solve_stage
from mechanisms.stages.solve.space.motion_file import to_motion3
from render import glb, plots, report, view
from render.blender.scene.arrows import going_on, turns_from_x
from render.film.film import Film
from render.film.framing import project
from render.film.inputs import read_film
from render.film.poses import Moment
from render.film.scene import across_axes
from render.film.space import SpacePoses, torques_in_space, vectors_in_space
from render.plots.pages import space as pages
from render.view.bundle import PAGE, node, node_modules
from shared.contract import is_in_space, read_motion, read_parts
from shared.contract.quaternions import matrices, quaternion_of
from shared.contract.shot import Shot
from shared.contract.skeleton import VIEW, read_skeleton
from shared.stage.errors import UserError
from shared.stage.paths import Out
from tests.render.glb_file import GlbFile
from tests.running.needs import needed

DIRECTIONS = st.tuples(*[st.floats(-1.0, 1.0)] * 3).filter(lambda way: math.hypot(*way) > 1e-3)


def spinning(times: np.ndarray) -> SpacePoses:
    m = top.build(top.Params())
    return SpacePoses(to_motion3(m.simulate(times=times), {"top": "#0b62a8"}, {}, {"top": "mechanism"}))


def test_between_rows_the_film_shows_the_motion() -> None:
    """Rows as far apart as the solve stage lets them be: a third of a radian."""
    coarse, fine = np.linspace(0.0, 0.1, 91), np.linspace(0.0, 0.1, 361)
    seen, exact = spinning(coarse), spinning(fine)
    place, q = seen.over("top", fine)
    wanted = exact.motion.bodies["top"]
    assert np.abs(place - wanted.place).max() < 1e-7
    assert np.abs(np.abs((q * wanted.quaternion).sum(axis=1)) - 1.0).max() < 1e-9
    assert np.abs(np.linalg.norm(q, axis=1) - 1.0).max() < 1e-12


@given(way=DIRECTIONS)
def test_an_arrow_turns_to_its_direction_and_stays_in_a_plane(way: tuple[float, float, float]) -> None:
    turned = turns_from_x(np.array([way]))
    np.testing.assert_allclose(matrices(turned)[0][:, 0], np.array(way) / math.hypot(*way), atol=1e-7)
    flat = turns_from_x(np.array([[way[0], way[1], 0.0]]))[0]
    assert np.abs(flat[1:3]).max() < 1e-12 or math.hypot(*way[:2]) == 0.0


@given(way=DIRECTIONS)
def test_the_plane_of_an_arc_is_normal_to_its_axis_and_that_of_z_is_the_worlds(way: tuple[float, float, float]) -> None:
    axis = np.array([way]) / math.hypot(*way)
    x, y = across_axes(axis)
    np.testing.assert_allclose(np.cross(x, y), axis, atol=1e-9)
    np.testing.assert_allclose(np.hstack(across_axes(np.array([[0.0, 0.0, 1.0]]))), [[1, 0, 0, 0, 1, 0]], atol=1e-15)


def test_signs_go_on_and_rotations_come_back() -> None:
    angle = np.linspace(0.0, 4 * math.pi, 50)
    q = np.stack([np.cos(angle / 2), np.sin(angle / 2), 0 * angle, 0 * angle], axis=1)
    np.testing.assert_allclose(quaternion_of(matrices(q)), q, atol=1e-12)
    jumping = q * np.where(np.arange(50) % 3 == 0, -1.0, 1.0)[:, None]
    steady = going_on(jumping)
    assert ((steady[1:] * steady[:-1]).sum(axis=1) > 0.0).all()


def test_plots_and_skeleton_have_one_view() -> None:
    np.testing.assert_allclose(pages.flat(np.eye(3)), drawing.view_rows().T, atol=1e-15)


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Out]:
    """All stages before the pictures of one mechanism in space."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("MBSD_OUT", str(tmp_path_factory.mktemp("out")))
        for run in (
            parts_stage.run,
            solve_stage.run,
            clearance_stage.run,
            shot_stage.run,
            report.run,
            plots.run,
            glb.run,
        ):
            run("cardan_shaft")
        yield Out("cardan_shaft")


def test_one_command_makes_motion_parts_report_plots_and_glb(made: Out) -> None:
    assert is_in_space(made.motion)
    parts = read_parts(made.parts)
    assert parts.mount.kind == "bench"
    assert parts.bodies["cross_in"].link.joint == "cross_in"  # pyright: ignore[reportAttributeAccessIssue]
    text = made.report.read_text()
    assert "moves in space, has 1 degree of freedom and is driven by motor" in text
    assert {path.stem for path in made.plots.glob("*.png")} == {"path", "bodies", "energy", "reactions"}
    with pytest.raises(UserError, match="a mechanism in space; this needs one in the plane"):
        read_motion(made.motion)
    motion = read_film(made).in_space
    assert motion is not None
    assert {name for name, body in motion.bodies.items() if body.mass == 0.0} == {"cross_in", "cross_out"}


def test_bodies_and_crosses_of_the_glb_move_as_data_json_has_them(made: Out) -> None:
    film, file = read_film(made), GlbFile(made.glb.read_bytes())
    names = [node["name"] for node in file.json["nodes"]]
    assert {"input", "middle", "output", "cross_in", "cross_out", "ground"} <= set(names)
    (clip,) = file.json["animations"]
    tracks = {(names[c["target"]["node"]], c["target"]["path"]): c["sampler"] for c in clip["channels"]}
    q = file.array(clip["samplers"][tracks["middle", "rotation"]]["output"])
    assert film.in_space is not None
    np.testing.assert_allclose(q, np.roll(film.in_space.bodies["middle"].quaternion, -1, axis=1), atol=1e-6)
    assert ("ground", "rotation") not in tracks
    place, turned = film.poses.over("cross_in", film.poses.time)
    marker, other = (film.in_space.joints["cross_in"].markers[k] for k in (0, 1))
    first = matrices(film.in_space.bodies["input"].quaternion) @ np.array(marker.axis)
    second = matrices(film.in_space.bodies["middle"].quaternion) @ np.array(other.axis)
    np.testing.assert_allclose(matrices(turned)[:, :, 0], first, atol=1e-9)
    np.testing.assert_allclose(matrices(turned)[:, :, 1], second, atol=1e-9)
    assert np.abs(place).max() < 1e-12


def test_the_page_has_bodies_and_skeleton_where_the_film_has_them(made: Out) -> None:
    """At rows of data.json and between them, in a browser; the skeleton lies in its dimetric view."""
    chromium = needed("chromium")
    view.run("cardan_shaft")
    film = read_film(made)
    times = [0.0, float(film.poses.time[77]), 0.5 * float(film.poses.time[100] + film.poses.time[101])]
    environment = {"NODE_PATH": str(node_modules()), "CHROMIUM": chromium}
    environment["PAGE_BROWSER"] = str(PAGE / "browser" / "browser.cjs")
    words = [str(node()), str(Path(__file__).with_name("use_space.cjs")), str(made.view), json.dumps(times)]
    done = subprocess.run(words, env=os.environ | environment, capture_output=True, text=True, timeout=200, check=False)
    assert done.returncode == 0, done.stderr[-2000:]
    page = json.loads(done.stdout)
    assert not page["errors"]
    for time, seen in zip(times, page["seen"], strict=True):
        for name in ("input", "middle", "cross_in", "ground"):
            place, q = film.poses.over(name, np.array([time]))
            placed = np.array(seen["bodies"][name]).reshape(4, 4).T
            np.testing.assert_allclose(placed[:3, :3], matrices(q[0]), atol=1e-6)
            np.testing.assert_allclose(placed[:3, 3], place[0], atol=1e-7)
        for name in ("bearing_in", "cross_out"):
            place = film.poses.joint(name, Moment(time, 0))
            np.testing.assert_allclose(seen["spots"][name], place, atol=1e-7)
            np.testing.assert_allclose(seen["joints"][name], np.array(VIEW) @ place, atol=1e-7)


def test_the_skeleton_of_the_page_is_carried_to_where_it_is_drawn(made: Out) -> None:
    """Lines lie between the ends that carry them, which the page moves; all else is recorded over the motion."""
    skeleton, film = read_skeleton(made.skeleton), read_film(made)
    assert skeleton.moving is not None
    carried = [stroke for stroke in skeleton.moving.strokes if stroke.carrier.kind == "line"]
    assert {stroke.carrier.ends[0].body for stroke in carried} == {"input", "middle", "output"}
    first = film.poses.time[0]
    for stroke in carried:
        ends = [
            film.poses.carried(end.body, np.array([[end.x, end.y, end.z]], float), np.array([first]))[0]
            for end in stroke.carrier.ends
        ]
        np.testing.assert_allclose(np.reshape(stroke.stroke.points, (-1, 2)), ends @ np.array(VIEW).T, atol=1e-6)
    assert all(len(stroke.shapes) == len(skeleton.moving.times) for stroke in skeleton.moving.strokes if stroke.shapes)


def test_every_period_has_the_same_states_and_the_camera_holds_what_moves(made: Out) -> None:
    film = read_film(made)
    count = film.clock.frames
    for frame in (0, 7, count - 1):
        assert film.state(frame) == film.state(frame + count)
    azimuth, elevation = (math.degrees(part) for part in (film.camera(0).azimuth, film.camera(0).elevation))
    assert (azimuth, elevation) == pytest.approx((-34.0, 24.0))
    seen = project(film.camera(0), film.space.machine, 16, 9) / (16, 9)
    assert seen.min() > 0.0
    assert seen.max() < 1.0


def test_arrows_of_reactions_stand_where_joints_are_and_moments_turn_about_their_axes(made: Out) -> None:
    film = read_film(made, "reactions")
    motion = film.in_space
    assert motion is not None
    reactions = {vector.name: vector for vector in vectors_in_space(motion, ("reactions",))}
    joint = motion.joints["bearing_out"]
    np.testing.assert_array_equal(reactions["bearing_out"].value[:, 2], joint.fz)
    for torque in torques_in_space(motion, ("reactions",)):
        moment = np.stack([getattr(motion.joints[torque.name], name) for name in ("mx", "my", "mz")], axis=1)
        np.testing.assert_allclose(torque.value[:, None] * torque.axes, moment, atol=1e-12)
    state = film.state(3)
    assert len(state.arrows) == len(film.arrows.vectors) > 0
    assert all(math.isclose(math.hypot(*axis), 1.0, rel_tol=1e-9) for _, _, axis in state.arcs)


def test_a_section_of_a_mechanism_in_space_raises_an_error(made: Out) -> None:
    film = read_film(made)
    cut = Film(film.in_space or film.motion, film.parts, Shot(section=0.4), Path(made.parts_folder))
    with pytest.raises(UserError, match="section cuts mechanisms in the plane"):
        _ = cut.scene


def test_bodies_of_the_usd_stage_turn_as_data_json_has_them(made: Out) -> None:
    pxr = pytest.importorskip("pxr.UsdGeom", reason="OpenUSD is not installed (extra usd)")
    from render.usd.scene import stage_of

    film = read_film(made)
    assert film.in_space is not None
    stage, body = stage_of(film), film.in_space.bodies["middle"]
    (prim,) = [prim for prim in stage.Traverse() if prim.GetName() == "middle"]
    for k in (0, 7, len(film.in_space.time) // 2):
        code = (film.in_space.time[k] - film.in_space.time[0]) * stage.GetTimeCodesPerSecond()
        placed = np.array(pxr.Xformable(prim).GetLocalTransformation(code)).T
        np.testing.assert_allclose(placed[:3, :3], matrices(body.quaternion)[k], atol=1e-12)
        np.testing.assert_allclose(placed[:3, 3], body.place[k], atol=1e-12)
