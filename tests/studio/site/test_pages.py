"""Pages of the site: what they say, their neighbours by purpose, and designs between computed ones."""

from __future__ import annotations

import math
from html.parser import HTMLParser
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from studio.site.designs import table
from studio.site.designs.vectors import Unlike, form, leaves, thinned, vector
from studio.site.entries import Download, Entry, filters, neighbours, purposes
from studio.site.pages import machine, wall

# The HTML of the site and the numbers that its pages carry, without a browser.


class Read(HTMLParser):
    """Tags of a page with their attributes, and its words."""

    def __init__(self, page: str) -> None:
        super().__init__()
        self.tags: list[tuple[str, dict[str, str | None]]] = []
        self.words = ""
        self.feed(page)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.tags.append((tag, dict(attrs)))

    def handle_data(self, data: str) -> None:
        self.words += data

    def all(self, tag: str) -> list[dict[str, str | None]]:
        return [attributes for name, attributes in self.tags if name == tag]


def entry(name: str, said: str = "", **more) -> Entry:
    return Entry(name, name.replace("_", " "), said, ["1 degree of freedom"], ["gears"], picture="picture.jpg", **more)


def test_words_of_an_author_are_no_html() -> None:
    nasty = 'a <script>alert("x")</script> & "quotes"'
    page = Read(wall("All", [entry("press", nasty), entry("lift")], ["gears", "a & b"]))
    assert nasty in page.words
    assert len(page.all("script")) == 3
    assert [button["data-purpose"] for button in page.all("button") if "data-purpose" in button] == ["gears", "a & b"]
    tiles = [tile for tile in page.all("li") if "data-words" in tile]
    assert nasty.lower() in (tiles[0]["data-words"] or "")
    assert [link["href"] for link in page.all("a")] == ["press/index.html", "lift/index.html"]


def test_commands_in_backticks_are_code() -> None:
    v8 = entry("v8", "`make compare-v8` & <more>")
    for page in (wall("All", [v8], []), machine(v8, [])):
        assert "<code>make compare-v8</code> &amp; &lt;more&gt;" in page
        assert "`" not in Read(page).words


def test_a_machine_has_its_film_files_and_neighbours() -> None:
    files = [Download("press_stl.zip", "parts, STL", 1_250_000)]
    page = Read(machine(entry("press", film="film.mp4", has_sliders=True, downloads=files), [entry("lift")]))
    (film,) = page.all("video")
    assert (film["src"], film["poster"]) == ("film.mp4", "picture.jpg")
    assert "files/press_stl.zip" in {link["href"] for link in page.all("a")}
    assert "1.2 MB" in page.words
    assert "Move a number" in page.words
    assert '<iframe src="press/machine.html"' in page.words
    still = Read(machine(entry("press"), []))
    assert not still.all("video")
    assert "Move a number" not in still.words


def payload(length: float = 2.0, count: int = 200, theta: float = 0.1) -> dict:
    time = np.linspace(0.0, 1.0, count)
    return {
        "mechanism": "m",
        "time": time,
        "bodies": {"a": {"x": np.float32(length * time), "theta": np.float32(theta + time), "mass": 0.5, "links": 3}},
        "skeleton": {"strokes": [{"shapes": None, "points": np.zeros(8, np.float32)}]},
    }


def test_designs_between_others_are_sums_of_their_numbers() -> None:
    base = list(leaves(thinned(payload())))
    first, second = (vector(thinned(payload(length)), base) for length in (1.0, 3.0))
    assert vector(thinned(payload())) == pytest.approx((first + second) / 2, abs=1e-6)
    assert len(thinned(payload())["time"]) == 91
    assert form(thinned(payload()))["bodies"]["a"] == {
        "x": {"#": 91},
        "theta": {"#": 91},
        "mass": {"#": None},
        "links": 3,
    }


