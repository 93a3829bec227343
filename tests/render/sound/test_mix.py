"""The mix: loudness by ffmpeg, peaks, loops without a click, equal bytes; two machines on their sides."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from mbsd import Mechanism, Solution
from mbsd.model.joint import KINDS
from render.film.story.frame import Over, Picture
from render.film.story.frame import Shot as StoryShot
from render.film.story.story import Story
from render.sound.desk import Desk
from render.sound.mix import loudness, mixed, true_peaks
from render.sound.setting import RATE, Setting
from render.sound.sound import STREAMS, Heard, sound_of, sound_of_all, stems_of, wav
from render.sound.waves import frequencies, shaped
from shared.contract.shot import Shot, Sound
from shared.stage.errors import UserError
from tests.render.sound.heard import ball, filmed, gears, measured
from tests.render.test_kinds import four_bar


def linkage() -> Solution:
    return four_bar(KINDS["revolute"]).sweep(steps=90)


def blow() -> Solution:
    """One blow in eight seconds, soon after the start."""
    m = Mechanism("blow", gravity=(0.0, -9.81))
    body = m.body("hammer", mass=0.1, inertia=1e-5)
    m.rigid_contact("anvil", m.ground.origin, body.origin, 0.01)
    m.start_near(hammer=(0.0, 0.11, 0.0))
    return m.simulate(8.0, steps=400)


@pytest.mark.parametrize("made", [ball, gears, linkage, blow], ids=lambda made: made.__name__)
def test_every_machine_has_sixteen_lufs_and_no_peak_that_clips(made, tmp_path: Path) -> None:
    file = tmp_path / "film.wav"
    file.write_bytes(wav(sound_of(filmed(made()))))
    level, peak = measured(file)
    assert abs(level + 16.0) < 0.3
    assert peak < -1.0


def test_loudness_is_that_of_the_recommendation_and_of_ffmpeg(tmp_path: Path) -> None:
    t = np.arange(80 * RATE) / RATE
    sine = np.sin(2 * np.pi * 1000 * t)
    assert loudness(np.stack([sine, sine])[:, : 20 * RATE] * 10 ** (-23 / 20)) == pytest.approx(-23.0, abs=0.1)
    level = np.where((t < 10) | (t > 70), 10 ** (-36 / 20), 10 ** (-23 / 20))  # EBU Tech 3341, case 3
    assert loudness(np.stack([sine, sine]) * level) == pytest.approx(-23.0, abs=0.1)
    noise = np.random.default_rng(1).normal(0, 0.05, (2, 6 * RATE)) * (1 + np.sin(2 * np.pi * 0.3 * t[: 6 * RATE]))
    (tmp_path / "noise.wav").write_bytes(wav(noise))
    assert loudness(noise) == pytest.approx(measured(tmp_path / "noise.wav")[0], abs=0.15)


def test_where_nothing_makes_a_sound_the_room_is_heard_and_is_quiet(tmp_path: Path) -> None:
    film = filmed(gears(), Shot(turns=40, sound=Sound(silent=("motor", "mesh", "A", "B", "load"))))
    (tmp_path / "room.wav").write_bytes(wav(sound_of(film)))
    level, peak = measured(tmp_path / "room.wav")
    assert level == pytest.approx(-50.0, abs=1.0)
    assert peak < -30.0
    setting = Setting(film)
    assert np.array_equal(
        mixed({}, setting.samples, 1), mixed({"none": np.zeros((2, setting.samples // 2 + 1))}, setting.samples, 1)
    )


@pytest.mark.parametrize(
    ("made", "shot"),
    [
        (gears, Shot(seconds_per_turn=1.0)),
        (linkage, Shot(fps=24)),
        (ball, Shot(hold=0.0)),
        (gears, Shot(seconds_per_turn=0.05)),
    ],
)
def test_a_film_loops_without_a_click_or_an_offset(made, shot: Shot) -> None:
    film = filmed(made(), shot)
    sound = sound_of(film)
    assert sound.shape == (2, round(film.clock.total / film.shot.fps * RATE))
    assert np.abs(sound.mean(axis=1)).max() < 1e-3
    ring = Setting(film).samples
    steps = np.abs(np.diff(sound[:, : ring + 1] if film.clock.showings > 1 else sound, axis=1))
    for seam in (ring - 1,) if film.clock.showings > 1 else ():
        assert (steps[:, seam] <= np.quantile(steps, 0.9999, axis=1)).all()
    assert (np.abs(sound[:, 0] - sound[:, -1]) <= np.quantile(steps, 0.9999, axis=1)).all()


@given(st.integers(64, 5000), st.integers(0, 50))
def test_noise_has_the_rms_one_by_its_spectrum(count: int, stream: int) -> None:
    assert np.sqrt((shaped(count, stream, frequencies(count) ** -0.5) ** 2).mean()) == pytest.approx(1.0, rel=1e-12)


def test_slow_changes_are_straight_between_their_values() -> None:
    desk = Desk(Setting(filmed(gears(), Shot(seconds_per_turn=0.37, fps=24))))
    values = np.random.default_rng(1).normal(size=desk.setting.steps + 1)
    samples = np.arange(desk.setting.samples) / desk.setting.samples * desk.setting.steps
    assert desk._fine(values) == pytest.approx(np.interp(samples, np.arange(len(values)), values), abs=1e-9)


def test_peaks_between_the_samples_count() -> None:
    t = np.arange(RATE) / RATE
    sine = 0.5 * np.sin(2 * np.pi * RATE / 4 * t + np.pi / 4)  # its samples reach 0.354
    peaks = true_peaks(np.stack([sine, 0.0 * sine]))
    assert len(peaks) == 1000
    assert np.allclose(peaks, 0.5, rtol=0.01)


def test_a_showing_that_takes_too_much_room_is_refused() -> None:
    with pytest.raises(
        UserError, match=r"gears: a showing of the film lasts 400 s, .* seconds_per_turn, or .* SOUND=off"
    ):
        sound_of(filmed(gears(), Shot(seconds_per_turn=400.0, turns=1)))


def test_the_same_motion_gives_the_same_bytes_and_the_machine_is_heard_from_where_it_is() -> None:
    first, again = (wav(sound_of(filmed(gears()))) for _ in range(2))
    assert first == again
    motion = filmed(ball()).motion
    moved = [x + 0.08 for x in motion.contacts["floor"].x]
    motion.contacts["floor"].x[:] = moved
    left, right = np.sqrt((sound_of(filmed(motion)) ** 2).mean(axis=1))
    assert right > 1.5 * left


def test_a_kind_that_nobody_knows_sounds_as_what_it_says_it_is() -> None:
    from dataclasses import replace

    hinge = replace(KINDS["revolute"], name="hinge", sign="revolute")
    known, new = (wav(sound_of(filmed(four_bar(kind).sweep(steps=90)))) for kind in (KINDS["revolute"], hinge))
    assert known == new


LEFT, RIGHT = (-1.0, 0.0), (0.0, 1.0)
MESH = Shot(sound=Sound(without=("motors", "friction", "knocks")))


def powers(sound: np.ndarray) -> np.ndarray:
    return (sound**2).mean(axis=1)


def test_each_machine_is_heard_on_the_side_of_its_picture() -> None:
    loud, quiet = (filmed(gears(teeth=teeth), MESH) for teeth in ((20, 20), (24, 24)))
    for joint in loud.motion.joints.values():
        joint.fx, joint.fy = (np.array(joint.fx) * 30).tolist(), (np.array(joint.fy) * 30).tolist()
    time_map = loud.clock.time_map
    left, right = powers(sound_of_all([Heard(loud, time_map, LEFT), Heard(quiet, time_map, RIGHT)]))
    assert left > 1.6 * right
    left, right = powers(sound_of_all([Heard(quiet, time_map, LEFT), Heard(loud, time_map, RIGHT)]))
    assert right > 1.6 * left


def test_places_of_a_machine_stay_in_its_half() -> None:
    film = filmed(gears())
    x = np.asarray(film.motion.joints["B"].x)
    whole, half = (Setting(film, within=within).side(x, 0 * x) for within in ((-1.0, 1.0), RIGHT))
    assert half == pytest.approx((whole + 0.8) / 2)
    assert Setting(film, within=LEFT).side_of("ground") == pytest.approx(-0.4)


def test_noises_of_two_machines_have_nothing_to_do_with_each_other() -> None:
    film = filmed(gears(), Shot(sound=Sound(without=("mesh", "motors", "knocks"))))
    first, again, other = (
        stems_of(Setting(film, film.clock.time_map, streams=streams))["friction"][0] for streams in (0, 0, STREAMS)
    )
    assert np.array_equal(first, again)

    def alike(a: np.ndarray, b: np.ndarray) -> float:
        return float(abs(np.vdot(a, b)) / (np.linalg.norm(a) * np.linalg.norm(b)))

    assert alike(first, again) == pytest.approx(1.0)
    assert alike(first, other) < 0.2


def test_a_motion_without_a_period_is_silent_once_it_stands_at_its_end() -> None:
    film = filmed(ball(seconds=1.0))
    end = film.clock.end
    shot = StoryShot("motion", "", 3 * end, lambda s: Picture(at=0.0, camera=None), lambda s: Over(), lambda s: s)  # pyright: ignore[reportArgumentType]
    story = Story("ball", 30, 1, [shot])
    stands, anew = (story.time_map(0.0, end, again) for again in (False, True))
    late = np.linspace(end + 0.05, 2.9 * end, 20)
    assert stands.moments_at(late)[0] == pytest.approx(end)
    assert not stands.moments_at(late)[1].any()
    assert stands.moments_at(late)[1].max() < anew.moments_at(late)[1].min()
    impact = [event.time for event in film.motion.events][:1]
    assert len(stands.when(np.array(impact))[0]) == 1 < len(anew.when(np.array(impact))[0])
