"""Subtitles and chapters as players read them, and the table of words."""

from __future__ import annotations

import re
from string import Formatter

import pytest
from hypothesis import given
from hypothesis import strategies as st

from render.film.story.frame import Caption
from render.film.story.words import TABLE, captions_of, chapters, rate_words, srt, words_in
from shared.stage.errors import UserError

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
    assert rate_words(12.3, say) == "12 times faster"
    assert rate_words(1 / 437, say) == "400 times slower"
    with pytest.raises(UserError, match=r"crank: shot\.story\.language is 'fr'; there is: en, de"):
        words_in("fr", "crank")
