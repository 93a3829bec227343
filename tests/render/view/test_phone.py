"""The page on a phone in a real browser: fingers reach everything, no words overlap; the skeleton is there at once."""

from __future__ import annotations

import json
import math
import os
import subprocess
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from msgspec import structs

from render import view
from render.view.bundle import PAGE, node, node_modules
from render.view.document import sketch
from render.view.payload import read_payload
from shared.contract import read_motion
from shared.contract.shot import Shot
from shared.contract.skeleton import read_skeleton, write_skeleton
from shared.stage.paths import Out
from tests.running.needs import needed
from tools.fixtures import film_fixture

SCRIPT = Path(__file__).with_name("phone.cjs")


pytestmark = pytest.mark.slow


@pytest.fixture(scope="module")
def seen(tmp_path_factory: pytest.TempPathFactory) -> Iterator[tuple[Out, dict[str, Any]]]:
    chromium = needed("chromium")
    folder = Path(os.environ.get("MBSD_PICTURES", str(tmp_path_factory.mktemp("phone"))))
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("MBSD_OUT", str(folder / "out"))
        out = film_fixture.write(Shot())
        _with_a_centre_of_mass(out)
        view.run("four_bar")
        browser = {"CHROMIUM": chromium, "PAGE_BROWSER": str(PAGE / "browser" / "browser.cjs")}
        done = subprocess.run(
            [str(node()), str(SCRIPT), str(out.view), str(folder)],
            env=os.environ | browser | {"NODE_PATH": str(node_modules())},
            capture_output=True, text=True, timeout=280, check=False,
        )  # fmt: skip
        assert done.returncode == 0, done.stderr[-3000:]
        yield out, json.loads((folder / "phone.json").read_text())


def _with_a_centre_of_mass(out: Out) -> None:
    """Add a black dot on the rocker to the fixture's bars."""
    skeleton, motion = read_skeleton(out.skeleton), read_motion(out.motion)
    assert skeleton.moving is not None
    bar, body = skeleton.moving.strokes[-1], motion.bodies["rocker"]
    c, s, (u, v) = math.cos(body.theta[0]), math.sin(body.theta[0]), body.com
    x, y = body.x[0] + c * u - s * v, body.y[0] + s * u + c * v
    dot = [x + dx * 0.002 for dx in (-1, 1, 1, -1)], [y + dy * 0.002 for dy in (-1, -1, 1, 1)]
    points = [value for pair in zip(*dot, strict=True) for value in pair]
    mark = {"points": points, "closed": True, "ink": "ink", "fill": "ink", "alpha": 1.0, "sign": "centre of mass"}
    skeleton.moving.strokes.append(structs.replace(bar, stroke=structs.replace(bar.stroke, **mark)))
    write_skeleton(out.skeleton, skeleton)


def test_fingers_reach_everything_and_no_words_overlap(seen: tuple[Out, dict[str, Any]]) -> None:
    _, observed = seen
    assert [(phone["name"], phone["state"]) for phone in observed["phones"]] == [
        (name, state) for name in ("phone", "narrow") for state in ("2d", "curves", "help")
    ]
    for phone in observed["phones"]:
        where = phone["name"], phone["state"]
        assert phone["small"] == [], where
        assert phone["overlaps"] == [], where
        assert phone["cut"] == [], where
        assert phone["wide"] <= phone["room"], where
        assert phone["errors"] == [], where


def test_sliders_that_look_inside_have_a_row_of_their_own(seen: tuple[Out, dict[str, Any]]) -> None:
    for phone in (phone for phone in seen[1]["phones"] if "inside" in phone):
        inside = phone["inside"]
        assert inside["under"], phone["name"]
        assert inside["left"] >= 0, phone["name"]
        assert inside["right"] <= phone["room"], phone["name"]
        assert inside["least"] > 60


def test_the_scrubber_has_a_row_of_its_own_and_the_speed_one_honest_word(seen: tuple[Out, dict[str, Any]]) -> None:
    _, observed = seen
    for phone in observed["phones"]:
        assert phone["scrub"] > 0.9 * phone["room"]
        assert phone["speed"] == "1/4 speed", "the film shows 1 s in 4 s"


def test_the_skeleton_is_painted_before_webgl_is_asked_for(seen: tuple[Out, dict[str, Any]]) -> None:
    _, observed = seen
    assert observed["before"]["painted"] == 1
    assert observed["before"]["width"] > 200, "the sketch is still there"
    assert observed["before"]["strokes"] >= 2
    assert observed["after"] == {"view": "3d", "notice": True}


def test_the_file_itself_shows_the_skeleton_without_a_script(seen: tuple[Out, dict[str, Any]]) -> None:
    out, observed = seen
    payload = read_payload(out)
    svg = sketch(payload["skeleton"])
    assert svg in out.view.read_text("utf-8")
    strokes = payload["skeleton"]["strokes"]
    assert observed["sketch"]["paths"] == sum(not stroke["sign"] for stroke in strokes) < len(strokes)
    assert min(observed["sketch"]["box"]["width"], observed["sketch"]["box"]["height"]) > 300


def test_marks_of_centres_of_mass_obey_their_switch(seen: tuple[Out, dict[str, Any]]) -> None:
    _, observed = seen
    on, off = ([int(pixel) for pixel in marks.split(",")] for marks in observed["marked"])
    ink = 0xFF2B2520  # of the light theme, as bytes lie in a canvas
    assert on.count(ink) > 60
    assert off.count(ink) == 0
