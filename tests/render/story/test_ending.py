"""The words at the end of a story: lines break between facts, and slow machines have no km/h."""

from __future__ import annotations

import pytest

from render.film.story.words import TABLE, rate_words, words_in
from render.frames.story.drawing import _facts
from render.frames.story.telling import _without_slow

FACTS = ["Repeats after 8 s", "crank reaches 10.8 mm/s", "motor up to 38.3 mN m", "largest reaction 5.2 N at O"]


def test_lines_break_between_facts() -> None:
    _, lines = _facts(" · ".join(FACTS), 13.0, 400.0, 2)
    assert len(lines) == 2
    assert [fact for line in lines for fact in line.strip("· ").split(" · ")] == FACTS
    long = "crank reaches a speed that takes many more words than any line of a picture has room for"
    _, broken = _facts(long, 13.0, 400.0, 2)
    assert " ".join(broken) == long


def test_what_is_slower_than_a_walk_has_no_km_h() -> None:
    assert _without_slow("crank reaches 10.8 mm/s (0.0388 km/h)") == "crank reaches 10.8 mm/s"
    assert _without_slow("ball reaches 4.43 m/s (15.9 km/h)") == "ball reaches 4.43 m/s (15.9 km/h)"


@pytest.mark.parametrize("language", sorted(TABLE))
def test_rates_near_real_time_do_not_flicker(language: str) -> None:
    say = words_in(language, "m")
    assert rate_words(0.97, say) == TABLE[language]["real"]
    assert {rate_words(rate, say) for rate in (0.85, 0.92, 1.09, 1.15)} == {TABLE[language]["about"]}
    assert rate_words(1.3, say) == TABLE[language]["faster"].format(factor="1.3")
