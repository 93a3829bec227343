"""`python -m render pages`: a picture of every page, by Chromium with WebGL in software: out/<name>/view.png."""

from __future__ import annotations

import json
import os
import shutil
import subprocess

from render.view.bundle import PAGE, node, node_modules
from shared.stage.console import say, warn
from shared.stage.errors import UserError
from shared.stage.paths import Out, mechanism_names

BROWSERS = ("chromium", "chromium-browser", "google-chrome")
LOOKS = {"width": 1280, "height": 720, "part": 0.3, "wait": 800}
MINUTES = 5
"""For one picture."""


def run() -> int:
    """Picture every page; 1 if one of them complained, else 0. Raises UserError without a page or a browser."""
    pages = [out for out in map(Out, mechanism_names()) if out.view.is_file()]
    if not pages:
        raise UserError("there is no page yet; make view-<name> makes one")
    browser = chromium()
    if browser is None:
        raise UserError(
            "pictures of pages need Chromium (Debian: apt-get install chromium); the pages themselves do not"
        )
    complained = 0
    for out in pages:
        error = picture(out, browser)
        if error:
            complained += 1
            warn("pages", f"{out.name}: {error}")
        else:
            say("pages", f"{out.name}: {out.view.with_suffix('.png')}")
    return int(complained > 0)


def chromium() -> str | None:
    """The browser's program: $CHROMIUM, or the first one in PATH."""
    return os.environ.get("CHROMIUM") or next(filter(None, map(shutil.which, BROWSERS)), None)


def picture(out: Out, browser: str) -> str:
    """Write view.png; what the page or the browser said, or nothing."""
    image = out.view.with_suffix(".png")
    command = [str(node()), str(PAGE / "browser" / "picture.cjs"), str(out.view), str(image), json.dumps(LOOKS)]
    environment = os.environ | {"NODE_PATH": str(node_modules()), "CHROMIUM": browser}
    try:
        done = subprocess.run(
            command, env=environment, capture_output=True, text=True, timeout=60 * MINUTES, check=False
        )
    except subprocess.TimeoutExpired:
        return f"no picture within {MINUTES} minutes"
    return " ".join(done.stderr.split())[-400:] if done.returncode else ""
