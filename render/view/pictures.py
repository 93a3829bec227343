"""A picture of a page, by Chromium with WebGL in software: out/<name>/view.png."""

from __future__ import annotations

import json
import os
import subprocess
import tempfile
from pathlib import Path

from render.view.bundle import LOCKED, PAGE, node, node_modules
from shared.stage.errors import UserError
from shared.stage.files import write_bytes
from shared.stage.paths import Out
from shared.stage.stages import Stage, key_of
from shared.system import missing

LOOKS = {"width": 1280, "height": 720, "part": 0.3}
MINUTES = 5
"""For one picture."""


def chromium() -> str | None:
    """Return the browser's program: $CHROMIUM, or the first one in PATH."""
    return missing.program("chromium")


def version_of(browser: str) -> str:
    """Return the version that a browser reports. Raises UserError if it reports none."""
    try:
        done = subprocess.run([browser, "--version"], capture_output=True, text=True, timeout=60, check=False)
    except (OSError, subprocess.TimeoutExpired) as error:
        raise UserError(f"{browser} does not start: {error}") from None
    if done.returncode:
        raise UserError(f"{browser} does not start: {' '.join(done.stderr.split())[-200:]}")
    return done.stdout.strip()


def stage_of(out: Out, version: str) -> Stage:
    """Return the picture's stage.

    The page's bytes, the browser's version and the script that takes the picture decide.
    """
    scripts = [PAGE / "browser" / name for name in ("picture.cjs", "browser.cjs")]
    key = key_of(out.view, version, *scripts, *(PAGE / name for name in LOCKED), LOOKS)
    return Stage(out, "view_picture", key, [picture_of(out)])


def picture_of(out: Out) -> Path:
    """Return the file."""
    return out.view.with_suffix(".png")


def take_picture(out: Out, browser: str) -> None:
    """Write view.png.

    Raises UserError with what the page or the browser complained of; then there is none.
    """
    picture_of(out).unlink(missing_ok=True)
    with tempfile.TemporaryDirectory(prefix="mbsd-page-") as folder:
        image = Path(folder) / "view.png"
        words = [str(node()), str(PAGE / "browser" / "picture.cjs"), str(out.view), str(image), json.dumps(LOOKS)]
        environment = os.environ | {"NODE_PATH": str(node_modules()), "CHROMIUM": browser}
        try:
            done = subprocess.run(
                words, env=environment, capture_output=True, text=True, timeout=60 * MINUTES, check=False
            )
        except subprocess.TimeoutExpired:
            raise UserError(f"{out.name}: no picture of its page within {MINUTES} minutes") from None
        if done.returncode or not image.is_file():
            said = " ".join(done.stderr.split())[-400:] or "the browser wrote none"
            raise UserError(f"{out.name}: no picture of its page: {said}")
        write_bytes(picture_of(out), image.read_bytes())
