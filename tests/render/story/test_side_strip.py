"""The strip beside a machine that is tall in a wide picture: when it stands there, and that both have their room."""

from __future__ import annotations

import itertools

import numpy as np
import pytest
from PIL import Image

from render.film.framing import project
from render.film.story import frame
from render.film.story.frame import Over
from render.frames.story.telling import Telling, telling_of
from render.presets import preset_named
from shared.contract import Mount
from shared.contract.shot import Camera, Shot
from shared.contract.shot import Story as Wishes
from tools.fixtures import film_fixture

TALL = Mount(kind="stand", up=(1.0, 0.0, 0.0))
"""The four-bar stands on the left end of its base."""


def made(mount: Mount | None = None, preset: str = "draft", wishes: Wishes | None = None, **shot) -> Telling:
    asked = Shot(story=wishes or Wishes(), **shot)
    return telling_of(film_fixture.write(asked, mount=mount), preset_named(preset))


def test_it_stands_beside_what_is_tall_in_a_wide_picture(out_root) -> None:
    assert made(TALL).story.at_side
    assert not made(camera=Camera(elevation=8.0)).story.at_side, "what lies is wide from so low"
    assert not made(TALL, "draft-9x16").story.at_side
    assert not made(TALL, wishes=Wishes(curves=())).story.at_side


def test_the_machine_has_the_rest_of_the_picture_and_is_larger_there(out_root, monkeypatch) -> None:
    telling = made(TALL)
    film, story = telling.film, telling.story
    wide = film.aspect - frame.SIDE
    heights = []
    for placed in (each for each in story.placed if each.shot.name in ("motion", "reason")):
        for k in range(placed.first, placed.end, 20):
            x, y = project(story.picture(k).camera, film.subject.few, film.aspect, 1.0).T
            assert x.max() <= wide + 1e-6
            assert x.min() >= 0.0
            assert 0.0 <= y.min() <= y.max() <= 1 - frame.below(film.aspect, strip=False)
            heights.append(np.ptp(y))
    monkeypatch.setattr("render.film.story.scenery.WIDE", 9.0)
    under = made(TALL)
    first = next(placed.first for placed in under.story.placed if placed.shot.name == "motion")
    y = project(under.story.picture(first).camera, film.subject.few, film.aspect, 1.0)[:, 1]
    assert max(heights) > 1.08 * np.ptp(y)


def test_panels_stand_over_each_other_at_the_right_edge_clear_of_captions(out_root) -> None:
    telling = made(TALL)
    strip = telling.drawing.strip
    assert strip is not None
    assert strip.place == (640 - strip.across, 0)
    assert strip.tall <= 360 * (1 - frame.UNDER) + 1
    for a, b in itertools.pairwise(strip.panels):
        assert (a[0], a[2]) == (b[0], b[2])
        assert a[3] < b[1] - 1.3 * frame.SMALL * 360, "its name has room"
    page = telling.drawing.frame(Image.new("RGB", (640, 360), (90, 120, 90)), Over(strip=1.0, now=strip.start))
    pixels = np.asarray(page)
    assert (pixels[:, : strip.place[0]] == (90, 120, 90)).all()
    assert (pixels[strip.tall :] == (90, 120, 90)).all()
    later = np.asarray(strip.drawn(strip.start + 0.5 * (strip.end - strip.start)))
    for left, top, right, low in strip.panels:  # the playhead of each is in the middle then
        row = later[round((top + low) / 2), round(left) : round(right), :3].min(axis=1)
        assert row.argmax() == pytest.approx((right - left) / 2, abs=2)