def test_angles_are_those_near_the_base_and_other_shapes_have_nothing_between() -> None:
    base = list(leaves(thinned(payload())))
    turned = vector(thinned(payload(theta=0.1 + 4 * math.tau)), base)
    assert turned == pytest.approx(vector(thinned(payload())), abs=1e-5)
    other = thinned(payload())
    other["bodies"]["b"] = {"x": np.zeros(3)}
    with pytest.raises(Unlike):
        vector(other, base)
    unknown = thinned(payload())
    unknown["bodies"]["a"]["mass"] = math.nan
    with pytest.raises(Unlike):
        vector(unknown, base)


# Filters of the wall: found in what a machine says of itself and in its kinds.


def motion(*kinds: str) -> Any:
    joints = {str(k): SimpleNamespace(kind=kind) for k, kind in enumerate(kinds)}
    return SimpleNamespace(joints=joints, drivers={}, forces={}, contacts={})


def test_words_and_kinds_give_purposes() -> None:
    said = "A leg that walks on the ground. A spring holds it."
    assert purposes("beach_leg", said, motion("revolute", "gear_pair")) == ["walks", "gears"]
    assert purposes("press", "It presses a block.", motion("revolute")) == ["clamps and presses"]
    assert purposes("v8", "An engine of eight cylinders.", motion("revolute")) == ["engines"]
    assert purposes("plain", "A linkage.", motion("revolute")) == []


def test_a_filter_has_two_machines_and_the_most_common_comes_first() -> None:
    of = {"a": ["gears", "walks"], "b": ["gears"], "c": ["gears", "lifts"], "d": ["lifts"]}
    assert filters(of) == ["gears", "lifts"]


def test_neighbours_share_most_and_none_is_its_own() -> None:
    of = {"a": ["gears", "lifts"], "b": ["gears"], "c": ["gears", "lifts"], "d": ["walks"], "e": []}
    assert neighbours("a", of, 2) == ["c", "b"]
    assert "a" not in neighbours("a", of, 9)


# Interpolation on Chebyshev points: exact for polynomials, and as exact as theory says for smooth functions.


coefficients = st.lists(st.floats(-3.0, 3.0), min_size=1, max_size=5)
parts = st.floats(0.0, 1.0)


@given(coefficients, st.floats(-2.0, 2.0), st.floats(0.1, 5.0), parts)
def test_a_polynomial_of_its_degree_is_met_exactly(terms: list[float], low: float, width: float, part: float) -> None:
    points = table.nodes(low, low + width, 5)
    x = low + part * width
    assert table.weights(x, points).sum() == pytest.approx(1.0)
    exact, size = np.polyval(terms, x), np.abs(np.polyval(np.abs(terms), 7.0)) + 1.0
    assert table.weights(x, points) @ np.polyval(terms, points) == pytest.approx(exact, abs=1e-9 * size)


@given(parts, parts)
def test_designs_of_two_numbers_stand_in_the_order_of_their_weights(first: float, second: float) -> None:
    axes = [table.nodes(1.0, 2.0, 4), table.nodes(-3.0, 1.0, 5)]
    place = 1.0 + first, -3.0 + 4.0 * second
    values = np.array([x**3 * y**4 - 2.0 * x * y for x, y in table.grid(axes)])
    shown = table.tensor_weights(place, axes) @ values
    assert shown == pytest.approx(place[0] ** 3 * place[1] ** 4 - 2.0 * place[0] * place[1], abs=1e-8)


def test_the_error_of_a_smooth_function_falls_geometrically() -> None:
    """f(x) = 1 / (1 + x^2) on -1 .. 1: the poles +-i give a factor of 1 + sqrt(2) a node (Trefethen, 2013, ch. 8)."""
    places = np.linspace(-1.0, 1.0, 201)

    def error(count: int) -> float:
        points = table.nodes(-1.0, 1.0, count)
        shown = [table.weights(x, points) @ (1.0 / (1.0 + points**2)) for x in places]
        return float(np.abs(shown - 1.0 / (1.0 + places**2)).max())

    assert error(21) / error(9) == pytest.approx((1.0 + np.sqrt(2.0)) ** -12, rel=0.5)
