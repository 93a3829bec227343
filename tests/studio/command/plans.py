"""Plans of commands, in this process."""

from __future__ import annotations

import contextlib
import io
import os
from unittest import mock

from shared.stage.paths import ROOT
from studio.command.main import main
from tests.running.make import EXPORTED

STAGES = ("parts", "solve", "clearance", "shot", "report", "plots", "glb", "poster", "film")


def planned(command: str, name: str, **words: str) -> list[str]:
    """Return the stages that ``make COMMAND-NAME`` would run with these words, in order: ``parts four_bar``."""
    inherited = {key: value for key, value in os.environ.items() if key not in EXPORTED}
    with mock.patch.dict(os.environ, inherited | words, clear=True), contextlib.redirect_stdout(io.StringIO()) as out:
        assert main(["-C", str(ROOT), command, "--plan", "--", name], make=True) == 0
    return [line.partition("  ")[0] for line in out.getvalue().splitlines()]
