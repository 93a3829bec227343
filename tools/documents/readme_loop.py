"""The loops at the top of README.md, filmed by the page in Chromium: docs/readme_loop.webp, readme_square.webp."""

from __future__ import annotations

import argparse
import base64
import io
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
SHOWN_LINES = (0, 1, 2, 3, 5, 11)
"""Lines that are shown: what is left out stands after them as an ellipsis."""
LEFT_OUT = 5
CHANGED = "{crank:.3f}"
"""Where the number stands that changes (m)."""
CRANK = 0.040
"""The crank's length in mechanisms/four_bar (m)."""
RATE = 10
"""Frames a second."""
SECONDS = 6.0
TURNS = 3
"""Turns of the crank in the loop, a whole number: it has no seam."""
NUMBERS = ((1.9, CRANK), (2.4, 0.025), (3.2, 0.050), (3.7, CRANK))
"""Seconds and lengths of the crank (m); in between it glides, before and after it stays."""
SOLID = ((1.3, 1.0), (1.8, 0.0), (3.7, 0.0), (4.2, 1.0))
"""How much of the solid parts is seen."""
TILTED = ((1.0, 1.0), (1.7, 0.0), (3.9, 0.0), (4.6, 1.0))
"""How far the camera has gone from before the plane to where the film has it."""
REACTIONS = ((4.6, 0.0), (4.8, 1.0), (5.7, 1.0), (5.9, 0.0))
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
FINER = 1.25
"""Pixels that are filmed for one of the file: lines are thin and smooth."""
CLOSER, BRIGHTER = 0.8, 1.5
"""Part of the film's height that is seen, and exposures of the page: the picture is small and narrow."""
QUALITIES = range(60, 10, -5)
"""Qualities of the WebP, of 100: the best whose file is small enough is taken."""
LARGEST = 300_000
"""Bytes of a file."""


@dataclass(frozen=True)
class Shape:
    """One of the files: its pixels, and those of its letters and of the room for its lines."""

    target: Path
    width: int
    height: int
    letters: float
    lines_size: int
    """Width of the lines beside the machine, or their height above it."""
    above: bool


SHAPES = (
    Shape(DOCS / "readme_loop.webp", 1000, 400, 16.4, 468, above=False),
    Shape(DOCS / "readme_square.webp", 400, 400, 13.2, 164, above=True),
)
"""For a wide window and for a phone."""
MINUTES = 60


def shown_lines() -> str:
    """Return the lines that are shown."""
    lines = LINES.splitlines()
    return "\n".join(f"{lines[k]} …" if k == LEFT_OUT else lines[k] for k in SHOWN_LINES)


def plan(shape: Shape, every: int = 1) -> dict[str, Any]:
    """Return the browser's orders: the frames, and the motion with each number but the file's own."""
    shown = frames()[::every]
    others = sorted({frame.crank for frame in shown} - {CRANK})
    patches = [base64.b64encode(_motion(crank)).decode() for crank in others]
    low, high = _extent(read_payload(Out(NAME))["skeleton"])
    return {
        "width": round(FINER * shape.width), "height": round(FINER * shape.height), "letters": FINER * shape.letters,
        "lines_size": round(FINER * shape.lines_size), "above": shape.above, "lines": shown_lines(), "changed": CHANGED,
        "low": low, "high": high, "patches": patches, "closer": CLOSER, "brighter": BRIGHTER,
        "frames": [
            {
                "patch": None if frame.crank == CRANK else others.index(frame.crank), "number": f"{frame.crank:.3f}",
                "part": frame.part, "solid": frame.solid, "tilt": frame.tilt, "reactions": frame.reactions,
            }
            for frame in shown
        ],
    }  # fmt: skip


def film(shape: Shape, every: int) -> bytes:
    """Return the animated WebP. Raises UserError where the browser is missing or fails."""
    browser = chromium()
    if browser is None:
        raise UserError("the loop is filmed by Chromium, which is missing: sudo apt-get install -y chromium")
    view.run(NAME)
    with tempfile.TemporaryDirectory(prefix="mbsd-loop-") as folder:
        planned = Path(folder) / "plan.json"
        planned.write_text(json.dumps(plan(shape, every)))
        words = [node(), Path(__file__).with_name("loop.cjs"), Out(NAME).view, planned, folder]
        needs = {"NODE_PATH": str(node_modules()), "CHROMIUM": browser}
        needs["PAGE_BROWSER"] = str(PAGE / "browser" / "browser.cjs")
        done = subprocess.run(
            [str(word) for word in words], env=os.environ | needs, capture_output=True, text=True, timeout=60 * MINUTES,
            check=False,
        )  # fmt: skip
        if done.returncode:
            raise UserError(f"the loop could not be filmed: {' '.join(done.stderr.split())[-600:]}")
        return _webp(sorted(Path(folder).glob("*.png")), (shape.width, shape.height), 1000 * every // RATE)


def _webp(files: list[Path], size: tuple[int, int], milliseconds: int) -> bytes:
    first, *rest = (Image.open(file).convert("RGB").resize(size, Image.Resampling.LANCZOS) for file in files)
    content = b""
    for quality in QUALITIES:
        buffer = io.BytesIO()
        first.save(
            buffer, "WEBP", save_all=True, append_images=rest, duration=milliseconds, loop=0, quality=quality, method=6,
            minimize_size=True,
        )  # fmt: skip
        content = buffer.getvalue()
        if len(content) <= LARGEST:
            break
    return content


def _motion(crank: float) -> bytes:
    m = run(crank)["m"]
    sources, _ = give_masses(m, None)
    return encode(Shown().payload(m.sweep(steps=120), None, sources, None, quick=False), compress=False)


def _extent(skeleton: dict[str, Any]) -> tuple[list[float], list[float]]:
    pad = 2.4 * skeleton["unit"]
    return [value - pad for value in skeleton["low"]], [value + pad for value in skeleton["high"]]


def main(words: Sequence[str]) -> None:
    """Write the loops."""
    parser = argparse.ArgumentParser(prog="python -m tools.documents readme-loop", description="The loop of README.md.")
    parser.add_argument("--every", type=int, default=1, help="film every so many frames alone, to look at it sooner")
    parser.add_argument("--to", type=Path, default=DOCS, help="their folder; docs/ if not given")
    arguments = parser.parse_args(words)
    for shape in SHAPES:
        content = film(shape, arguments.every)
        target = arguments.to / shape.target.name
        write_bytes(target, content)
        say("readme", f"{target}: {len(content) / 1e6:.2f} MB")
