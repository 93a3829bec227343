"""make as the tests run it: free of the make that may have started them."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
from pathlib import Path

from shared.stage.paths import ROOT

MAKEFILE = (ROOT / "Makefile").read_text()
EXPORTED = re.findall(r"\w+", " ".join(re.findall(r"^export ([A-Z_ ]+)$", MAKEFILE, flags=re.MULTILINE)))


def run(*command: str, cwd: Path = ROOT, **environment: str) -> subprocess.CompletedProcess[str]:
    """Run a command free of the make that may have started the tests, and of the words that it exports."""
    makes = {"MAKEFLAGS", "MAKELEVEL", "MFLAGS", "MBSD_MAKE", *EXPORTED}
    inherited = {key: value for key, value in os.environ.items() if key not in makes}
    return subprocess.run(command, cwd=cwd, capture_output=True, text=True, env=inherited | environment)


def copy_tools(folder: Path) -> None:
    """Copy the scripts of the installation: the files of tools/ that lie in no folder."""
    (folder / "tools").mkdir(parents=True)
    for file in (ROOT / "tools").iterdir():
        if file.is_file():
            shutil.copy(file, folder / "tools")
