"""`python -m mechanisms` for a mechanism of a test's own: its folder is in the environment (elsewhere.py)."""

from __future__ import annotations

import os
from pathlib import Path

import mechanisms.stages.parts.stage  # noqa: F401  (its sources are found where they are)
from mechanisms.__main__ import main
from shared.stage.console import run_cli
from tests.studio.live import elsewhere

if __name__ == "__main__":
    elsewhere.move(Path(os.environ["MBSD_TEST_PARTS"]))
    run_cli(main)
