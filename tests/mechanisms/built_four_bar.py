"""The parts of the four-bar, made in a process of its own."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

from shared.stage.paths import ROOT


def make_parts(out_root: Path, name: str = "four_bar") -> subprocess.CompletedProcess[str]:
    """``python -m mechanisms parts <name>`` into ``out_root``, to its end."""
    process = start_parts(out_root, name)
    stdout, stderr = process.communicate()
    return subprocess.CompletedProcess(process.args, process.returncode, stdout, stderr)


def start_parts(out_root: Path, name: str = "four_bar") -> subprocess.Popen[str]:
    """The same, not waited for."""
    return subprocess.Popen(
        [sys.executable, "-m", "mechanisms", "parts", name],
        cwd=ROOT,
        env=os.environ | {"MBSD_OUT": str(out_root)},
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )
