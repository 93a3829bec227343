"""make as the tests run it: free of the make that may have started them, or only planned."""

from __future__ import annotations

import os
import re
import subprocess
from pathlib import Path

from shared.stage.paths import ROOT

MAKEFILE = (ROOT / "Makefile").read_text()
STAGES = ("parts", "solve", "clearance", "shot", "report", "plots", "glb", "poster", "film")


def run(*command: str, cwd: Path = ROOT, **environment: str) -> subprocess.CompletedProcess[str]:
    """Run a command free of the make that may have started the tests, and of the words that it exports."""
    words = re.findall(r"^export (.*)$", MAKEFILE, flags=re.MULTILINE)[0].split()
    makes = {"MAKEFLAGS", "MAKELEVEL", "MFLAGS", "MBSD_MAKE", *words}
    inherited = {key: value for key, value in os.environ.items() if key not in makes}
    return subprocess.run(command, cwd=cwd, capture_output=True, text=True, env=inherited | environment)


def planned(*arguments: str) -> list[str]:
    """The stages that make would run, in order: ``parts four_bar``."""
    done = run("make", "-o", "install", "-o", "libraries", "PLAN=1", *arguments)
    assert done.returncode == 0, done.stderr
    return [line.partition("  ")[0] for line in done.stdout.splitlines()]
