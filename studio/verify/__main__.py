"""``python -m studio.verify NAME [--preset P] [--aspect A] [--frames 0,30] [--show WORDS]``.

The exit code is 1 if anything differs.
"""

from __future__ import annotations

import argparse
import os

from render.presets import ASPECTS, PRESETS, WIDE, preset_named, show_words
from shared.stage.console import run_cli
from shared.stage.paths import known_name
from studio.verify import verify


def main() -> int:
    """Read the command line and compare."""
    parser = argparse.ArgumentParser(
        prog="python -m studio.verify", description="Makes a mechanism's files again in scratch, and compares them."
    )
    parser.add_argument("name", help="mechanism; four-bar and four_bar are one")
    parser.add_argument("--preset", default="preview", help=f"{', '.join(PRESETS)}; preview if not given")
    parser.add_argument("--aspect", default="", help=f"{', '.join(ASPECTS)}; {WIDE} if not given")
    parser.add_argument("--frames", default="", help="numbers of frames, 0,30,60; three of the film if not given")
    parser.add_argument("--show", default="", help="what the film shows; as shot.py says if not given")
    arguments = parser.parse_args()
    os.environ.pop("PYTHONHASHSEED", None)  # each process orders its sets as it likes, which must show nowhere
    preset = preset_named(arguments.preset, arguments.aspect)
    return verify.run(known_name(arguments.name), preset, arguments.frames, show_words(arguments.show))


if __name__ == "__main__":
    run_cli(main)
