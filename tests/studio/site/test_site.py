"""The site in a browser: no error, no request, names for all, films that play; sliders show what a solver finds."""

from __future__ import annotations

import dataclasses
import json
import os
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from mechanisms.four_bar.mechanism import Params, build
from render.view.bundle import PAGE, node, node_modules
from shared.stage.errors import Busy, UserError
from shared.stage.paths import ROOT
from studio import pages as view_pages
from studio.site import build as site_build
from tests.running.needs import needed

pytestmark = pytest.mark.slow
NAMES = ["four_bar", "trammel"]
OWN = {field.name: getattr(Params(), field.name) for field in dataclasses.fields(Params)}


def _solved(names: list[str]) -> int:
    """Pages without parts, and skeletons in motion, from the command line."""
    for name in names:
        for words in (["mechanisms", "solve", name], ["render", "view", name]):
            subprocess.run([sys.executable, "-m", *words], cwd=ROOT, check=True, capture_output=True)
    return 0


@pytest.fixture(scope="module")
def site(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Path]:
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("MBSD_OUT", str(tmp_path_factory.mktemp("site") / "out"))
        patch.setattr(view_pages, "run", _solved)
        assert site_build.run(NAMES) == 0
        yield Path(os.environ["MBSD_OUT"]) / "site"


@pytest.fixture(scope="module")
def seen(site: Path) -> dict[str, Any]:
    browser = needed("chromium")
    moved = {"coupler": 0.1279, "ground": 0.1171, "rocker": 0.0843}
    plan = {"name": "four_bar", "values": moved, "own": {name: OWN[name] for name in moved}}
    environment = {
        "NODE_PATH": str(node_modules()),
        "CHROMIUM": browser,
        "PAGE_BROWSER": str(PAGE / "browser" / "browser.cjs"),
    }
    words = [str(node()), str(Path(__file__).with_name("use_site.cjs")), str(site), json.dumps(plan)]
    done = subprocess.run(words, env=os.environ | environment, capture_output=True, text=True, timeout=280, check=False)
    assert done.returncode == 0, done.stderr[-3000:]
    return json.loads(done.stdout) | {"values": moved}


def test_pages_have_no_errors_and_ask_no_network(seen: dict[str, Any]) -> None:
    assert seen["errors"] == []


@pytest.mark.parametrize("page", ["wall", "machine", "phone"])
def test_pictures_have_sizes_things_have_names_and_nothing_is_cut(seen: dict[str, Any], page: str) -> None:
    looked = seen["pages"][page]
    assert looked["unsized"] == 0
    assert looked["nameless"] == 0
    assert looked["wide"] <= looked["room"]


def test_search_finds_and_the_address_keeps_it(seen: dict[str, Any]) -> None:
    assert seen["all"] == ["Four bar", "Trammel"]
    assert seen["searched"] == ["Four bar"]
    assert seen["address"] == "#q=rocker"
    assert seen["cleared"] == seen["all"]
    assert seen["none"] == [[], "No machine answers to that; clear the search or the filter."]


def test_the_loop_plays_under_the_focus_and_the_theme_changes(seen: dict[str, Any]) -> None:
    assert seen["plays"]
    assert seen["theme"] == ["dark", "rgb(21, 23, 26)"]


def test_sliders_show_what_a_solver_finds(seen: dict[str, Any]) -> None:
    names = [name for name, _, _ in seen["sliders"]]
    assert set(seen["values"]) == set(names)
    moved = seen["moved"]
    assert moved["shown"] == pytest.approx(seen["values"])
    m = build(dataclasses.replace(Params(), **seen["values"]))
    sol = m.sweep(times=np.array(moved["time"]))
    joint = sol.joint("C")
    assert np.hypot(joint.x - moved["x"], joint.y - moved["y"]).max() < 5e-4 * 0.25, "of the machine's size"
    assert seen["back"] > len(moved["x"]), "its own numbers bring back the whole motion"


def test_the_files_of_a_machine_are_offered(site: Path) -> None:
    page = (site / "four_bar" / "index.html").read_text()
    files = {path.name for path in (site / "four_bar" / "files").iterdir()}
    assert files == {"mechanism.py", "data.json"}
    assert all(f'href="files/{name}"' in page for name in files)
    assert (site / "four_bar" / "files" / "mechanism.py").read_bytes() == Path(
        sys.modules[Params.__module__].__file__ or ""
    ).read_bytes()


def test_a_second_run_writes_nothing_and_what_is_gone_goes(site: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(view_pages, "run", lambda names: 0)
    before = {path: path.stat().st_mtime_ns for path in site.rglob("*") if path.is_file()}
    assert site_build.run(NAMES) == 0
    assert {path: path.stat().st_mtime_ns for path in site.rglob("*") if path.is_file()} == before
    own = site / "notes"
    own.mkdir()
    (own / "mine.txt").write_text("not made here")
    assert site_build.run(["four_bar"]) == 0
    assert not (site / "trammel").exists()
    assert (own / "mine.txt").is_file()
    assert site_build.run(NAMES) == 0


def test_a_machine_without_a_page_is_named_and_left_out(
    site: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(view_pages, "run", lambda names: 1)
    assert site_build.run([*NAMES, "pendulum"]) == 1
    assert "pendulum is left out: it has no page" in capsys.readouterr().err
    with pytest.raises(UserError, match="no machine has a motion"):
        site_build.run(["pendulum"])


def test_two_sites_are_not_made_in_one_folder_at_a_time(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    folder = tmp_path / "site"
    second: list[BaseException] = []

    def meanwhile(names: list[str]) -> int:
        with pytest.raises(Busy, match=r"another process writes .*site; wait for it or stop it") as refused:
            site_build.run(["trammel"], folder)
        second.append(refused.value)
        return 1

    monkeypatch.setattr(view_pages, "run", meanwhile)
    for _ in range(2):  # the folder is free again after a failure
        with pytest.raises(UserError, match="no machine has a motion"):
            site_build.run(["nothing_made"], folder)
    assert len(second) == 2
