"""The loop at the top of README.md, filmed by the page in Chromium: docs/readme_loop.webp."""

from __future__ import annotations

import argparse
import base64
import json
import os
import subprocess
import tempfile
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path
from typing import Any

from PIL import Image

from mechanisms.stages.solve.masses import give_masses
from render import view
from render.view.bundle import PAGE, node, node_modules
from render.view.document import encode
from render.view.payload import read_payload
from render.view.pictures import chromium
from shared.stage.console import say
from shared.stage.errors import UserError
from shared.stage.files import write_bytes
from shared.stage.paths import Out
from studio.live.child.author import Shown
from tools.documents.pages import DOCS

# Story of the loop: its twelve lines, the number that changes, the crank's turns, the parts, reactions and camera.
#
# The lines that are shown are those that are run, with the number as it is at the moment.


LINES = """\
m = Mechanism("four_bar")
crank = m.bar("crank", {crank:.3f})
coupler = m.bar("coupler", 0.120)
rocker = m.bar("rocker", 0.090)
m.revolute("A", m.ground.at(0, 0), crank.start)
m.revolute("B", crank.end, coupler.start)
m.revolute("C", coupler.end, rocker.end)
m.revolute("D", m.ground.at(0.120, 0), rocker.start)
m.drive_angle("motor", crank, constant_rate(2 * pi))
m.trace("P", coupler.at(0.060, 0.030))
m.start_near(crank=0, coupler=45, rocker=100)
sol = m.sweep()"""
CHANGED = "{crank:.3f}"
"""Where the number stands that changes (m)."""
CRANK = 0.040
"""The crank's length in mechanisms/four_bar (m)."""
RATE = 12
"""Frames a second."""
SECONDS = 6.4
TURNS = 3
"""Turns of the crank in the loop, a whole number: it has no seam."""
NUMBERS = ((0.5, CRANK), (1.2, 0.025), (2.2, 0.050), (2.8, CRANK))
"""Seconds and lengths of the crank (m); in between it glides, before and after it stays."""
SOLID = ((2.9, 0.0), (3.35, 1.0), (5.85, 1.0), (6.3, 0.0))
"""How much of the solid parts is seen."""
TILTED = ((3.2, 0.0), (4.0, 1.0), (5.3, 1.0), (6.0, 0.0))
"""How far the camera has gone from before the plane to where the film has it."""
REACTIONS = ((3.9, 0.0), (4.1, 1.0), (5.1, 1.0), (5.3, 0.0))
SHOWN = (SOLID, TILTED, REACTIONS)


@dataclass(frozen=True)
class Frame:
    """One picture."""

    crank: float
    """m, in millimetres as it is written"""
    part: float
    """Fraction of a turn, 0 .. 1."""
    solid: float
    tilt: float
    reactions: float


def frames() -> list[Frame]:
    """Return all frames, at equal times."""
    count = round(RATE * SECONDS)
    times = [SECONDS * k / count for k in range(count)]
    return [
        Frame(round(_value(NUMBERS, t), 3), TURNS * t / SECONDS % 1.0, *(_value(steps, t) for steps in SHOWN))
        for t in times
    ]


def _value(steps: tuple[tuple[float, float], ...], t: float) -> float:
    """Return the value at a time, smooth from one step to the next."""
    if t <= steps[0][0]:
        return steps[0][1]
    for (a, low), (b, high) in pairwise(steps):
        if t <= b:
            part = (t - a) / (b - a)
            return low + (high - low) * part * part * (3 - 2 * part)
    return steps[-1][1]


def run(crank: float) -> dict[str, Any]:
    """Return the variables of the lines: the mechanism ``m``, its motion ``sol`` and others."""
    import mbsd

    variables: dict[str, Any] = {
        "Mechanism": mbsd.Mechanism,
        "constant_rate": mbsd.constant_rate,
        "pi": 3.141592653589793,
    }
    exec(LINES.format(crank=round(crank, 3)), variables)
    return variables


