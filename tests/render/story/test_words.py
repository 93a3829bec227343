"""Words of a story: subtitles, chapters, numbers beside arrows, the strip beside the machine, the ending."""

from __future__ import annotations

import itertools
import re
from string import Formatter

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from PIL import Image

from render.film.framing import project
from render.film.story import frame
from render.film.story.frame import Caption, Note, Over
from render.film.story.words import TABLE, captions_of, chapters, rate_words, srt, words_in
from render.frames.story.drawing import Drawing, _facts, is_on_arrow
from render.frames.story.telling import Telling, telling_of
from render.presets import preset_named
from shared.contract import Mount
from shared.contract.shot import Camera, Shot
from shared.contract.shot import Story as Wishes
from shared.stage.errors import UserError
from tools.fixtures import film_fixture

BLOCK = re.compile(r"(\d+)\n(\d\d):(\d\d):(\d\d),(\d{3}) --> (\d\d):(\d\d):(\d\d),(\d{3})\n(.+)\n\n")


def test_subtitles_are_subrip() -> None:
    text = srt([Caption(0.5, 4.25, "Here it turns: 1.45 N."), Caption(61.0, 3661.9996, "Über")])
    rows = BLOCK.findall(text)
    assert BLOCK.sub("", text) == ""
    seconds = [
        [int(h) * 3600 + int(m) * 60 + int(s) + int(ms) / 1000 for h, m, s, ms in (row[1:5], row[5:9])] for row in rows
    ]
    assert seconds == [[0.5, 4.25], [61.0, 3662.0]]
    assert [(row[0], row[9]) for row in rows] == [("1", "Here it turns: 1.45 N."), ("2", "Über")]


WORDS = st.text(st.characters(categories=("L", "N", "P")), min_size=1)
MILLISECONDS = st.integers(0, 10**8).map(lambda count: count / 1000)


@given(st.lists(st.builds(Caption, MILLISECONDS, MILLISECONDS, WORDS)))
def test_subtitles_are_read_as_they_were_written(captions: list[Caption]) -> None:
    assert captions_of(srt(captions)) == captions


def test_subtitles_of_other_programs_are_read() -> None:
    saved = "\ufeff1\r\n00:00:01.5 --> 00:00:02,250 X1:40\r\nzwei\r\nZeilen\r\n \r\n00:01:00,000-->00:01:01,000\r\nEnde"
    assert captions_of(saved) == [Caption(1.5, 2.25, "zwei\nZeilen"), Caption(60.0, 61.0, "Ende")]
    assert captions_of("") == []
    with pytest.raises(ValueError, match=r"no times such as .* in '7'"):
        captions_of("1\n00:00:01,000 --> 00:00:02,000\nA\n\n7\n")


def test_chapters_are_escaped() -> None:
    text = chapters([(0.0, 3.0, "Why; = #1"), (3.0, 9.5, "End")], "A\\B")
    assert text.startswith(";FFMETADATA1\ntitle=A\\\\B\n[CHAPTER]\nTIMEBASE=1/1000\nSTART=0\nEND=3000\n")
    assert "title=Why\\; \\= \\#1\n" in text
    assert "START=3000\nEND=9500\ntitle=End\n" in text


def test_every_language_says_the_same() -> None:
    fields = {
        language: {
            key: sorted(name for _, name, _, _ in Formatter().parse(text) if name) for key, text in table.items()
        }
        for language, table in TABLE.items()
    }
    assert all(named == fields["en"] for named in fields.values())


def test_rates_are_said_in_words() -> None:
    say = words_in("en", "crank")
    assert rate_words(0.0, say) == "time stands still"
    assert rate_words(1.001, say) == "real time"
    assert rate_words(0.25, say) == "4 times slower"
    assert rate_words(12.3, say) == "10 times faster"
    assert rate_words(1 / 437, say) == "400 times slower"
    with pytest.raises(UserError, match=r"crank: shot\.story\.language is 'fr'; there is: en, de"):
        words_in("fr", "crank")


WIDE, HIGH = 640, 360


