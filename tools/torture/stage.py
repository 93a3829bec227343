"""The stages of the tiny project that make runs: ``python -m tools.torture.stage {inputs,film} NAME FOLDER``."""

from __future__ import annotations

import sys
from pathlib import Path

from render.frames import film
from render.presets import Preset
from shared.stage.console import run_cli, say
from shared.stage.files import write_bytes
from shared.stage.paths import Out
from shared.stage.stages import Stage, key_of

STAMP = Preset("draft", 64, 36, 1)
"""The picture's size: a postage stamp, rendered in milliseconds."""


def main() -> None:
    """Run one stage."""
    stage, name, folder = sys.argv[1:]
    if stage == "film":
        film.run(name, STAMP)
    else:
        inputs(name, Path(folder) / "inputs")


def inputs(name: str, folder: Path) -> None:
    """Copy the motion, the solids and the shot, in place of the solver and CAD; a stage like any other."""
    out = Out(name)
    sources = sorted(path for path in folder.rglob("*") if path.is_file())
    targets = [out.folder / path.relative_to(folder) for path in sources]
    stage = Stage(out, "inputs", key_of(*sources), targets)
    if stage.is_fresh():
        say("inputs", "nothing to do")
        return
    for source, target in zip(sources, targets, strict=True):
        write_bytes(target, source.read_bytes())
    stage.done()
    say("inputs", f"{len(targets)} files")


if __name__ == "__main__":
    run_cli(main)
