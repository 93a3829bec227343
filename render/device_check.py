"""The last line of ``make check``: the device that the film will be rendered on."""

from __future__ import annotations

import os
import tempfile

from shared.console import run_cli, say
from shared.errors import UserError


def main() -> None:
    """Load Blender and print what Cycles finds. Raises UserError if Blender cannot be loaded."""
    with tempfile.TemporaryDirectory() as home:
        os.environ |= {"BLENDER_USER_RESOURCES": home, "XDG_CACHE_HOME": home}  # or it writes into the home folder
        try:
            import bpy
        except ImportError as error:
            raise UserError(f"Blender cannot be loaded: {error}; make check names missing system libraries") from error
        from render.blender.device import choose

        say("render device", f"{choose(bpy.context.scene)}, Blender {bpy.app.version_string}")


if __name__ == "__main__":
    run_cli(main)
