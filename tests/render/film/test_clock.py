"""The film's clock: periods without a seam; what does not repeat plays forwards, holds, and begins anew."""

from __future__ import annotations

import math
from pathlib import Path

import msgspec
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from render.blender.scene.tubes import CAP
from render.blender.scene.tubes import TRAIL_SIDES as SIDES
from render.blender.scene.tubes import trail_vertices as vertices
from render.film.clock import LONGEST, SHORTEST, Clock, natural_rate, speed, turns_of
from render.film.film import Film
from render.film.poses import Poses
from render.film.tubes.trails import MOST_RINGS, STRAY, Trails
from render.frames.frames import Pictures
from render.presets import PRESETS
from shared.contract import Motion, read_motion, read_parts
from shared.contract.shot import Camera, Shot, Trail, read_shot, write_shot
from shared.stage.errors import UserError
from shared.stage.paths import Out
from tools.fixtures import film_fixture
from tools.models.motions import bouncing_ball, four_bar_motion

MOTION = four_bar_motion(steps=72)
BALL = bouncing_ball(steps=40)  # 0.903 s


def once(seconds: float) -> Motion:
    """The ball's motion, stretched to so many seconds; only its times count."""
    factor = seconds / BALL.time[-1]
    return msgspec.structs.replace(BALL, time=[factor * t for t in BALL.time], events=[])


@given(st.floats(1e-6, 1e6))
def test_the_natural_rate_is_real_time_or_a_round_factor(seconds: float) -> None:
    rate = natural_rate(seconds)
    assert SHORTEST <= seconds / rate <= LONGEST
    if SHORTEST <= seconds <= LONGEST:
        assert rate == 1.0
    mantissa = rate / 10.0 ** math.floor(math.log10(rate) + 1e-9)
    assert min(abs(mantissa - step) for step in (1.0, 2.0, 5.0)) < 1e-9


@pytest.mark.parametrize(
    ("seconds", "said"),
    [
        (4.0, "in real time"),
        (0.02, "slowed 50 times"),
        (90.0, "5 times faster"),
        (0.7, "slowed 2 times"),
        (0.0008, "slowed 2000 times"),
    ],
)
def test_the_rate_is_said(seconds: float, said: str) -> None:
    clock = Clock(once(seconds), Shot())
    assert clock.said().endswith(said)
    assert speed(clock.rate) == said


@given(st.floats(0.01, 100.0), st.integers(1, 60), st.floats(0.0, 3.0))
def test_a_motion_without_a_period_plays_holds_and_begins_anew(seconds: float, fps: int, hold: float) -> None:
    motion = once(seconds)
    clock = Clock(motion, Shot(fps=fps, hold=hold))
    times = np.array([clock.moment(frame).time for frame in range(clock.frames)])
    assert times[0] == motion.time[0]
    assert times[clock.moving] == times[-1] == motion.time[-1]
    assert (np.diff(times[: clock.moving + 1]) > 0).all()
    assert not np.diff(times[clock.moving :]).any()
    assert clock.frames - clock.moving == max(1, round(hold * fps))
    assert [clock.moment(frame + 2 * clock.frames) for frame in range(0, clock.frames, 7)] == [
        clock.moment(frame) for frame in range(0, clock.frames, 7)
    ]


def test_real_time_is_real_time() -> None:
    clock = Clock(once(2.0), Shot(fps=30))
    assert clock.moving == 60
    assert np.diff([clock.moment(frame).time for frame in range(61)]) == pytest.approx(1 / 30)
    assert clock.total == 3 * (60 + 30)
    assert Clock(once(2.0), Shot(rate=0.25)).moving == 240
    assert Clock(once(2.0), Shot(seconds_per_turn=5.0)).moving == 150


def test_a_film_is_turns_of_equal_length() -> None:
    assert Clock(MOTION, Shot(turns=3, seconds_per_turn=4.0, fps=30)).total == 360
    assert Clock(MOTION, Shot(turns=1, seconds_per_turn=0.001, fps=1)).total == 1
    assert Clock(MOTION, Shot(rate=0.5, fps=30)).frames == 60  # a turn of a second


