"""Two variants beside each other: one clock, a stop where they differ most, one film with both sounds."""

from __future__ import annotations

import re
import subprocess
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from render.film.story.scenery import Stand
from render.frames.encode import ffmpeg, refuse_other_than
from render.frames.story import comparison
from render.frames.story.comparison import FIRST, SECOND, Pair, pair_of, put_on_one_scale
from render.presets import PRESETS, Preset, preset_named
from shared.contract import read_motion, write_motion
from shared.contract.shot import Shot, Story
from shared.stage.errors import UserError
from shared.stage.paths import Out
from tests.render.sound.heard import measured
from tools.fixtures import film_fixture

NAMES = ("v_twin", "v_twin-bank_45")


@pytest.fixture
def pair(out_root) -> Pair:
    """The same motion twice; the second's reaction in C is three times as large in the second half of its turn."""
    outs = [film_fixture.write(Shot(story=Story(curves=("A", "C", "P"))), name=name) for name in NAMES]
    motion = read_motion(outs[1].motion)
    joint, half = motion.joints["C"], len(motion.time) // 2
    for key in ("fx", "fy"):
        values = np.array(getattr(joint, key))
        values[half:] *= 3
        setattr(joint, key, values.tolist())
    write_motion(outs[1].motion, motion)
    return pair_of(outs, PRESETS["draft"], comparison.half(PRESETS["draft"]))


def test_both_are_on_one_clock(pair: Pair) -> None:
    first, second = (telling.story for telling in pair.tellings)
    assert first.total == second.total
    assert first.fps == second.fps
    assert 10 <= first.seconds <= 40
    for s in np.linspace(0, first.seconds - 0.01, 50):
        assert first.model_time(float(s)) == pytest.approx(second.model_time(float(s)), abs=1e-12)


def test_time_stops_where_they_differ_most_and_both_numbers_are_said(pair: Pair) -> None:
    story = pair.tellings[0].story
    curves = {curve.name: curve for curve in story.curves}
    strip = pair.drawing.strip
    assert strip is not None
    assert [curve.name for curve in strip.curves] == [curve.name for curve in strip.others] == list(curves)
    assert {curve.colour for curve in strip.curves} == {FIRST}
    assert {curve.colour for curve in strip.others} == {SECOND}
    assert list(curves) == ["C", "A", "P"]
    assert [caption.text[:21] for caption in story.captions] == ["Here C differs most: "]
    for caption in story.captions:
        frame = int((caption.start + caption.end) / 2 * story.fps)
        assert story.over(frame).rate == "time stands still"
        assert "(as it is)" in caption.text
        assert "(bank 45)" in caption.text


@pytest.mark.parametrize(("far", "held"), [(0.6, [0.6, 0.6]), (2.0, [0.4, 2.0])])
def test_both_are_on_one_scale_unless_one_would_be_lost(far: float, held: list[float]) -> None:
    class Asked:
        def __init__(self, distance: float) -> None:
            self.held = Stand((0.0, 0.0, 0.0), 0.1, 0.5, distance, 55.0)

        def stand(self) -> Stand:
            return self.held

        def hold(self, stand: Stand) -> None:
            self.held = stand

    both = [Asked(0.4), Asked(far)]
    put_on_one_scale(both)  # pyright: ignore[reportArgumentType]
    assert [each.held.distance for each in both] == held


def test_numbers_beside_each_other_have_the_unit_once_and_room_for_both(pair: Pair) -> None:
    strip = pair.drawing.strip
    assert strip is not None
    for k, (ours, theirs) in enumerate(zip(strip.shown, strip.others, strict=False)):
        top = max(np.abs(ours.values).max(), np.abs(theirs.values).max())
        assert strip._words(k, top, False).startswith(strip._words(k, top, True))
        assert " " in strip._words(k, top, False)
        assert " " not in strip._words(k, top, True)
        assert strip._room(k, True) < strip._room(k, False)


def test_halves_fill_the_picture() -> None:
    wide, tall = PRESETS["draft"], preset_named("draft-9x16")
    assert (comparison.half(wide).width, comparison.half(wide).height) == (320, 360)
    assert (comparison.half(tall).width, comparison.half(tall).height) == (360, 320)

    class Made:
        def __init__(self, preset, colour: tuple[int, int, int]) -> None:
            self.picture = Image.new("RGB", (preset.width, preset.height), colour)

        def pages(self):
            yield str(self.picture.getpixel((0, 0))), self.picture

    for preset in (wide, tall):
        half = comparison.half(preset)
        [(_, page)] = comparison.side_by_side(preset, [Made(half, (255, 0, 0)), Made(half, (0, 0, 255))])  # pyright: ignore[reportArgumentType]
        assert page.size == (preset.width, preset.height)
        assert page.getpixel((5, 5)) == (255, 0, 0)
        assert page.getpixel((page.width - 5, page.height - 5)) == (0, 0, 255)


def test_a_name_means_the_machine_and_a_variant() -> None:
    assert comparison.both("v_twin") == comparison.both("v-twin-bank-45") == NAMES
    assert comparison.both("geneva_drive-six_slots") == ("geneva_drive", "geneva_drive-six_slots")
    with pytest.raises(UserError, match="four_bar: there is nothing to compare"):
        comparison.both("four_bar")


def test_missing_things_are_named(out_root) -> None:
    film_fixture.write(name=NAMES[0])
    with pytest.raises(UserError, match="v_twin-bank_45"):
        comparison.run("v_twin", PRESETS["draft"])
    assert Out(NAMES[0]).shot.is_file()


TINY = Preset("draft-tiny", 96, 54, 1)


def test_it_has_both_pictures_and_both_sounds(out_root: Path, capsys: pytest.CaptureFixture[str]) -> None:
    outs = [film_fixture.write(Shot(seconds_per_turn=0.3), name=name) for name in ("v_twin", "v_twin-bank_45")]
    comparison.run("v_twin", TINY)
    capsys.readouterr()
    film = outs[1].film("draft-tiny").with_stem("v_twin-bank_45-draft-tiny-compare")
    waves, subtitles = film.with_suffix(".wav"), film.with_suffix(".srt")
    listing = subprocess.run([ffmpeg(), "-i", str(film)], capture_output=True, text=True).stderr
    assert re.search(r"Audio: aac.*48000 Hz, stereo", listing)
    assert re.findall(r"title\s*: (.*)", listing) == ["V twin", "Title", "Side by side"]
    total = pair_of(outs, TINY, comparison.half(TINY)).tellings[0].story.total
    refuse_other_than(film, film.name, ffmpeg(), total, TINY, 30, 60.0)
    assert abs(measured(waves)[0] + 16.0) < 0.3
    content = film.read_bytes(), waves.read_bytes(), subtitles.read_bytes()

    comparison.run("v_twin", TINY)
    assert "nothing to do" in capsys.readouterr().out
    comparison.run("v_twin", TINY, "off")
    said = capsys.readouterr().out
    assert "silent" in said
    assert "to render" not in said
    assert not waves.exists()
    assert "Audio" not in subprocess.run([ffmpeg(), "-i", str(film)], capture_output=True, text=True).stderr
    comparison.run("v_twin", TINY)
    assert "to render" not in capsys.readouterr().out
    assert (film.read_bytes(), waves.read_bytes(), subtitles.read_bytes()) == content
