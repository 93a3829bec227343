"""The loop at the top of README.md, filmed by the page in Chromium: docs/readme_loop.webp."""

from __future__ import annotations

import argparse
import base64
import json
import os
import subprocess
import tempfile
from collections.abc import Sequence
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
from tools.documents.readme_loop.story import CHANGED, CRANK, LINES, RATE, frames, run

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