def test_a_shutter_does_not_see_the_end_before_the_start() -> None:
    clock = Clock(once(2.0), Shot())
    assert clock.around(0) == (0, 0, 1)
    assert clock.around(90) == (90, 90, 91)
    assert clock.around(89) == (88, 89, 89)
    assert clock.around(5) == (4, 5, 6)
    assert Clock(MOTION, Shot()).around(0) == (-1, 0, 1)  # a period goes on


def test_a_period_of_many_turns_is_slow_enough_to_see() -> None:
    def geared(turns: int) -> Motion:
        motor = msgspec.structs.replace(
            MOTION.drivers["motor"], value=np.linspace(0, turns * math.tau, len(MOTION.time)).tolist()
        )
        return msgspec.structs.replace(MOTION, drivers={"motor": motor})

    assert [turns_of(geared(turns)) for turns in (1, 2, 6, 40)] == [1, 2, 6, 40]
    assert [Clock(geared(turns), Shot()).frames for turns in (1, 2, 3, 6, 40)] == [120, 240, 360, 360, 360]
    assert [Clock(geared(turns), Shot(turns=3)).showings for turns in (1, 2, 3, 6)] == [3, 2, 1, 1]
    assert Clock(geared(6), Shot(seconds_per_turn=4.0)).frames == 720


def test_a_shot_says_once_how_fast_it_goes(tmp_path: Path) -> None:
    with pytest.raises(UserError, match="rate and seconds_per_turn both say how fast"):
        write_shot(tmp_path / "shot.json", Shot(rate=1.0, seconds_per_turn=2.0))
    write_shot(tmp_path / "shot.json", Shot(rate=0.1, hold=0.5))
    assert read_shot(tmp_path / "shot.json") == Shot(rate=0.1, hold=0.5)


def ball_film(out_root: Path, shot: Shot, motion: Motion = BALL) -> Film:
    """The ball's motion with the solids of the picture tests on its body."""
    out = film_fixture.write(shot)
    parts = read_parts(out.parts)
    bodies = {"ball": parts.bodies["crank"], "ground": parts.bodies["ground"]}
    parts = msgspec.structs.replace(parts, mechanism="ball", bodies=bodies)
    return Film(motion, parts, shot, out.parts_folder)


def test_a_trail_grows_from_the_start_and_keeps_its_corner(out_root: Path) -> None:
    film = ball_film(out_root, Shot(trails=(Trail(point="P", tail=1.0),)))
    strike = BALL.events[0].time
    first, late = (np.array(film.state(frame).trails[0]) for frame in (0, film.clock.frames - 1))
    assert np.ptp(first, axis=0).max() == 0.0
    assert late[0, 1] == pytest.approx(BALL.points["P"].y[-1])
    assert late[-1, 1] == pytest.approx(1.0)
    assert late[:, 1].min() == pytest.approx(0.0, abs=1e-12)  # where it struck
    assert (np.diff(np.sign(np.diff(late[:, 1]))) != 0).sum() <= 2
    assert strike < BALL.time[-1]


def test_trails_of_any_length_stray_by_less_than_their_thickness(out_root: Path) -> None:
    """A point that goes round a hundred times has rings enough to be round."""
    time = np.linspace(0.0, 100.0, 36001)
    angle = math.tau * time
    zero = np.zeros_like(time).tolist()
    x, y = 0.1 * np.cos(angle), 0.1 * np.sin(angle)
    columns = {
        "x": x.tolist(), "y": y.tolist(),
        "vx": (-math.tau * y).tolist(), "vy": (math.tau * x).tolist(),
        "ax": (-(math.tau**2) * x).tolist(), "ay": (-(math.tau**2) * y).tolist(),
    }  # fmt: skip
    body = msgspec.structs.replace(BALL.bodies["ball"], **columns, theta=zero, omega=zero, alpha=zero)
    point = msgspec.structs.replace(BALL.points["P"], **columns)
    motion = msgspec.structs.replace(
        BALL, time=time.tolist(), bodies={"ball": body}, points={"P": point}, events=[],
        energy=msgspec.structs.replace(BALL.energy, kinetic=zero, potential=zero),
        diagnostics=msgspec.structs.replace(BALL.diagnostics, singularity_margin=zero),
    )  # fmt: skip
    for tail in (0.02, 0.2, 1.0):
        trail = Trail(point="P", tail=tail)
        film = ball_film(out_root, Shot(trails=(trail,)), motion)
        path = np.array(film.state(film.clock.moving).trails[0])[:, :2]
        middles = (path[1:] + path[:-1]) / 2
        stray = (0.1 - np.hypot(*middles.T)).max()
        rings = film.scene.trails[0].rings
        assert len(path) == rings
        allowed = STRAY * trail.radius * film.space.size
        assert stray <= 1.01 * allowed or rings == MOST_RINGS
        assert stray < 0.1 * 0.02


