"""The parts of the four-bar, made once a test session in a process of its own."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

from shared.paths import ROOT


def make_parts(out_root: Path, name: str = "four_bar") -> subprocess.CompletedProcess[str]:
    """``python -m mechanisms parts <name>`` into ``out_root``."""
    return subprocess.run(
        [sys.executable, "-m", "mechanisms", "parts", name],
        cwd=ROOT,
        env=os.environ | {"MBSD_OUT": str(out_root)},
        capture_output=True,
        text=True,
        check=False,
    )
