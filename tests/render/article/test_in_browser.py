"""An article in Chromium: paragraphs bring their moment, numbers follow, keys and readers reach all of it."""

from __future__ import annotations

import json
import os
import subprocess
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from render import article
from render.view.bundle import PAGE, bundle, node, node_modules
from shared.contract import Motion, read_motion
from shared.contract.shot import Shot
from tests.running.needs import needed
from tools.fixtures import film_fixture


@pytest.fixture(scope="module")
def seen(tmp_path_factory: pytest.TempPathFactory) -> Iterator[tuple[Motion, dict[str, Any]]]:
    chromium = needed("chromium")
    folder = Path(os.environ.get("MBSD_PICTURES", str(tmp_path_factory.mktemp("article"))))
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("MBSD_OUT", str(folder / "out"))
        out = film_fixture.write(Shot())
        article.run("four_bar")
        browser = {"CHROMIUM": chromium, "PAGE_BROWSER": str(PAGE / "browser" / "browser.cjs")}
        done = subprocess.run(
            [str(node()), str(Path(__file__).with_name("use_article.cjs")), str(out.article), str(folder)],
            env=os.environ | browser | {"NODE_PATH": str(node_modules())},
            capture_output=True, text=True, timeout=280, check=False,
        )  # fmt: skip
        assert done.returncode == 0, done.stderr[-3000:]
        yield read_motion(out.motion), json.loads(done.stdout)


@pytest.mark.parametrize("size", ["desk", "phone"])
def test_everything_has_a_name_a_place_in_the_order_and_room(seen: tuple[Motion, dict[str, Any]], size: str) -> None:
    looked = seen[1][size]
    assert looked["errors"] == []
    assert looked["headings"] == ["H1", *["H2"] * 8]
    assert (looked["nameless"], looked["unvalued"], looked["unreachable"]) == ([], 0, 0)
    assert looked["wide"] <= looked["room"]
    assert looked["stage"] > 200
    assert looked["language"] == "en"


@pytest.mark.parametrize("size", ["desk", "phone"])
def test_a_paragraph_brings_its_moment_its_arrows_and_its_curve(seen: tuple[Motion, dict[str, Any]], size: str) -> None:
    forces, printed = seen[1][size]["forces"], seen[1][size]["print"]
    assert forces["current"] == "forces"
    assert forces["shown"]["reactions"]
    assert forces["title"].startswith("Effort of motor")
    assert not forces["playing"], "who asks for less motion gets none by itself"
    assert printed["current"] == "print"
    assert printed["apart"] == 1
    assert not printed["shown"].get("reactions")


def test_numbers_of_the_moment_are_those_of_the_motion(seen: tuple[Motion, dict[str, Any]]) -> None:
    motion, observed = seen
    before, dragged = observed["turn"], observed["dragged"]
    span = motion.time[-1] - motion.time[0]
    assert dragged["time"] - motion.time[0] == pytest.approx(0.11 * span, rel=1e-6), "Page Up is 10 %, an arrow 1 %"
    assert before["time"] != dragged["time"]
    crank = np.degrees(np.interp(dragged["time"], motion.time, motion.drivers["motor"].value)) % 360
    assert next(words for _, of, words in dragged["drag"] if of == "motor") == f"{round(crank)}°"
    for measure, of, words in dragged["now"]:
        kind, name, series = of.split("/")
        if measure != "now" or kind != "body" or series != "theta":
            continue
        angle = np.degrees(np.interp(dragged["time"], motion.time, motion.bodies[name].theta))
        assert float(words.rstrip("°").replace("−", "-")) == pytest.approx(angle, abs=0.6)
    force = next(words for measure, of, words in dragged["now"] if of.startswith("joint/") and measure == "now")
    joint = motion.joints[next(of for _, of, _ in dragged["now"] if of.startswith("joint/")).split("/")[1]]
    size = float(np.interp(dragged["time"], motion.time, np.hypot(joint.fx, joint.fy)))
    assert float(force.split()[0]) * (1e-3 if "mN" in force else 1.0) == pytest.approx(size, rel=0.02)


def test_enter_on_a_name_points_at_the_thing(seen: tuple[Motion, dict[str, Any]]) -> None:
    assert seen[1]["shows"]["selected"] == {"kind": "joint", "name": "B"}


def test_it_is_read_without_a_script_and_prints_with_a_picture(seen: tuple[Motion, dict[str, Any]]) -> None:
    plain = seen[1]["plain"]
    assert plain["text"] > 1500
    assert plain["sketch"] == 3
    assert plain["roles"] == 0, "nothing that a script has to make work"
    assert seen[1]["printed"] == {"sketch": True, "stage": False}


def test_its_script_is_little_more_than_the_pages() -> None:
    assert len(bundle("article").script.encode()) < len(bundle().script.encode()) + 60_000
