"""``python -m studio.pages [--only four_bar,pendulum]``; exit code 1 if a page or a picture fails."""

from __future__ import annotations

import argparse

from shared.stage.console import run_cli
from shared.stage.paths import all_mechanisms, known_name
from studio.pages import making


def main() -> int:
    """Read the command line and write missing pages and pictures."""
    parser = argparse.ArgumentParser(
        prog="python -m studio.pages", description="The page of every mechanism, and a picture of each by Chromium."
    )
    parser.add_argument("--only", default="", help="these mechanisms: four_bar,pendulum; all if not given")
    parser.add_argument("--fresh", action="store_true", help="print the names whose page has nothing to do")
    asked = parser.parse_args()
    names = [known_name(name) for name in asked.only.split(",")] if asked.only else all_mechanisms()
    if asked.fresh:
        return making.tell_fresh(names)
    return making.run(names)


if __name__ == "__main__":
    run_cli(main)
