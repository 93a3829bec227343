"""Requests of a page: sliders, stops of a motion, drags, undo, fits, and numbers written back."""

from __future__ import annotations

import time
from collections.abc import Iterator

import numpy as np
import pytest

from tests.render.view.decoded import decoded
from tests.studio.live.served import FOUR_BAR, Page, Served, live_server

live = live_server("wished", "links", FOUR_BAR)


@pytest.fixture
def page(live: Served) -> Iterator[Page]:
    """A page, with the file and its numbers as they were at first."""
    text = (live.folder / "links" / "mechanism.py").read_text()
    with live.page() as tab:
        state = tab.hear("state")
        if text != FOUR_BAR:
            live.write(FOUR_BAR)
            tab.hear("solved", wanted=lambda header: header["numbers"][1]["value"] == 0.040)  # not what still comes
            tab.hear("motion")
        elif state["values"]:
            tab.say(do="set", values={number["name"]: number["value"] for number in state["numbers"]}, final=True)
            tab.hear("motion")
        live.session.history.keep({})
        yield tab


def test_sliders_have_the_numbers_of_params_with_their_ranges(live: Served) -> None:
    with live.page() as page:
        numbers = {number["name"]: number for number in page.hear("state")["numbers"]}
    assert list(numbers) == ["ground", "crank", "coupler", "rocker", "tracer[0]", "tracer[1]", "teeth", "speed"]
    assert (numbers["crank"]["low"], numbers["crank"]["value"], numbers["crank"]["high"]) == (0.02, 0.04, 0.2)
    assert numbers["teeth"]["whole"]
    assert not numbers["speed"]["whole"]


def test_a_slider_moves_the_machine(page: Page) -> None:
    page.say(do="set", values={"crank": 0.045, "tracer[1]": 0.05})
    shown = decoded(page.hear("motion")["payload"])
    b = shown["joints"]["B"]
    np.testing.assert_allclose(np.hypot(b["x"], b["y"]), 0.045, rtol=1e-6)
    body, point = shown["bodies"]["coupler"], shown["points"]["P"]
    away = np.hypot(point["x"] - body["x"], point["y"] - body["y"])
    np.testing.assert_allclose(away, np.hypot(0.06, 0.05), rtol=1e-5)


def test_the_newest_of_many_wishes_counts(page: Page) -> None:
    for k in range(60):
        page.say(do="set", values={"crank": 0.04 + k / 1e4})
    seen = []
    while not seen or seen[-1] < 0.04589:
        b = decoded(page.hear("motion")["payload"])["joints"]["B"]
        seen.append(float(np.hypot(b["x"][0], b["y"][0])))
    assert seen == sorted(seen)
    assert len(seen) < 60


def test_where_it_cannot_be_closed_it_is_shown_up_to_there(page: Page) -> None:
    """A crank of 0.075 m reaches its last angle where coupler and rocker are in line."""
    page.say(do="set", values={"crank": 0.075, "ground": 0.14})
    refusal = page.hear("motion", "refused")
    stop = refusal["stop"]
    assert "toggle" in stop["text"] or "do not close" in stop["text"]
    angle = stop["drivers"]["motor"]
    reach = np.hypot(0.14 - 0.075 * np.cos(angle), 0.075 * np.sin(angle))
    assert reach == pytest.approx(0.12 + 0.09, abs=2e-6)
    shown = decoded(refusal["payload"])
    assert shown["time"][-1] == pytest.approx(stop["time"])
    assert shown["period"] is None


def test_wishes_that_close_nowhere_are_refused_and_the_last_motion_stays(live: Served, page: Page) -> None:
    before = live.session.board.payload
    page.say(do="set", values={"crank": 1.0})
    assert "do not close" in page.hear("refused")["text"]
    assert live.session.board.payload == before
    page.say(do="set", values={"crank": -0.04})
    assert "positive" in page.hear("refused")["text"]
    page.say(do="set", values={"none": 1.0})
    assert "no number 'none'" in page.hear("refused")["text"]
    for wish in ({"do": "set", "values": {"crank": None}}, {"do": "set"}, {"do": "fly"}, {"do": "drag"}):
        page.say(**wish)
        assert page.hear("refused")["text"]
    page._socket.send("no json")
    assert "JSON" in page.hear("refused")["text"]


