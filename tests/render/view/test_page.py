"""The page in a real browser with WebGL in software: it shows what data.json says and does what it is told."""

from __future__ import annotations

import json
import os
import subprocess
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from render import view
from render.view.bundle import PAGE, node, node_modules
from shared.contract import read_motion, read_parts
from shared.contract.shot import Shot
from shared.stage.paths import Out
from tests.running.needs import needed
from tools.fixtures import film_fixture
from tools.fixtures.pins import dot, projected

JOINTS = ("B", "C", "B", "A", "C", "D", "B", "C", "B", "C")
STEPS = (0, 31, 77, 110, 150, 190, 222, 260, 301, 340)
WIDTH, HEIGHT = 1000, 620


@pytest.fixture(scope="module")
def page(tmp_path_factory: pytest.TempPathFactory) -> Iterator[tuple[Out, dict[str, Any], Path]]:
    chromium = needed("chromium")
    folder = tmp_path_factory.mktemp("page")
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("MBSD_OUT", str(folder / "out"))
        out = film_fixture.write(Shot(trails=()))
        view.run("four_bar")
        motion = read_motion(out.motion)
        moments = [{"time": motion.time[step], "joint": joint} for step, joint in zip(STEPS, JOINTS, strict=True)]
        plan = {
            "width": WIDTH,
            "height": HEIGHT,
            "moments": {"3d": moments, "2d": moments},
            "pin": [motion.joints["B"].x[0], motion.joints["B"].y[0]],
        }
        (folder / "plan.json").write_text(json.dumps(plan))
        command = [node(), Path(__file__).with_name("use_page.cjs"), out.view, folder, folder / "plan.json"]
        environment = {
            "NODE_PATH": str(node_modules()),
            "CHROMIUM": chromium,
            "PAGE_BROWSER": str(PAGE / "browser" / "browser.cjs"),
        }
        done = subprocess.run(
            [str(part) for part in command],
            env=os.environ | environment,
            capture_output=True,
            text=True,
            timeout=280,
            check=False,
        )
        assert done.returncode == 0, done.stderr[-3000:]
        yield out, json.loads((folder / "seen.json").read_text()), folder


def test_pins_are_within_two_pixels_of_where_data_json_projects(page: Any) -> None:
    out, seen, folder = page
    motion = read_motion(out.motion)
    assert len(seen["pins"]) == 2 * len(STEPS)
    for pin in seen["pins"]:
        step = int(np.argmin(np.abs(np.array(motion.time) - pin["time"])))
        place = motion.joints[pin["joint"]].x[step], motion.joints[pin["joint"]].y[step]
        if pin["view"] == "2d":
            (ox, oy), scale = seen["paper"]["origin"], seen["paper"]["scale"]
            wanted = ox + scale * place[0], oy - scale * place[1]
        else:
            wanted = projected(out, pin["joint"], place, seen["stage"])
        centre = dot(folder / pin["picture"])
        assert np.hypot(centre[0] - wanted[0], centre[1] - wanted[1]) < 2.0, (pin, centre, wanted)


def test_canvases_are_in_memory_where_webgl_is_in_software(page: Any) -> None:
    _, seen, _ = page
    assert len(seen["memory"]) >= 2, "the skeleton and at least a chart"
    assert all(seen["memory"]), seen["memory"]


def test_a_machine_is_taken_apart_about_its_middle_and_comes_together(page: Any) -> None:
    _, seen, _ = page
    lifts, together, apart = (np.array(seen[name]) for name in ("lifts", "together", "apart"))
    assert lifts.max() > 0
    assert apart - together == pytest.approx(lifts - lifts.max() / 2, abs=1e-9)


def test_a_section_cuts_away_what_is_in_front_and_paints_the_cut_faces(page: Any) -> None:
    _, seen, folder = page
    cut = seen["cut"]
    assert cut["clipped"]
    assert seen["whole"]
    assert cut["height"] == pytest.approx(cut["high"] - 0.4 * (cut["high"] - cut["low"]), abs=1e-6)
    assert (folder / "cut.png").stat().st_size > 0


def test_arrows_go_with_what_is_below_them_when_the_machine_is_apart(page: Any) -> None:
    out, seen, _ = page
    parts = read_parts(out.parts)
    middles = np.array([sum(parts.bodies[body].pieces[piece].z_range) / 2 for body, piece in seen["arrows"]["order"]])
    lifts, apart = np.array(seen["lifts"]), dict(seen["arrows"]["apart"])
    assert len(apart) == len(seen["arrows"]["together"]) > 2
    for index, z in seen["arrows"]["together"]:
        assert apart[index] == pytest.approx(z + lifts[middles <= z].max() - lifts.max() / 2, abs=1e-6)


def test_a_quarter_is_what_is_in_front_of_two_planes(page: Any) -> None:
    _, seen, _ = page
    assert seen["quarter"] == [[2, True]] * len(seen["quarter"])