def test_the_tube_of_a_point_that_stands_keeps_its_direction() -> None:
    moving = [(0.0, 0.1 * k, 0.0) for k in range(5, 0, -1)]
    standing = [moving[0]] * 6
    rim = vertices(standing + moving, 0.01)[CAP * SIDES :].reshape(-1, SIDES, 3)
    assert np.abs(rim[:, :, 1] - rim[:, :1, 1]).max() < 1e-7  # every ring is across the way, which goes along y


def test_held_frames_are_one_picture_and_showings_share_all(out_root: Path) -> None:
    film = ball_film(out_root, Shot(camera=Camera(follow=False), trails=(Trail(point="P"),)))
    made = Pictures(film, PRESETS["draft"])
    clock = film.clock
    held = {made.key(frame) for frame in range(clock.moving, clock.frames)}
    assert len(held) == 1
    assert made.key(3) == made.key(3 + clock.frames)
    assert made.key(0) != made.key(clock.moving)
    blurred = Pictures(film, PRESETS["final"])
    job = blurred.job([0], _Store())  # pyright: ignore[reportArgumentType]
    before, at, after = job.states[:3]
    assert before == at
    assert after != at


class _Store:
    folder, plates = Path("frames"), Path("frames/plates")


def test_the_swept_space_holds_the_whole_motion(out_root: Path) -> None:
    film = ball_film(out_root, Shot(trails=()))
    low, high = film.space.all.min(axis=0), film.space.all.max(axis=0)
    assert high[1] - low[1] > 1.0  # it falls a metre


def test_the_film_of_a_four_bar_is_as_before(out_root: Path) -> None:
    out = film_fixture.write(Shot())
    film = Film(read_motion(out.motion), read_parts(out.parts), Shot(), Out("four_bar").parts_folder)
    assert (film.clock.frames, film.clock.showings, film.clock.total) == (120, 3, 360)
    assert film.scene.trails[0].rings == 160
    assert film.clock.frame_at(0.3) == 36


def test_a_trail_in_ink_does_not_shine_in_any_look():
    ball = bouncing_ball(restitution=1.0)
    shot = Shot(
        trails=(Trail(point="P"), Trail(point="P", ink=True), Trail(point="P", colour=(0.5, 0.0, 0.0), ink=True))
    )
    trails = Trails(Poses(ball), Clock(ball, shot), shot, {"P": 0.0}, 1.0)
    light, ink, own = trails.specs(dark=True)
    bright = trails.specs(dark=False)[0]
    assert (ink.colour, ink.strength) == (bright.colour, bright.strength)
    assert light.strength > ink.strength == own.strength
    assert sum(light.colour) > 2 * sum(ink.colour)
    assert own.colour == (0.5, 0.0, 0.0)


def test_a_trail_turns_sharply_at_an_impact_also_where_it_goes_back_beyond_the_start_of_a_period():
    ball = bouncing_ball(restitution=1.0)
    ball = msgspec.structs.replace(ball, period=ball.time[-1])
    shot = Shot(trails=(Trail(point="P", tail=0.6),))
    poses, clock = Poses(ball), Clock(ball, shot)
    trails = Trails(poses, clock, shot, {"P": 0.0}, 1.0)
    strike, seen = ball.events[0].time, 0
    for frame in range(clock.frames):
        [path] = trails.paths(frame)
        now = clock.moment(frame).time
        assert path[0][:2] == pytest.approx(poses.point("P", np.array([now]))[0])
        if (now - strike) % ball.time[-1] < 0.59 * ball.time[-1]:
            seen += 1
            assert min(y for _, y, _ in path) == pytest.approx(0.0, abs=1e-9), frame
    assert seen > clock.frames / 2
