"""``python -m studio.site [--only four_bar,pendulum]``; exit code 1 if a mechanism is left out."""

from __future__ import annotations

import argparse

from shared.stage.console import run_cli
from shared.stage.paths import all_mechanisms, known_name
from studio.site import build


def main() -> int:
    """Read the command line and build the site."""
    parser = argparse.ArgumentParser(
        prog="python -m studio.site", description="A wall of machines in motion and a page for each, for any web host."
    )
    parser.add_argument("--only", default="", help="these machines: four_bar,pendulum; all if not given")
    asked = parser.parse_args()
    names = [known_name(name) for name in asked.only.split(",")] if asked.only else all_mechanisms()
    return build.run(names)


if __name__ == "__main__":
    run_cli(main)
