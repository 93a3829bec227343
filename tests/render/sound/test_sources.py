"""Sources of sound: at their events and frequencies, by the film's own time, without a click at cuts."""

from __future__ import annotations

import math
from typing import get_args

import numpy as np
import pytest

from mbsd.model.joint import KINDS
from render.film.clock import TimeMap
from render.sound.ringing import OTHER, matter, modes_of
from render.sound.setting import CONTROL, RATE, Setting
from render.sound.sound import SOURCES, sound_of, stems_of
from render.sound.sources.mesh import crossings, teeth_passed
from shared.contract.materials import MATERIALS
from shared.contract.shot import Shot, Sound, Source
from tests.render.sound.heard import ball, bar, filmed, gears
from tests.render.test_kinds import four_bar


@pytest.mark.parametrize("rate", [1.0, 0.25])
def test_impacts_are_heard_within_a_millisecond_of_their_events(rate: float) -> None:
    film = filmed(ball(), Shot(rate=rate, turns=1))
    sound = np.abs(sound_of(film)).max(axis=0)
    impacts = [event.time for event in film.motion.events if event.what == "impact"][:3]
    assert impacts[0] == pytest.approx(math.sqrt(2 * 0.1 / 9.81))
    for time in impacts:
        at = round(time * film.clock.moving / film.shot.fps * RATE / film.motion.time[-1])
        before, blow = sound[at - 2400 : at - 48], sound[at - 48 : at + 960]
        first = int(np.argmax(blow > max(0.2 * blow.max(), 2 * before.max())))
        assert abs(first - 48) <= 48, (rate, time)


@pytest.mark.parametrize(("rate", "frequency"), [(1.0, 200.0), (0.5, 100.0)])
def test_teeth_are_heard_at_their_frequency_which_slow_motion_lowers(rate: float, frequency: float) -> None:
    film = filmed(gears(10.0), Shot(rate=rate, turns=40, sound=Sound(silent=("motor", "A", "B"))))
    sound = sound_of(film).sum(axis=0)
    f = np.fft.rfftfreq(len(sound), 1 / RATE)
    heard = (f > 60) & (f < 1.9 * frequency)
    highest = f[heard][np.abs(np.fft.rfft(sound))[heard].argmax()]
    assert highest == pytest.approx(frequency, rel=0.01)


def test_each_tooth_passes_once() -> None:
    for teeth in ((20, 20), (15, 45)):
        film = filmed(gears(2.0, teeth), Shot(seconds_per_turn=1.0, turns=1))
        setting = Setting(film)
        shape = film.motion.joints["mesh"].shape
        passed = crossings(setting.at, teeth_passed(setting, shape))
        turns = round(abs(film.motion.drivers["motor"].value[-1]) / math.tau)
        assert abs(len(passed) - turns * teeth[0]) <= 1
        assert np.ptp(np.diff(passed)) < 1e-6


def test_silenced_sources_are_not_heard() -> None:
    heard = stems_of(Setting(filmed(gears())))
    assert {"mesh", "motors", "friction"} <= set(heard)
    silent = stems_of(Setting(filmed(gears(), Shot(sound=Sound(silent=("motor", "mesh", "A", "B", "load"))))))
    assert not [name for name, stem in silent.items() if np.abs(stem).max() > 0]
    assert set(stems_of(Setting(filmed(gears(), Shot(sound=Sound(without=("motors", "mesh"))))))) == set(heard) - {
        "motors",
        "mesh",
    }


def test_every_source_that_a_shot_may_leave_out_is_there() -> None:
    assert {source.NAME for source in SOURCES} == set(get_args(Source))


def test_the_motor_is_heard_on_its_harmonics_alone() -> None:
    shot = Shot(seconds_per_turn=1.0, turns=1, sound=Sound(silent=("mesh", "A", "B")))
    film = filmed(gears(), shot)
    stem = np.abs(stems_of(Setting(film))["motors"]).sum(axis=0)
    f = np.arange(len(stem)) / film.clock.time_map.seconds
    strong = f[stem > 0.05 * stem.max()]
    assert strong.min() == pytest.approx(40.0, rel=0.3)
    assert np.allclose(strong / strong.min(), np.rint(strong / strong.min()), atol=0.02)


def test_a_free_bar_rings_as_euler_and_bernoulli_say() -> None:
    modes = modes_of(bar(0.2, 0.02, 0.005))
    assert modes is not None
    flat = 4.730**2 / (2 * math.pi * 0.2**2) * 0.005 * math.sqrt(205e9 / (12 * 7850))
    assert modes.frequency[0] == pytest.approx(flat, rel=1e-6)
    assert any(abs(f / (4 * flat) - 1) < 1e-6 for f in modes.frequency)  # on edge it is four times as high
    response = modes.response(RATE, RATE)
    spectrum = np.abs(np.fft.rfft(response))
    assert min(abs(f - spectrum.argmax()) for f in modes.frequency) < 5.0
    assert modes.response(480, RATE).sum() == pytest.approx(modes.response(48_000, RATE).sum(), rel=1e-3)


def test_every_material_rings_as_one_of_its_family() -> None:
    for name, known in MATERIALS.items():
        assert matter(name).density == known.density
        assert name.startswith("aluminium") or (matter(name).modulus, matter(name).loss) != OTHER, name


def test_a_film_that_cuts_shows_moments_twice_or_not_at_all() -> None:
    slow = TimeMap.from_moments([0.0, 1.0, 3.0, 3.0, 4.0, 5.0], [0.0, 1.0, 1.5, 1.0, 2.0, 2.0], closes=False)
    assert slow.seconds == 5.0
    assert slow.cuts == [0.0, 3.0]
    model, rate = slow.moments_at(np.array([0.5, 2.0, 3.5, 4.5]))
    assert model.tolist() == [0.5, 1.25, 1.5, 2.0]
    assert rate.tolist() == [1.0, 0.25, 1.0, 0.0]
    film, index = slow.when(np.array([0.5, 1.25, 1.75, 2.0, 2.5]))
    assert sorted(zip(index.tolist(), film.tolist(), strict=True)) == [
        (0, 0.5),
        (1, 2.0),
        (1, 3.25),
        (2, 3.75),
        (3, 4.0),
    ]


def test_the_map_of_a_clock_shows_what_its_frames_show() -> None:
    for film in (filmed(gears(), Shot(seconds_per_turn=2.0)), filmed(ball(), Shot(hold=0.5))):
        clock = film.clock
        frames = np.arange(clock.frames)
        shown = [clock.moment(int(frame)).time for frame in frames]
        assert np.allclose(clock.time_map.moments_at(frames / film.shot.fps)[0], shown, atol=1e-12)
        assert clock.time_map.seconds == pytest.approx(clock.frames / film.shot.fps)


def test_an_impact_at_the_seam_of_a_loop_is_heard_once() -> None:
    whole = TimeMap.from_moments([0.0, 2.0], [0.0, 1.0], closes=True)
    assert whole.when(np.array([0.0, 1.0]))[1].tolist() == [0]
    assert TimeMap.from_moments([0.0, 2.0, 3.0], [0.0, 1.0, 1.0], closes=False).when(np.array([0.0, 1.0]))[
        0
    ].tolist() == [
        0,
        2,
    ]


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
