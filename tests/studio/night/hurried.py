"""``python -m tests.studio.night.hurried run ...``: ``python -m studio.night run ...`` whose long waits are short."""

from __future__ import annotations

from shared.stage.console import run_cli
from studio.night import coordinator, process
from studio.night.__main__ import main

process.GRACE = 1.0
coordinator.BUSY_ELSEWHERE = 0.5

if __name__ == "__main__":
    run_cli(main)
