"""make as the tests run it: free of the make that may have started them, or only planned."""

from __future__ import annotations

import contextlib
import io
import os
import re
import subprocess
from pathlib import Path
from unittest import mock

from shared.stage.paths import ROOT
from studio.command.main import main

MAKEFILE = (ROOT / "Makefile").read_text()
EXPORTED = re.findall(r"\w+", " ".join(re.findall(r"^export ([A-Z_ ]+)$", MAKEFILE, flags=re.MULTILINE)))
STAGES = ("parts", "solve", "clearance", "shot", "report", "plots", "glb", "poster", "film")


def run(*command: str, cwd: Path = ROOT, **environment: str) -> subprocess.CompletedProcess[str]:
    """Run a command free of the make that may have started the tests, and of the words that it exports."""
    makes = {"MAKEFLAGS", "MAKELEVEL", "MFLAGS", "MBSD_MAKE", *EXPORTED}
    inherited = {key: value for key, value in os.environ.items() if key not in makes}
    return subprocess.run(command, cwd=cwd, capture_output=True, text=True, env=inherited | environment)


def planned(command: str, name: str, **words: str) -> list[str]:
    """Return the stages that ``make COMMAND-NAME`` would run with these words, in order: ``parts four_bar``."""
    inherited = {key: value for key, value in os.environ.items() if key not in EXPORTED}
    with (
        mock.patch.dict(os.environ, inherited | words, clear=True),
        contextlib.redirect_stdout(io.StringIO()) as out,
    ):
        assert main(["-C", str(ROOT), command, "--plan", "--", name], make=True) == 0
    return [line.partition("  ")[0] for line in out.getvalue().splitlines()]