NAME = "four_bar"
TARGET = DOCS / "readme_loop.webp"
WIDTH, HEIGHT, LINES_WIDTH = 960, 420, 440
SIZE = 720, 315
"""Pixels of the file's pictures: filmed larger, their lines are thin and smooth."""
CLOSER, BRIGHTER = 0.8, 1.5
"""Part of the film's height that is seen, and exposures of the page: the picture is small and narrow."""
QUALITY = 44
"""Quality of the WebP, of 100."""
MINUTES = 60


def plan(every: int = 1) -> dict[str, Any]:
    """Return the browser's orders: the frames, and the motion with each number but the file's own."""
    shown = frames()[::every]
    others = sorted({frame.crank for frame in shown} - {CRANK})
    patches = [base64.b64encode(_motion(crank)).decode() for crank in others]
    low, high = _extent(read_payload(Out(NAME))["skeleton"])
    return {
        "width": WIDTH, "height": HEIGHT, "lines_width": LINES_WIDTH, "lines": LINES, "changed": CHANGED,
        "low": low, "high": high, "patches": patches, "closer": CLOSER, "brighter": BRIGHTER,
        "frames": [
            {
                "patch": None if frame.crank == CRANK else others.index(frame.crank), "number": f"{frame.crank:.3f}",
                "part": frame.part, "solid": frame.solid, "tilt": frame.tilt, "reactions": frame.reactions,
            }
            for frame in shown
        ],
    }  # fmt: skip


def film(every: int) -> bytes:
    """Return the animated WebP. Raises UserError where the browser is missing or fails."""
    browser = chromium()
    if browser is None:
        raise UserError("the loop is filmed by Chromium, which is missing: sudo apt-get install -y chromium")
    view.run(NAME)
    with tempfile.TemporaryDirectory(prefix="mbsd-loop-") as folder:
        planned = Path(folder) / "plan.json"
        planned.write_text(json.dumps(plan(every)))
        words = [node(), Path(__file__).with_name("loop.cjs"), Out(NAME).view, planned, folder]
        needs = {"NODE_PATH": str(node_modules()), "CHROMIUM": browser}
        needs["PAGE_BROWSER"] = str(PAGE / "browser" / "browser.cjs")
        done = subprocess.run(
            [str(word) for word in words], env=os.environ | needs, capture_output=True, text=True, timeout=60 * MINUTES,
            check=False,
        )  # fmt: skip
        if done.returncode:
            raise UserError(f"the loop could not be filmed: {' '.join(done.stderr.split())[-600:]}")
        return _webp(sorted(Path(folder).glob("*.png")), 1000 * every // RATE)


def _webp(files: list[Path], milliseconds: int) -> bytes:
    first, *rest = (Image.open(file).convert("RGB").resize(SIZE, Image.Resampling.LANCZOS) for file in files)
    with tempfile.NamedTemporaryFile(suffix=".webp") as made:
        first.save(
            made.name, save_all=True, append_images=rest, duration=milliseconds, loop=0, quality=QUALITY, method=6,
            minimize_size=True,
        )  # fmt: skip
        return Path(made.name).read_bytes()


def _motion(crank: float) -> bytes:
    m = run(crank)["m"]
    sources, _ = give_masses(m, None)
    return encode(Shown().payload(m.sweep(steps=120), None, sources, None, quick=False), compress=False)


def _extent(skeleton: dict[str, Any]) -> tuple[list[float], list[float]]:
    pad = 2.4 * skeleton["unit"]
    return [value - pad for value in skeleton["low"]], [value + pad for value in skeleton["high"]]


def main(words: Sequence[str]) -> None:
    """Write docs/readme_loop.webp."""
    parser = argparse.ArgumentParser(prog="python -m tools.documents readme-loop", description="The loop of README.md.")
    parser.add_argument("--every", type=int, default=1, help="film every so many frames alone, to look at it sooner")
    parser.add_argument("--to", type=Path, default=TARGET, help="the file; docs/readme_loop.webp if not given")
    arguments = parser.parse_args(words)
    content = film(arguments.every)
    write_bytes(arguments.to, content)
    say("readme", f"{arguments.to}: {len(content) / 1e6:.2f} MB")
