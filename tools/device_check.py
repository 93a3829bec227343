"""The last line of ``make check``: the device that the film will be rendered on."""

# pyright: reportAttributeAccessIssue=false
# bpy fills itself in when it is imported, its stubs are empty.
from __future__ import annotations

import os
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager

from shared.stage.console import run_cli, say
from shared.stage.errors import UserError
from shared.system.missing import missing_libraries, sentence


def main() -> None:
    """Load Blender and print what Cycles finds. Raises UserError if Blender cannot be loaded."""
    with tempfile.TemporaryDirectory() as home:
        os.environ |= {"BLENDER_USER_RESOURCES": home, "XDG_CACHE_HOME": home}  # or it writes into the home folder
        with _silenced():
            device = _device()
        say("render device", device)


def _device() -> str:
    try:
        import bpy
    except ImportError as error:
        lacking = missing_libraries()
        remedy = sentence(lacking) if lacking else "rm -r .venv and make install bring it anew"
        raise UserError(f"Blender cannot be loaded: {error}; {remedy}") from error
    from render.blender.worker.settings import choose

    return f"{choose(bpy.context.scene)}, Blender {bpy.app.version_string}"


@contextmanager
def _silenced() -> Iterator[None]:
    """Blender reports every backend it does not find, below Python's own stdout."""
    kept, nowhere = os.dup(1), os.open(os.devnull, os.O_WRONLY)
    try:
        os.dup2(nowhere, 1)
        yield
    finally:
        os.dup2(kept, 1)
        os.close(kept)
        os.close(nowhere)


if __name__ == "__main__":
    run_cli(main)
