"""The camera holds the whole swept motion, as tightly as its margin says."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from render.film import composing
from render.film.film import Film
from render.film.framing import NEAREST, SENSOR, CameraPose, axes, depth_of_field, fit, project
from render.film.solids import prism, read_corners, swept
from render.presets import ASPECTS
from shared.contract import Mount, mounted, read_motion, read_parts
from shared.contract.shot import Camera, Shot, Title
from shared.stage.errors import UserError
from tools.fixtures import film_fixture

MOUNTS = [mounted((0.0, 0.0)), mounted((0.0, -9.81)), mounted((3.0, 4.0), "wall")]
"""On a desk, on a stand, and at a wall in a world that is turned."""
CLOUDS = arrays(float, (12, 3), elements=st.floats(-0.2, 0.2))
ANGLES = st.tuples(st.floats(-3, 3), st.floats(0.1, 1.5))


@given(CLOUDS, ANGLES, st.floats(30, 120), st.floats(0, 0.3))
def test_all_points_are_inside_the_margin_and_two_sides_touch_it(
    points: np.ndarray, angles: tuple[float, float], lens: float, margin: float
):
    points = np.concatenate([points, [[0, 0, 0], [0.1, 0, 0], [0, 0.1, 0.05]]])
    position, _ = fit(points, *angles, lens, margin)
    camera = CameraPose(
        position=tuple(position), azimuth=angles[0], elevation=angles[1], lens=lens, focus=1.0, fstop=0.0
    )
    pixels = project(camera, points, 1600, 900) / [1600, 900]
    assert pixels.min() >= margin - 1e-6
    assert pixels.max() <= 1 - margin + 1e-6
    low, high = pixels.min(axis=0), pixels.max(axis=0)
    touching = [(abs(low[k] - margin) < 1e-6) and (abs(high[k] - 1 + margin) < 1e-6) for k in (0, 1)]
    nearest = ((points - position) @ axes(*angles)[2]).min()
    assert any(touching) or nearest == pytest.approx(NEAREST * np.linalg.norm(np.ptp(points, axis=0)))


def test_what_is_right_up_and_near_lands_right_up():
    camera = CameraPose(position=(0.0, -1.0, 0.0), azimuth=0.0, elevation=0.0, lens=SENSOR / 2, focus=1.0, fstop=0.0)
    assert project(camera, np.array([[0.0, 0.0, 0.0]]), 160, 90)[0] == pytest.approx([80, 45])
    assert project(camera, np.array([[0.5, 0.0, 0.25]]), 160, 90)[0] == pytest.approx([120, 25])


@pytest.mark.parametrize("mount", MOUNTS)
@pytest.mark.parametrize("above", [0.0, 0.2])
@pytest.mark.parametrize("orbit", [0.0, 14.0])
@pytest.mark.parametrize("shape", [(16, 9), (9, 16)])
def test_every_body_that_moves_stays_in_the_frame_over_the_whole_film_and_fills_it(
    out_root: Path, orbit: float, above: float, mount: Mount, shape: tuple[int, int], monkeypatch: pytest.MonkeyPatch
):
    """Within what stays empty ``above`` and below, where something is written. The base may leave it."""
    monkeypatch.setattr(composing, "PARTS", (above,))
    shot = Shot(camera=Camera(orbit=orbit, margin=0.08), seconds_per_turn=1.0, title=Title())
    out = film_fixture.write(shot, mount=mount)
    film = Film(read_motion(out.motion), read_parts(out.parts), shot, out.parts_folder, shape[0] / shape[1])
    extremes = []
    for frame in range(30):
        state = film.state(frame)
        for body in film.motion.bodies:
            for piece in film.parts.bodies[body].pieces.values():
                corners = swept(read_corners(out.parts_folder / piece.stl), np.array([state.bodies[body]]))
                extremes.append(project(state.camera, corners, *shape) / shape)
    pixels = np.concatenate(extremes)
    assert pixels.min() >= 0.08 - 2e-3
    assert pixels.max() <= 0.92 + 2e-3
    assert pixels[:, 1].min() >= 0.08 + above - 2e-3
    assert pixels[:, 1].max() <= 0.92 - above + 2e-3
    left = (0.84 - 2 * above) / 0.84  # of the height, by words and a legend
    assert (np.ptp(pixels, axis=0) / (1, left)).max() > (0.65 if orbit else 0.8)


@pytest.mark.parametrize("aspect", ["16:9", "1:1", "4:5", "9:16"])
@given(points=CLOUDS, where=ANGLES, margin=st.floats(0, 0.3))
def test_a_camera_holds_all_points_in_a_picture_of_any_shape(
    aspect: str, points: np.ndarray, where: tuple[float, float], margin: float
):
    points = np.concatenate([points, [[0, 0, 0], [0.1, 0, 0], [0, 0.1, 0.05]]])
    shape = ASPECTS[aspect]
    position, _ = fit(points, *where, 55.0, margin, (0.0, 0.0), shape[0] / shape[1])
    camera = CameraPose(position=tuple(position), azimuth=where[0], elevation=where[1], lens=55.0, focus=1.0, fstop=0.0)
    parts = project(camera, points, *shape) / shape
    assert parts.min() >= margin - 1e-6
    assert parts.max() <= 1 - margin + 1e-6


def test_depth_of_field_blurs_the_nearest_and_the_farthest_part_alike():
    near, far, lens, blur = 0.4, 0.6, 55.0, 1.5
    focus, fstop = depth_of_field(near, far, lens, blur)
    for distance in (near, far):
        s, d = focus * 1000, distance * 1000  # mm
        disc = lens**2 * abs(d - s) / (fstop * d * (s - lens))
        assert disc / SENSOR * 1280 == pytest.approx(blur)
    assert depth_of_field(near, far, lens, 0.0)[1] == 0.0


@pytest.mark.parametrize("mount", MOUNTS)
def test_axes_are_right_handed(mount: Mount):
    right, up, forward = axes(0.4, 0.7, mount.up)
    assert np.cross(right, forward) == pytest.approx(up)
    assert np.linalg.norm([right, up, forward], axis=1) == pytest.approx([1, 1, 1])
    assert forward @ mount.up == pytest.approx(-math.sin(0.7))
    assert right @ mount.up == pytest.approx(0.0, abs=1e-15)


@given(st.floats(-math.pi, math.pi))
def test_a_world_that_is_turned_in_its_plane_has_the_same_picture(angle: float):
    """With gravity, bodies and camera turned by the same angle about z, what stands is seen as before."""
    c, s = math.cos(angle), math.sin(angle)
    turned = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
    mount = mounted((9.81 * s, -9.81 * c), "stand")
    assert mount.up == pytest.approx(tuple(turned @ [0.0, 1.0, 0.0]))
    assert axes(0.3, 0.2, mount.up) @ turned == pytest.approx(axes(0.3, 0.2, (0.0, 1.0, 0.0)))


def test_a_plane_that_stands_is_seen_from_in_front_and_its_floor_is_below(out_root: Path):
    """y of the world is up in the picture, x to the right; the floor is under the lowest y, z comes towards one."""
    shot = Shot(camera=Camera(azimuth=0.0, elevation=5.0))
    out = film_fixture.write(shot, mount=mounted((0.0, -9.81)))
    film = Film(read_motion(out.motion), read_parts(out.parts), shot, out.parts_folder)
    pose = film.camera(0)
    middle, right, up, near = project(
        pose, film.space.middle + np.array([[0, 0, 0], [0.01, 0, 0], [0, 0.01, 0], [0, 0, 0.01]]), 1280, 720
    )
    assert right[0] > middle[0] + 1
    assert up[1] < middle[1] - 1
    assert near[1] > middle[1]
    assert pose.position[2] > film.space.all[:, 2].max()
    studio = film.scene.studio
    assert studio.floor == pytest.approx(film.space.all[:, 1].min())
    assert studio.centre == pytest.approx((film.space.middle[0], -film.space.middle[2], film.space.middle[1]))


@given(arrays(float, (30, 3), elements=st.floats(-1, 1)))
def test_the_prism_holds_every_vertex(vertices: np.ndarray):
    outline = prism(vertices)
    assert len(outline) <= 2 * len(vertices)
    directions = np.random.default_rng(0).normal(size=(50, 3))
    assert np.all((outline @ directions.T).max(axis=0) >= (vertices @ directions.T).max(axis=0) - 1e-12)


def test_parts_without_a_solid_are_refused(out_root: Path):
    out = film_fixture.write()
    parts = read_parts(out.parts)
    parts.bodies = {}
    with pytest.raises(UserError, match=r"four_bar: parts\.json has no solids"):
        Film(read_motion(out.motion), parts, Shot(trails=()), out.parts_folder)


def test_a_truncated_stl_is_refused(out_root: Path):
    out = film_fixture.write()
    path = out.parts_folder / "crank-crank.stl"
    path.write_bytes(path.read_bytes()[:-20])
    with pytest.raises(UserError, match=r"crank-crank\.stl is not a whole binary STL"):
        read_corners(path)
    with pytest.raises(UserError, match=r"crank-crank\.stl is not the file parts.json describes"):
        Film(read_motion(out.motion), read_parts(out.parts), Shot(), out.parts_folder)
