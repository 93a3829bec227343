"""Parts come when they are made: the skeleton is there first, errors and newer files end what is being made."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import time
from pathlib import Path

import psutil
import pytest

from render.view.bundle import node, node_modules
from studio.live.page import page
from studio.live.processes import stages
from tests.running.needs import needed
from tests.studio.live.arm import ARM, arm
from tests.studio.live.served import served

SCRIPT = Path(__file__).parent / "parts.cjs"
PARTS = '''"""A box for the crank."""

import cadquery as cq

from mechanisms.arm.mechanism import Params
from shared.shapes.solid import Solid


def parts(p: Params) -> dict[str, list[Solid]]:
    """One piece."""
    box = cq.Workplane().box(1000 * p.length, 20, 10, centered=(False, True, False))
    return {"crank": [Solid("bar", box, "aluminium", 0)]}
'''
SLOW = "import time\n\ntime.sleep(300)\n" + PARTS
WRONG = "raise RuntimeError('no unobtainium')\n"
BROKEN = ARM.replace("p.length", "p.lenght")


@pytest.mark.slow
def test_parts_follow_the_skeleton(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    folder = tmp_path / "mechanisms"
    monkeypatch.setenv("MBSD_TEST_PARTS", str(folder))
    monkeypatch.setattr(stages, "COMMAND", [sys.executable, "-m", "tests.studio.live.stage"])
    monkeypatch.setattr(stages, "NICE", 0)  # beside other tests it would wait
    environment = os.environ | {"CHROMIUM": needed("chromium"), "NODE_PATH": str(node_modules())}
    edits = {
        "longer": [("parts.py", SLOW), ("mechanism.py", arm(0.3))],
        "break": [("mechanism.py", BROKEN)],
        "cure": [("parts.py", PARTS), ("mechanism.py", ARM)],
        "finer": [("mechanism.py", ARM.replace("STEPS = 24", "STEPS = 36"))],
        "wrong": [("parts.py", WRONG)],
    }
    left: dict[str, int] = {}
    with served(folder, "arm", ARM, 200.0, parts=True, show=page, files={"parts.py": PARTS}) as live:
        command = [str(node()), str(SCRIPT), live.live.address, os.environ.get("MBSD_PICTURES", str(tmp_path))]
        with subprocess.Popen(
            command, env=environment, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True, bufsize=1
        ) as browser:
            assert browser.stdout is not None
            assert browser.stdin is not None
            word = told = ""
            for line in browser.stdout:
                word, _, told = line.partition(" ")
                if word == "count":
                    left[told.strip()] = _stages(0 if told.strip() == "broken" else 1)
                elif word == "ask":
                    for file, text in edits[told.strip()]:
                        live.write(text, file)
                else:
                    break
                browser.stdin.write("done\n")
                browser.stdin.flush()
            rest = browser.stdout.read()
    assert word == "saw", told + rest
    saw = json.loads(told)
    assert saw["errors"] == []
    assert saw["first"] == {"solid": False, "state": "making parts"}
    assert saw["parts"] == pytest.approx(0.2, abs=0.001)
    slid = {"solid": True, "length": pytest.approx(0.25, rel=1e-3), "other": True, "clear": 0.62}
    assert (saw["slid"], saw["again"]) == (slid, slid), "parts that come later, and a page that does"
    assert saw["unchanged"] == [True, True], "a number equal to the file's is not changed"
    assert saw["back"] == {"solid": True, "length": pytest.approx(0.2, rel=1e-3), "other": False, "clear": 1}
    stretched = {"solid": True, "length": pytest.approx(0.3, rel=1e-3), "other": True, "clear": 0.62}
    assert saw["longer"] == stretched | {"state": "making parts"}, "the old parts serve meanwhile"
    assert left == {"longer": 1, "broken": 0}, "an error ends the older run"
    assert "lenght" in saw["notice"]
    assert saw["cured"] == pytest.approx(0.2, abs=0.001)
    assert saw["finer"] == {"steps": 37, "gone": 0, "uneven": 0}, "parts stay in sight while only the motion changes"
    assert "unobtainium" in saw["wrong"]
    assert saw["kept"], "the last parts"


def _stages(wanted: int) -> int:
    """Return the number of processes that build parts, after a moment to begin or end."""
    ends = time.monotonic() + 20
    while True:
        running = 0
        for process in psutil.Process().children(recursive=True):
            try:
                running += (
                    process.status() != psutil.STATUS_ZOMBIE and "tests.studio.live.stage" in process.cmdline()[:3]
                )
            except psutil.NoSuchProcess:
                continue
        if running == wanted or time.monotonic() > ends:
            return running
        time.sleep(0.1)
