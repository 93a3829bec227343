"""The camera holds the whole motion or follows a machine that leaves; poses at any moment."""

from __future__ import annotations

import math
from pathlib import Path

import msgspec
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from render.film import composing
from render.film.clock import Clock
from render.film.film import Film
from render.film.framing import NEAREST, SENSOR, CameraPose, axes, depth_of_field, fit, project
from render.film.poses import Moment, Poses, hermite
from render.film.solids import prism, read_corners, swept
from render.presets import ASPECTS
from shared.contract import Mount, mounted, read_motion, read_parts
from shared.contract.shot import Camera, Shot, Title
from shared.stage.errors import UserError
from tests.render.planar import in_plane
from tools.fixtures import film_fixture
from tools.models.motions import bouncing_ball, four_bar_motion

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


def test_points_right_up_and_near_land_right_up():
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
                corners = swept(read_corners(out.parts_folder / piece.stl), np.array([in_plane(state.bodies[body])]))
                extremes.append(project(state.camera, corners, *shape) / shape)
    pixels = np.concatenate(extremes)
    assert pixels.min() >= 0.08 - 2e-3
    assert pixels.max() <= 0.92 + 2e-3
    assert pixels[:, 1].min() >= 0.08 + above - 2e-3
    assert pixels[:, 1].max() <= 0.92 - above + 2e-3
    left = (0.84 - 2 * above) / 0.84  # of the height, by words and a legend
    assert (np.ptp(pixels, axis=0) / (1, left)).max() > (0.65 if orbit else 0.6)  # 0.8, less for a plate that is whole


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


TIME = np.linspace(0.0, 1.0, 61)
BOX = np.array([[x, y, z] for x in (-0.1, 0.1) for y in (-0.05, 0.05) for z in (0.0, 0.02)])


def along(x: np.ndarray, y: np.ndarray) -> np.ndarray:
    """A box whose middle is at these places (T,)."""
    return BOX + np.stack([x, y, 0 * x], axis=1)[:, None]


def test_travelling_mechanisms_are_told_from_others():
    still = 0 * TIME
    car, slow = along(3 * TIME, still), along(0.1 * TIME, still)
    thrown = along(2 * TIME, 4 * TIME * (1 - TIME))
    round_trip = along(np.sin(np.pi * TIME) * 2, still)
    orbiting = along(np.cos(2 * np.pi * TIME), np.sin(2 * np.pi * TIME))
    swinging = np.concatenate([along(2 * TIME, still), along(still, still)], axis=1)  # its pivot stays
    assert composing.travels(car, False)
    assert composing.travels(thrown, False)
    for places in (slow, round_trip, orbiting, swinging):
        assert not composing.travels(places, False)
    assert not composing.travels(car, True)


@given(st.integers(0, 10**6), st.floats(1.0, 20.0))
def test_the_way_is_smooth_stays_within_what_it_follows_and_closes_where_the_film_does(seed: int, width: float):
    values = np.random.default_rng(seed).normal(size=(80, 3)).cumsum(axis=0)
    held, closed = (composing.damped(values, width, repeats) for repeats in (False, True))
    for way in (held, closed):
        assert (way >= values.min(axis=0) - 1e-12).all()
        assert (way <= values.max(axis=0) + 1e-12).all()
    turned = composing.damped(np.roll(values, 17, axis=0), width, True)
    assert turned == pytest.approx(np.roll(closed, 17, axis=0))
    steps = np.abs(np.diff(values, axis=0)).max()
    assert np.abs(np.diff(held, axis=0)).max() <= steps + 1e-12
    even = np.outer(np.arange(200.0), [1.0, 2.0, 3.0])  # what goes evenly is followed without a lag
    assert composing.damped(even, width, False)[90:110] == pytest.approx(even[90:110])


def travelling(out_root: Path, mount: Mount, follow: bool | None = None) -> Film:
    """The four-bar carried along by three metres, seen in its plane."""
    shot = Shot(camera=Camera(follow=follow), seconds_per_turn=2.0, hold=0.5, fps=20)
    out = film_fixture.write(shot, mount=mount)
    motion = msgspec.structs.replace(read_motion(out.motion), period=None)
    time = np.asarray(motion.time)
    for body in (*motion.bodies.values(), *motion.points.values()):
        body.x = (np.asarray(body.x) + 3.0 * time).tolist()
        body.vx = (np.asarray(body.vx) + 3.0).tolist()
    return Film(motion, read_parts(out.parts), shot, out.parts_folder, 4 / 5)


