"""``python -m studio.fetch HOST [--folder FOLDER]``."""

from __future__ import annotations

import argparse

from shared.stage.console import run_cli
from studio.fetch import fetch


def main() -> None:
    """Read the command line and fetch the films."""
    parser = argparse.ArgumentParser(
        prog="python -m studio.fetch", description="Brings the films of another machine home, by rsync and ssh."
    )
    parser.add_argument("host", help="user@machine, as ssh takes it")
    parser.add_argument("--folder", default="", help=f"where the project is there; {fetch.FOLDER} if not given")
    arguments = parser.parse_args()
    fetch.run(arguments.host, arguments.folder)


if __name__ == "__main__":
    run_cli(main)
