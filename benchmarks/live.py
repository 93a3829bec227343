"""``make bench-live``: milliseconds from a slider of the live page to the picture that shows it.

The slider moves on when the picture of its last step is on the screen; a picture counts once its frame is over. With
``--beside FOLDER`` a checkout of another version is measured in turns with this one, and the ratio is reported: that
holds on a machine that others keep busy, where milliseconds alone say little.
"""

from __future__ import annotations

import argparse
import json
import os
import statistics
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from render.view.bundle import PAGE, node, node_modules
from render.view.pictures import chromium
from shared.stage.console import say
from shared.stage.errors import UserError
from shared.stage.paths import ROOT

SCRIPT = Path(__file__).with_name("slider.cjs")
MINUTES = 10
VIEWS = {"2d": "skeleton", "3d": "parts, WebGL in software"}
WANTED = 100.0
"""Milliseconds in the median, on two cores that do nothing else."""


def measured(words: list[str]) -> int:
    """Measure and show."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks live", description="From a slider to the picture.")
    parser.add_argument("--name", default="four_bar", help="mechanism; it needs a pin B that the slider moves")
    parser.add_argument("--slider", default="crank")
    parser.add_argument("--count", type=int, default=40, help="steps of the slider in each turn")
    parser.add_argument("--turns", type=int, default=2)
    parser.add_argument("--views", default="2d", help="of: 2d, 3d")
    parser.add_argument("--beside", type=Path, help="a checkout of another version")
    arguments = parser.parse_args(words)
    browser = chromium()
    if browser is None:
        raise UserError("bench live: Chromium is missing: sudo apt-get install -y chromium")
    roots = {"this": ROOT} | ({"other": arguments.beside.resolve()} if arguments.beside else {})
    for view in arguments.views.split(","):
        times: dict[str, list[float]] = {which: [] for which in roots}
        busy = dict.fromkeys(roots, 0.0)
        for _ in range(arguments.turns):
            for which, root in roots.items():
                with _served(root, arguments.name, ["--no-parts"] if view == "2d" else []) as address:
                    seen = _seen(browser, address, arguments.slider, view, arguments.count)
                times[which] += seen["milliseconds"]
                busy[which] += 1000 * seen["processor"]
        _tell(view, times, busy)
    return 0


def _tell(view: str, times_of: dict[str, list[float]], busy: dict[str, float]) -> None:
    load = ", ".join(f"{value:.1f}" for value in os.getloadavg())
    for which, times in times_of.items():
        low, *_, high = statistics.quantiles(times, n=10)
        say(
            "bench",
            f"{VIEWS[view]}, {which} version: median {statistics.median(times):.0f} ms, nine of ten below {high:.0f}, "
            f"one below {low:.0f}; {busy[which] / len(times):.0f} ms of processor time of browser and server; "
            f"{len(times)} steps, {os.cpu_count()} cores, load {load}",
        )
    if "other" in times_of:
        ratio = statistics.median(times_of["other"]) / statistics.median(times_of["this"])
        say("bench", f"{VIEWS[view]}: the other version takes {ratio:.2f} times as long in the median")


def _seen(browser: str, address: str, slider: str, view: str, count: int) -> dict[str, Any]:
    needs = {"CHROMIUM": browser, "NODE_PATH": str(node_modules())}
    needs |= {f"PAGE_{name.upper()}": str(PAGE / "browser" / f"{name}.cjs") for name in ("browser", "processor")}
    done = subprocess.run(
        [str(node()), str(SCRIPT), address, slider, view, str(count)], env=os.environ | needs, capture_output=True,
        text=True, timeout=60 * MINUTES, check=False,
    )  # fmt: skip
    if done.returncode:
        raise UserError(f"bench live: the browser failed: {' '.join(done.stderr.split())[-400:]}")
    return json.loads(done.stdout)


@contextmanager
def _served(root: Path, name: str, options: list[str]) -> Iterator[str]:
    """The address of a live page of the sources in ``root``."""
    command = [sys.executable, "-u", "-m", "studio.live", name, *options]
    with (
        tempfile.TemporaryFile("w+") as said,  # at its end the server says that it was stopped, which is no news here
        subprocess.Popen(command, cwd=root, stdout=subprocess.PIPE, stderr=said, text=True) as server,
    ):
        assert server.stdout is not None
        try:
            for line in server.stdout:
                if "http://" in line:
                    yield line.split(": ")[-1].split(" ")[0]
                    return
            said.seek(0)
            raise UserError(f"bench live: no server of {name} in {root}: {' '.join(said.read().split())[:600]}")
        finally:
            server.terminate()