def dark(note: Note) -> np.ndarray:
    """Where the card of a note is, as pixels (n, 2) of x and y."""
    layer = Drawing(WIDE, HIGH, "", (), "", None)._layer(Over(notes=(note,), notes_shown=1.0))
    rows, columns = np.nonzero(np.asarray(layer)[..., 3] > 100)
    return np.stack([columns, rows], axis=1)


@pytest.mark.parametrize("x", [0.2, 0.8])
def test_a_number_at_the_upper_edge_is_beside_its_arrow(x: float) -> None:
    note = Note(x, 0.03, 0.0, -1.0, "O  1.37 N", "#5aa9ff")
    card = dark(note)
    assert (card[:, 0] > x * WIDE + 3).all() if x < 0.5 else (card[:, 0] < x * WIDE - 3).all()
    assert card.min() >= 0


def test_it_is_on_the_side_to_which_the_arrow_leans() -> None:
    note = Note(0.3, 0.03, -0.35, -0.94, "O  1.37 N", "#5aa9ff")
    card = dark(note)
    tip = 0.3 * WIDE
    assert card[:, 0].max() < tip, "the shaft goes to the right from here"


def test_a_number_with_room_is_beyond_the_tip() -> None:
    note = Note(0.5, 0.5, 0.0, -1.0, "O  1.37 N", "#5aa9ff")
    card = dark(note)
    assert card[:, 1].max() < 0.5 * HIGH
    assert card[:, 0].mean() == pytest.approx(0.5 * WIDE, abs=1.0)
    assert not is_on_arrow((300.0, 100.0, 340.0, 170.0), note, WIDE, HIGH)
    assert is_on_arrow((300.0, 185.0, 340.0, 200.0), note, WIDE, HIGH)


TALL = Mount(kind="stand", up=(1.0, 0.0, 0.0))
"""The four-bar stands on the left end of its base."""


def tell(mount: Mount | None = None, preset: str = "draft", wishes: Wishes | None = None, **shot) -> Telling:
    asked = Shot(story=wishes or Wishes(), **shot)
    return telling_of(film_fixture.write(asked, mount=mount), preset_named(preset))


def test_it_stands_beside_what_is_tall_in_a_wide_picture(out_root) -> None:
    assert tell(TALL).story.at_side
    assert not tell(camera=Camera(elevation=8.0)).story.at_side, "what lies is wide from so low"
    assert not tell(TALL, "draft-9x16").story.at_side
    assert not tell(TALL, wishes=Wishes(curves=())).story.at_side


def test_the_machine_has_the_rest_of_the_picture_and_is_larger_there(out_root, monkeypatch) -> None:
    telling = tell(TALL)
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
    under = tell(TALL)
    first = next(placed.first for placed in under.story.placed if placed.shot.name == "motion")
    y = project(under.story.picture(first).camera, film.subject.few, film.aspect, 1.0)[:, 1]
    assert max(heights) > 1.08 * np.ptp(y)


def test_panels_stand_over_each_other_at_the_right_edge_clear_of_captions(out_root) -> None:
    telling = tell(TALL)
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


FACTS = ["Repeats after 8 s", "crank reaches 10.8 mm/s", "motor up to 38.3 mN·m", "largest reaction 5.2 N at O"]


def test_lines_break_between_facts() -> None:
    _, lines = _facts(" · ".join(FACTS), 13.0, 400.0, 2)
    assert len(lines) == 2
    assert [fact for line in lines for fact in line.strip("· ").split(" · ")] == FACTS
    long = "crank reaches a speed that takes many more words than any line of a picture has room for"
    _, broken = _facts(long, 13.0, 400.0, 2)
    assert " ".join(broken) == long


@pytest.mark.parametrize("language", sorted(TABLE))
def test_rates_near_real_time_do_not_flicker(language: str) -> None:
    say = words_in(language, "m")
    assert rate_words(0.97, say) == TABLE[language]["real"]
    assert {rate_words(rate, say) for rate in (0.85, 0.92, 1.09, 1.15)} == {TABLE[language]["about"]}
    assert rate_words(1.3, say) == TABLE[language]["faster"].format(factor="1.3")
