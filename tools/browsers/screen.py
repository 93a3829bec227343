"""A screen that nobody sees: Xvfb. Without one, these browsers have no WebGL."""

from __future__ import annotations

import os
import subprocess
from collections.abc import Iterator
from contextlib import contextmanager

from shared.stage.errors import UserError

SIZE = "1400x1000x24"
SECONDS = 20


@contextmanager
def screen(program: str) -> Iterator[dict[str, str]]:
    """An environment with the screen as its DISPLAY."""
    read, write = os.pipe()
    command = [program, "-displayfd", str(write), "-screen", "0", SIZE, "-nolisten", "tcp"]
    process = subprocess.Popen(command, pass_fds=[write], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    os.close(write)
    try:
        with os.fdopen(read) as display:
            number = display.readline().strip()
        if not number:
            raise UserError("Xvfb gives no screen")
        kept = {name: value for name, value in os.environ.items() if name != "WAYLAND_DISPLAY"}
        yield kept | {"DISPLAY": f":{number}", "GDK_BACKEND": "x11"}
    finally:
        process.terminate()
        process.wait(SECONDS)
