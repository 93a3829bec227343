"""`python -m studio.live` for mechanisms of a test's own, as a process of its own that may be killed."""

from __future__ import annotations

import os
import sys
from pathlib import Path

import studio.live.server  # noqa: F401  (its sources are found where they are)
from shared.stage.console import run_cli
from studio.live.__main__ import main
from studio.live.processes import nursery, stages
from tests.studio.live import elsewhere

if __name__ == "__main__":
    folder = Path(os.environ["MBSD_TEST_PARTS"])
    elsewhere.move(folder)
    os.environ[elsewhere.FOLDER] = str(folder)
    nursery.WARM = elsewhere.__name__
    stages.COMMAND = [sys.executable, "-c", f"import runpy; runpy.run_path({str(folder / 'arm' / 'parts.py')!r})"]
    stages.NICE = 0
    run_cli(main)
