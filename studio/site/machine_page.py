"""Page of a mechanism on the site: the page of ``mbsd view`` with designs for its sliders."""

from __future__ import annotations

import base64
import subprocess
import sys
from pathlib import Path

from render.view.bundle import bundle, sources_key
from render.view.document import document, encode, sketch
from render.view.payload import read_payload
from shared.stage.console import warn
from shared.stage.files import sources_hash, write_bytes
from shared.stage.paths import ROOT, Out, mechanism_file
from shared.stage.stages import Stage, key_of, versions

SOURCES = [ROOT / "studio" / name for name in ("site/designs", "site/machine_page.py", "live/child", "live/numbers.py")]
PATIENCE = 900.0
"""Seconds in which the designs of a machine have to be there."""


def write_machine_page(name: str, target: Path) -> bool:
    """Write the page unless it is current; return True if it has sliders.

    Raises UserError.
    """
    out = Out(name)
    designs = _designs(name)
    table = designs.read_bytes() if designs.is_file() else b""
    key = key_of(out.view, designs if table else "none", sources_key(), sources_hash(*SOURCES))
    stage = Stage(out, "site-machine", key, [target])
    if not stage.is_fresh():
        payload = read_payload(out)
        more = _script(table) if table else ""
        page = document(payload["title"], encode(payload), bundle(), more, sketch=sketch(payload["skeleton"]))
        write_bytes(target, page)
        stage.record()
    return bool(table)


def _script(table: bytes) -> str:
    return f'<script type="text/plain" id="mbsd-designs">{base64.b64encode(table).decode()}</script>\n'


def _designs(name: str) -> Path:
    """Return the table of designs, built in a process of its own, since mechanism.py runs there.

    Empty where no number can be moved; missing where the process failed, which is reported and tried again.
    """
    out = Out(name)
    path = out.folder / "designs.bin"
    read = out.motion, out.skeleton, mechanism_file(name)
    key = key_of(*read, sources_hash(*SOURCES, ROOT / "render" / "view"), versions("numpy"))
    stage = Stage(out, "designs", key, [path])
    if stage.is_fresh():
        return path
    words = [sys.executable, "-m", "studio.site.designs", name]
    try:
        done = subprocess.run(words, cwd=ROOT, capture_output=True, text=True, check=False, timeout=PATIENCE)
        said = (done.stderr.strip() or f"exit code {done.returncode}").splitlines()[-1] if done.returncode else ""
    except subprocess.TimeoutExpired:
        said = f"it did not end within {PATIENCE:.0f} s"
    if said:
        warn("site", f"{name}: its page has no sliders: {said}")
        path.unlink(missing_ok=True)
    else:
        stage.record()
    return path