@pytest.mark.parametrize(("thing", "to"), [(("joint", "C"), (0.075, 0.095)), (("point", "P"), (0.05, 0.08))])
def test_dragging_changes_lengths_as_little_as_may_be(page: Page, thing: tuple[str, str], to: tuple) -> None:
    moment = 0.25
    page.say(do="drag", thing={"kind": thing[0], "name": thing[1]}, time=moment, to=list(to), final=True)
    motion = page.hear("motion")
    shown, values = decoded(motion["payload"]), motion["values"]
    where = shown["joints" if thing[0] == "joint" else "points"][thing[1]]
    k = int(np.argmin(np.abs(shown["time"] - moment)))
    assert shown["time"][k] == pytest.approx(moment)
    np.testing.assert_allclose([where["x"][k], where["y"][k]], to, atol=4e-5)  # of lengths in four digits
    assert all(float(f"{value:.4g}") == value for value in values.values())
    assert "speed" not in values
    assert "teeth" not in values
    if thing[0] == "joint":  # the coupler's point does not move the joint
        assert "tracer[0]" not in values
    page.say(do="undo")
    assert page.hear("values")["values"] == {}
    page.hear("motion")
    page.say(do="redo")
    assert page.hear("values")["values"] == values
    page.hear("motion")


def test_undo_and_redo_go_through_all_steps(page: Page) -> None:
    for value in (0.041, 0.042, 0.043):
        page.say(do="set", values={"crank": value}, final=True)
        page.hear("motion")
    for value in (0.042, 0.041):
        page.say(do="undo")
        assert page.hear("values")["values"] == {"crank": value}
        page.hear("motion")
    page.say(do="set", values={"rocker": 0.1}, final=True)
    told = page.hear("values")
    assert told["values"] == {"crank": 0.041, "rocker": 0.1}
    assert not told["can_redo"]
    page.hear("motion")


def test_numbers_are_written_back_and_nothing_else(live: Served, page: Page) -> None:
    page.say(do="set", values={"crank": 0.0435, "tracer[1]": 0.0312, "teeth": 5}, final=True)
    page.hear("motion")
    page.say(do="write")
    page.hear("solved", wanted=lambda header: header["numbers"][1]["value"] == 0.0435)
    expected = FOUR_BAR.replace("default=0.040", "default=0.0435").replace("(0.060, 0.030)", "(0.060, 0.0312)")
    assert (live.folder / "links" / "mechanism.py").read_text() == expected.replace("teeth: int = 3", "teeth: int = 5")
    page.say(do="write")
    assert "nothing to write" in page.hear("refused")["text"]
    page.say(do="undo")
    assert page.hear("values")["values"] == {"crank": 0.04, "tracer[1]": 0.03, "teeth": 3}, "beside the new file"
    page.say(do="redo")
    assert page.hear("values")["values"] == {}


def test_a_drawn_path_is_fitted_with_progress(page: Page) -> None:
    path = [[0.02, 0.075], [0.05, 0.085], [0.075, 0.07]]
    page.say(do="fit", point="P", path=path[::-1], starts=1, generations=40, ordered=True)
    assert page.hear("progress", wanted=lambda header: header["done"] > 0)["done"] <= 1
    assert page.hear("motion")["values"], "the best linkage so far"
    fitted = page.heard("fitted")
    assert all(float(f"{value:.4g}") == value for value in fitted["values"].values())
    assert fitted["largest"] < 0.002
    shown = decoded(page.hear("motion")["payload"])["points"]["P"]
    on_path = np.column_stack([shown["x"], shown["y"]])
    for place in path:
        assert np.hypot(*(on_path - place).T).min() < 0.01  # of outputs, which are apart
    page.say(do="undo")
    assert page.hear("values")["values"] == {}


def test_a_fit_is_cancelled(page: Page) -> None:
    zigzag = [[0.02 + 0.01 * k, 0.02 + 0.09 * (k % 2)] for k in range(9)]  # no linkage follows it, so the fit goes on
    page.say(do="fit", point="P", path=zigzag, starts=50, generations=5000)
    page.hear("progress", wanted=lambda header: header["done"] > 0)
    began = time.monotonic()
    page.say(do="cancel")
    assert page.hear("fitted")["cancelled"]
    assert time.monotonic() - began < 20
    page.say(do="fit", point="Q", path=[[0, 0], [1, 1]])
    assert "no traced point 'Q'" in page.hear("fitted")["error"]


def test_a_child_that_dies_is_replaced(live: Served, page: Page) -> None:
    import psutil

    assert live.session._good is not None
    psutil.Process(live.session._good.pid).kill()
    page.say(do="set", values={"crank": 0.042})
    assert "SIGKILL" in page.hear("refused", "error")["text"]
    page.hear("motion")
    page.say(do="set", values={"crank": 0.043})
    page.hear("motion")
