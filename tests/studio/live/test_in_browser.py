"""The live page in headless Chromium: slider, drag, undo, stop, drawn path, an error cured, the file written."""

from __future__ import annotations

import json
import os
import subprocess
from pathlib import Path

import pytest

from render.view.bundle import node, node_modules
from studio.live.page import page
from tests.running.needs import needed
from tests.studio.live.served import FOUR_BAR, served

SCRIPT = Path(__file__).parent / "page.cjs"


def test_a_page_follows_hand_and_file(tmp_path: Path) -> None:
    environment = os.environ | {"CHROMIUM": needed("chromium"), "NODE_PATH": str(node_modules())}
    with served(tmp_path / "mechanisms", "links", FOUR_BAR, 200.0, show=page) as live:
        command = [str(node()), str(SCRIPT), live.live.address, os.environ.get("MBSD_PICTURES", str(tmp_path))]
        with subprocess.Popen(
            command, env=environment, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True, bufsize=1
        ) as browser:
            assert browser.stdout is not None
            assert browser.stdin is not None
            word = told = ""
            for line in browser.stdout:
                word, _, told = line.partition(" ")
                if word != "ask":
                    break
                text = FOUR_BAR.replace("0.040", "0.045")
                live.write(text if told.strip() == "cure" else text.replace("p.crank", "p.crnk"))
                browser.stdin.write("done\n")
                browser.stdin.flush()
            rest = browser.stdout.read()
        assert word == "saw", told + rest
        saw = json.loads(told)
        written = (live.folder / "links" / "mechanism.py").read_text()
    assert saw["errors"] == []
    assert saw["sliders"] == ["ground", "crank", "coupler", "rocker", "tracer x", "tracer y", "teeth", "speed"]
    assert saw["units"] == ["m"] * 6 + ["", "rad/s"]
    assert saw["slid"] == pytest.approx(0.02 + 0.25 * 0.18, abs=0.012)  # where the slider was let go
    assert saw["still"][0] == saw["still"][1], "the view stays while a number is dragged"
    assert saw["undone"] == pytest.approx(0.04, rel=1e-6)
    assert "rocker" in saw["dragged"]
    assert "speed" not in saw["dragged"]
    assert "It stops at motor" in saw["stop"]
    assert saw["progress"].endswith("mm off so far.")
    assert "crnk" in saw["notice"]
    assert saw["kept"] == pytest.approx(0.04, rel=1e-6), "the last good motion"
    assert saw["cured"]
    assert written == FOUR_BAR.replace("0.040", "0.0375")
    assert saw["after"] == {"crank": 0.045}, "what the file held before"
