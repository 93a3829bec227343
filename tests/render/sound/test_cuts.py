"""Where a story cuts to another moment: no click, no burst of teeth, no gap where a period begins anew."""

from __future__ import annotations

import numpy as np
import pytest

from mbsd.model.joint import KINDS
from render.film.clock import TimeMap
from render.sound.setting import CONTROL, RATE, Setting
from render.sound.sound import sound_of
from render.sound.sources.mesh import crossings, teeth_passed
from tests.render.sound.heard import ball, filmed, gears
from tests.render.test_kinds import four_bar

CUT = 1.5
"""Film second at which each map here jumps."""


def cut_map(film, before: tuple[float, float], after: tuple[float, float]) -> TimeMap:
    """Parts of the motion before the cut and after it, each in its 1.5 s."""
    start, end = film.clock.start, film.clock.end
    moments = [start + part * (end - start) for part in (*before, *after)]
    return TimeMap.from_moments([0.0, CUT, CUT, 2 * CUT], moments, closes=False)


def linkage():
    return four_bar(KINDS["revolute"]).sweep(steps=90)


@pytest.mark.parametrize("made", [gears, linkage], ids=lambda made: made.__name__)
@pytest.mark.parametrize("after", [(0.2, 0.4), (0.75, 1.0)], ids=["back", "on"])
def test_a_cut_does_not_click(made, after: tuple[float, float]) -> None:
    """The second difference of the wave, in which a click stands out, is there as it is around."""
    film = filmed(made())
    film.shot = type(film.shot)(sound=type(film.shot.sound)(without=("impacts", "knocks")))
    bent = np.abs(np.diff(sound_of(film, cut_map(film, (0.31, 0.48), after)), 2, axis=1)).max(axis=0)
    at, near, far = round(CUT * RATE), round(0.002 * RATE), round(0.25 * RATE)
    around = np.concatenate([bent[at - far : at - 5 * near], bent[at + 5 * near : at + far]])
    assert bent[at - near : at + near].max() < 2.0 * around.max()


def test_teeth_that_a_cut_leaves_out_are_not_heard() -> None:
    film = filmed(gears())
    setting = Setting(film, cut_map(film, (0.31, 0.48), (0.0, 0.2)))
    shape = film.motion.joints["mesh"].shape
    phase = setting.continued(teeth_passed(setting, shape))
    film_seconds = crossings(setting.at, phase)
    assert len(film_seconds) == pytest.approx(20 * 0.37, abs=1)
    assert (np.abs(film_seconds - CUT) < 3 / CONTROL).sum() <= 1
    assert setting.jumps.sum() == 1
    assert np.diff(phase).max() < 2 * np.median(np.diff(phase))


def test_slower_and_faster_passages_are_no_jumps() -> None:
    film = filmed(gears())
    start, end = film.clock.start, film.clock.end
    third = start + (end - start) / 3
    setting = Setting(film, TimeMap.from_moments([0.0, 0.7003, 0.9001, 1.5], [start, third, third, end], closes=False))
    assert not setting.jumps.any()
    way = setting.series(np.asarray(film.motion.time))
    assert np.array_equal(setting.continued(way), way)


def test_a_period_that_begins_anew_has_no_gap_and_a_cut_has_one() -> None:
    film = filmed(gears())
    at = round(CUT * CONTROL)
    anew = Setting(film, cut_map(film, (0.0, 1.0), (0.0, 1.0)))
    assert anew.fade[at - 20 : at + 20].min() == 1.0
    assert anew.fade[0] == 0.0
    cut = Setting(film, cut_map(film, (0.0, 0.9), (0.0, 1.0)))
    assert cut.fade[at] < 0.1


def test_a_story_of_a_prime_number_of_frames_is_made_as_quickly_and_is_as_long() -> None:
    """Its last moment is held to a length whose spectrum is quickly made; what it is until then is heard as it was."""
    film = filmed(gears())
    frames = 89
    heard = TimeMap.from_moments([0.0, frames / 30], [film.clock.start, film.clock.end], closes=False)
    setting = Setting(film, heard)
    assert setting.heard_samples == frames * RATE // 30
    assert 0 <= setting.samples - setting.heard_samples < 0.05 * setting.heard_samples
    left = setting.samples
    for prime in (2, 3, 5):
        while left % prime == 0:
            left //= prime
    assert left == 1
    assert sound_of(film, heard).shape == (2, setting.heard_samples)
    at = np.linspace(0.0, frames / 30, 50, endpoint=False)
    assert np.array_equal(setting.map.moments_at(at), heard.moments_at(at))
    moment, rate = setting.map.moments_at(np.array([setting.seconds]))
    assert (moment[0], rate[0]) == (film.clock.end, 0.0)
    assert Setting(film).samples == Setting(film).heard_samples == round(film.clock.time_map.seconds * RATE)


def test_impacts_are_heard_in_the_frame_that_shows_them_through_ramps_and_cuts() -> None:
    """Slower and slower into the first bounce, on at another rate, and a cut back before it."""
    film = filmed(ball())
    first = next(event.time for event in film.motion.events if event.what == "impact")
    seconds = [0.0, 0.3, 0.6, 1.2, 1.8, 1.8, 2.4]
    moments = [first - 0.14, first - 0.05, first - 0.02, first + 0.01, first + 0.1, first - 0.06, first + 0.06]
    heard = TimeMap.from_moments(seconds, moments, closes=False)
    times = heard.when(np.array([first]))[0]
    assert times == pytest.approx([1.0, 2.1])
    sound = np.abs(sound_of(film, heard)).max(axis=0)
    for time in times:
        at = round(time * RATE)
        before, blow = sound[at - 2400 : at - 240], sound[at - 240 : at + 1600]
        onset = int(np.argmax(blow > max(0.2 * blow.max(), 2 * before.max()))) - 240
        assert abs(onset) < RATE / 1000, (time, onset)
        shown = [heard.moments_at(np.array([k / 30]))[0][0] for k in (int(time * 30), int(time * 30) + 1)]
        assert shown[0] <= first + 1e-9
        assert first <= shown[1] + 1e-9
