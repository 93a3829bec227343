"""``python -m studio.command``: the program ``mbsd``."""

from __future__ import annotations

from shared.stage.console import run_cli
from studio.command.main import run

if __name__ == "__main__":
    run_cli(run)
