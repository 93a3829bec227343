"""Two machines heard beside each other: each on its side, the louder one louder, noises apart."""

from __future__ import annotations

import numpy as np
import pytest

from render.film.story.frame import Over, Picture, Shot
from render.film.story.story import Story
from render.sound.setting import Setting
from render.sound.sound import STREAMS, Heard, sound_of_all, stems_of
from shared.contract.shot import Shot as Wishes
from shared.contract.shot import Sound
from tests.render.sound.heard import ball, filmed, gears

LEFT, RIGHT = (-1.0, 0.0), (0.0, 1.0)
MESH = Wishes(sound=Sound(without=("motors", "friction", "knocks")))


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
    film = filmed(gears(), Wishes(sound=Sound(without=("mesh", "motors", "knocks"))))
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
    shot = Shot("motion", "", 3 * end, lambda s: Picture(at=0.0, camera=None), lambda s: Over(), lambda s: s)  # pyright: ignore[reportArgumentType]
    story = Story("ball", 30, 1, [shot])
    stands, anew = (story.time_map(0.0, end, again) for again in (False, True))
    late = np.linspace(end + 0.05, 2.9 * end, 20)
    assert stands.moments_at(late)[0] == pytest.approx(end)
    assert not stands.moments_at(late)[1].any()
    assert stands.moments_at(late)[1].max() < anew.moments_at(late)[1].min()
    impact = [event.time for event in film.motion.events][:1]
    assert len(stands.when(np.array(impact))[0]) == 1 < len(anew.when(np.array(impact))[0])