def test_pieces_are_cut_as_the_film_cuts_them(page: Any) -> None:
    """Here the base, which stands still, so that planes of the world are its own; and a piece that is gone."""
    _, seen, _ = page
    sawn = seen["sawn"]
    assert sawn["of"]["body"] == "ground"
    assert (sawn["count"], sawn["hidden"]) == (1, 1)
    assert sawn["own"]
    assert sawn["whole"], "materials that others share stay whole"
    assert np.array(sawn["planes"]) == pytest.approx(np.array([[-1, 0, 0, 0.06], [0, -1, 0, 0.01]]), abs=1e-6)
    assert sawn["after"]


def test_planes_that_are_fixed_stay_while_a_piece_moves_through_them(page: Any) -> None:
    first, later = page[1]["fixed"]
    for seen in (first, later):
        assert seen["plane"] == pytest.approx([-1, 0, 0, 0.08], abs=1e-6)
    assert np.abs(np.array(first["mesh"]) - later["mesh"]).max() > 0.01


def test_scrubbing_keys_and_playing_move_the_machine(page: Any) -> None:
    out, seen, _ = page
    motion = read_motion(out.motion)
    end = motion.time[-1]
    assert seen["scrubbed"]["time"] == pytest.approx(end / 2, abs=0.01 * end)
    assert seen["home"]["time"] == motion.time[0]
    assert seen["stepped"]["time"] == pytest.approx(end / 120, rel=1e-6), "one of the film's 120 frames"
    assert seen["playing"]["playing"]
    assert 0.02 * end < seen["playing"]["time"] < 0.9 * end
    assert seen["end"]["time"] == end


def test_a_click_shows_a_joints_curves_and_a_drag_on_them_moves_the_machine(page: Any) -> None:
    out, seen, folder = page
    motion = read_motion(out.motion)
    assert seen["clicked"]["selected"] == {"kind": "joint", "name": "B"}
    assert seen["charts"][0] == "Reaction / N"
    time = seen["dragged"]["time"]
    assert time == pytest.approx(0.75 * motion.time[-1], abs=0.01)
    assert not seen["dragged"]["playing"]
    fx = float(np.interp(time, motion.time, motion.joints["B"].fx))
    number = seen["values"].split("x ")[1].split(" N")[0].replace("−", "-")
    assert float(number) == pytest.approx(fx, abs=2e-3 * max(map(abs, motion.joints["B"].fx)))
    head, *rows = (folder / "curves.csv").read_text().splitlines()
    assert head.startswith("time [s],joint B Reaction x [N],joint B Reaction y [N]")
    table = np.array([[float(cell) for cell in row.split(",")] for row in rows])
    assert table[:, 0] == pytest.approx(motion.time)
    assert table[:, 1] == pytest.approx(motion.joints["B"].fx, rel=1e-5, abs=1e-6)


def test_the_view_is_turned_and_moved_by_keys(page: Any) -> None:
    _, seen, _ = page
    assert seen["panned"]["pan"] == [-40, 0]
    before, turned = seen["before"], seen["turned"]
    step = np.pi / 24
    assert before["pan"] == [0, 0]
    assert (turned["azimuth"] - before["azimuth"]) % (2 * np.pi) == pytest.approx(2 * step, abs=1e-6)
    assert turned["polar"] == pytest.approx(before["polar"] - step, abs=1e-6)
    assert turned["away"] == pytest.approx(before["away"], rel=1e-9)


def test_words_of_what_is_shown_help_and_themes(page: Any) -> None:
    _, seen, _ = page
    assert seen["reactions"]["shown"]["reactions"]
    assert "reactions" in seen["reactions"]["legend"]
    assert "play, pause" in seen["help"]
    assert "three.js" in seen["help"]
    assert "Permission is hereby granted" in seen["help"]
    assert seen["light"] == "light"


def test_an_update_keeps_time_and_selection(page: Any) -> None:
    _, seen, _ = page
    assert seen["updated"]["title"] == "Another"
    assert seen["updated"]["time"] == seen["dragged"]["time"]
    assert seen["updated"]["selected"] == seen["clicked"]["selected"]


def test_everything_is_readable_and_reachable_and_nothing_complains(page: Any) -> None:
    _, seen, _ = page
    assert seen["errors"] == []
    assert seen["small"] == []
    assert seen["unreachable"] == []
    assert seen["phone"]["wide"] <= 390
    assert seen["phone"]["stage"] >= 300


def test_without_webgl_the_skeleton_and_the_curves_are_shown(page: Any) -> None:
    _, seen, _ = page
    assert seen["flat"]["view"] == "2d"
    assert "no WebGL" in seen["flat"]["notice"]
    assert seen["flat"]["charts"] >= 3
    assert seen["flat"]["errors"] == []


def test_the_file_is_small_and_names_nothing_outside(page: Any) -> None:
    out, _, _ = page
    content = out.view.read_text("utf-8")
    assert len(content.encode()) < view.LARGEST
    assert "default-src &#x27;none&#x27;" in content
    assert str(out.folder) not in content


def test_the_lock_has_no_addresses() -> None:
    lock = json.loads((PAGE / "package-lock.json").read_text())
    packages = [package for name, package in lock["packages"].items() if name]
    assert len(packages) >= 4
    assert all("integrity" in package and "resolved" not in package for package in packages)
    assert "://" not in "".join(str(package.get("resolved")) for package in packages)
