"""Bars of stories, computed from their scenes: motion, time that stands, badges, arrows, the first second."""

from __future__ import annotations

import itertools

import numpy as np
import pytest

from render.film.story.frame import Picture
from render.film.story.ramps import SHOWN, stepped, warped
from render.film.story.story import Story
from render.frames.story.telling import Telling, telling_of
from render.presets import preset_named
from shared.contract.shot import Camera, Shot
from shared.contract.shot import Story as Wishes
from tools.fixtures import film_fixture

MOVES, STANDS = 0.8, 0.1
"""Part of a story in which the picture moves at least, and part in which time stands still at most."""


@pytest.fixture(params=[1.0, 4.0, 12.0], ids=lambda seconds: f"{seconds:g} s a turn")
def telling(request: pytest.FixtureRequest, out_root) -> Telling:
    shot = Shot(story=Wishes(), seconds_per_turn=request.param, camera=Camera(margin=0.08))
    return telling_of(film_fixture.write(shot), preset_named("draft"))


def pictures(story: Story) -> list[Picture]:
    return [story.picture(frame) for frame in range(0, story.total, story.step)]


def test_the_picture_moves_in_four_fifths_of_a_story(telling: Telling) -> None:
    seen = pictures(telling.story)
    moved = np.array([a != b for a, b in itertools.pairwise(seen)])
    assert moved.mean() >= MOVES


def test_time_stands_for_a_tenth_at_most_while_it_is_told(telling: Telling) -> None:
    story, say = telling.story, "time stands still"
    stands = np.array([story.over(frame).rate == say for frame in range(story.total)])
    assert stands.mean() <= STANDS


def test_it_opens_on_the_moving_machine_with_sound_from_the_first_second(telling: Telling) -> None:
    story = telling.story
    opened = [story.picture(frame) for frame in range(0, story.fps, story.step)]
    assert len({picture.at for picture in opened}) == len(opened)
    assert not any(picture.hidden == "all" for picture in opened)
    heard = story.time_map(telling.film.clock.start, telling.film.clock.end)
    moments, rates = heard.moments_at(np.linspace(0.02, 0.98, 20))
    assert np.all(np.asarray(rates) > 0)
    assert np.ptp(moments) > 0


def test_title_and_end_share_their_pictures(telling: Telling) -> None:
    story = telling.story
    shots = {placed.shot.name: placed for placed in story.placed}
    title, last = (
        [story.picture(frame) for frame in range(shots[name].first, shots[name].end)] for name in ("title", "last")
    )
    assert set(title) <= set(last)


def test_the_rate_is_written_in_stretches_of_a_second_or_more(telling: Telling) -> None:
    story = telling.story
    for placed in story.placed:
        rates = [placed.shot.over(k / story.fps).rate for k in range(placed.end - placed.first)]
        edges = [0, *(k for k in range(1, len(rates)) if rates[k] != rates[k - 1]), len(rates)]
        for a, b in itertools.pairwise(edges):
            is_whole = a > 0 and b < len(rates)
            assert not rates[a] or not is_whole or (b - a) / story.fps >= 0.9 * SHOWN, (placed.shot.name, rates[a])


def test_a_warp_writes_steps_that_hold() -> None:
    time = np.linspace(0.0, 10.0, 400)
    warp = warped(time.tolist(), np.abs(np.sin(7 * time)) ** 6 + (time > 8), 0.0, 10.0, 9.0)
    seconds = np.linspace(0.0, 9.0, 1801)
    rates = [warp.shown_rate(float(s)) for s in seconds]
    changes = [k for k in range(1, len(rates)) if rates[k] != rates[k - 1]]
    assert len(changes) <= 2 * 9
    for s, rate in zip(seconds, rates, strict=True):
        assert rate is None or rate == stepped(rate)
        if rate is not None:
            assert 0.3 < warp.rate(float(s)) / rate < 3.0


def test_arrows_of_the_reason_are_the_balance_of_one_body(telling: Telling) -> None:
    film = telling.forces
    assert film is not None
    reason = next(placed.shot for placed in telling.story.placed if placed.shot.name == "reason")
    body = next(name for name in film.motion.bodies if all(name in v.bodies for v in film.arrows.vectors))
    assert reason.captions
    motion, own = film.motion, film.motion.bodies[body]
    total = sum((vector.value for vector in film.arrows.vectors), np.zeros((len(motion.time), 2)))
    wanted = own.mass * np.stack([own.ax, own.ay], axis=1)
    scale = max(float(np.abs(vector.value).max()) for vector in film.arrows.vectors)
    com = np.array(own.com)
    if not com.any():  # ax, ay are those of the frame: there the balance is exact
        assert np.abs(total - wanted).max() < 0.02 * scale