@pytest.mark.parametrize("mount", [mounted((0.0, 0.0)), mounted((0.0, -9.81)), mounted((3.0, 4.0), "wall")])
def test_a_machine_that_goes_away_is_always_in_the_frame_large_and_steady(out_root: Path, mount: Mount):
    film, still = travelling(out_root, mount), travelling(out_root, mount, follow=False)
    frames = range(film.clock.frames)
    seen = []
    for frame in frames:
        at = film.clock.moment(frame)
        points = film.space.places(np.array([at.time]))[0]
        seen.append(project(film.camera(frame), points, 4, 5) / [4, 5])
    parts = np.concatenate(seen)
    assert parts.min() >= 0.09 - 2e-3
    assert parts.max() <= 0.91 + 2e-3
    assert np.ptp(parts, axis=0).max() >= 0.8
    way = np.array([film.camera(frame).position for frame in frames])
    assert np.linalg.norm(way[-1] - way[0]) > 2.0
    jerk = np.abs(np.diff(way, n=3, axis=0)).max()
    assert jerk < 1e-3 * np.ptp(way, axis=0).max()
    steps = np.linalg.norm(np.diff(way[film.clock.moving :], axis=0), axis=1)
    assert (np.diff(steps) <= 1e-12).all()  # it comes to rest while the motion is held
    assert len({film.camera(frame).azimuth for frame in frames}) == 1
    assert len({still.camera(frame) for frame in frames}) == 1
    assert film.size < still.size / 3
    again = travelling(out_root, mount)
    assert [again.camera(frame) for frame in frames] == [film.camera(frame) for frame in frames]


MOTION = four_bar_motion()
FINE = four_bar_motion(steps=360 * 7)


@given(st.lists(st.floats(-2, 2), min_size=6, max_size=6), st.floats(0, 1))
def test_a_quintic_is_reproduced_exactly(coefficients: list[float], t: float):
    f = np.polynomial.Polynomial(coefficients)
    time = np.array([0.0, 0.3, 0.4, 1.0])
    interpolated = hermite(time, f(time), f.deriv(1)(time), f.deriv(2)(time), t)
    assert interpolated[0] == pytest.approx(f(t), abs=1e-12)


def test_between_samples_the_four_bar_is_met_to_a_picometre():
    poses = Poses(MOTION)
    for name, body in FINE.bodies.items():
        interpolated = np.array([poses.body(name, Moment(t, 0)) for t in FINE.time])
        exact = np.stack([body.x, body.y, body.theta], axis=1)
        assert np.abs(interpolated - exact).max() < 1e-10
    path = poses.point("P", np.asarray(FINE.time))
    assert np.abs(path - np.stack([FINE.points["P"].x, FINE.points["P"].y], axis=1)).max() < 1e-12


@given(st.integers(-500, 500), st.integers(1, 240))
def test_the_film_loops_without_a_jump(frame: int, count: int):
    poses = Poses(MOTION)
    clock = Clock(MOTION, Shot(seconds_per_turn=float(count), fps=1))
    now, later = clock.moment(frame), clock.moment(frame + count)
    assert now.time == later.time
    for name in MOTION.bodies:
        x, y, theta = poses.body(name, now)
        x1, y1, theta1 = poses.body(name, later)
        assert (x, y) == (x1, y1)
        turn = math.tau if name == "crank" else 0.0
        assert theta1 - theta == pytest.approx(turn, abs=1e-12)


def test_angles_go_on_over_the_seam():
    poses, clock = Poses(MOTION), Clock(MOTION, Shot(seconds_per_turn=12.0, fps=1))
    angles = [poses.body("crank", clock.moment(frame))[2] for frame in range(-3, 30)]
    assert np.diff(angles) == pytest.approx(math.tau / 12)


def test_a_joint_moves_with_its_second_body():
    poses = Poses(MOTION)
    for name, joint in MOTION.joints.items():
        for index in range(0, 360, 17):
            assert poses.joint(name, Moment(MOTION.time[index], 0)) == pytest.approx(
                (joint.x[index], joint.y[index]), abs=1e-9
            )


@pytest.mark.parametrize("cut", [0, 1])
def test_an_impact_is_met_from_both_sides(cut: int) -> None:
    """Free flight is a parabola, so quintics are exact before, at and after the impact; ``cut``: it comes last."""
    ball = bouncing_ball(steps=6)
    strike = ball.events[0].time
    poses = Poses(ball)
    if cut:
        poses.time = poses.time[: ball.time.index(strike) + 2]
    for t in np.linspace(0.0, strike if cut else ball.time[-1], 41):
        x, y, theta = poses.body("ball", Moment(float(t), 0))
        late = t - strike
        exact = 1 - 9.81 * t * t / 2 if t < strike else 0.5 * 9.81 * strike * late - 9.81 * late**2 / 2
        assert y == pytest.approx(exact, abs=1e-12)
        assert (x, theta) == (0.0, 0.0)
