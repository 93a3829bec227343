"""The stages of the tiny project that make runs, as a module with the words {inputs,film} NAME FOLDER."""

from __future__ import annotations

import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from render.blender.job import Answer, Job
from render.frames import film, frames
from render.frames.store import FrameStore
from render.presets import Preset
from shared.stage.console import run_cli, say
from shared.stage.files import write_bytes
from shared.stage.paths import Out
from shared.stage.stages import Stage, key_of

MODULE = "tests.studio.night.torture.stage"
RENDERED = "rendered.txt"
STAMP = Preset("draft", 64, 36, 1)
"""The picture's size: a postage stamp, rendered in milliseconds."""


def main() -> None:
    """Run one stage."""
    stage, name, folder = sys.argv[1:]
    if stage == "film":
        count_pictures(Path(folder) / RENDERED)
        film.run(name, STAMP)
    else:
        inputs(name, Path(folder) / "inputs" / name)


def count_pictures(path: Path) -> None:
    """Have the frames stage add a line to a file for each picture of Blender, wherever it runs: its key."""
    makers = frames._makers

    @contextmanager
    def counting(job: Job, store: FrameStore, longest: float) -> Iterator[Iterator[Answer]]:
        def counted(answers: Iterator[Answer]) -> Iterator[Answer]:
            for answer in answers:
                if answer.key:
                    handle = os.open(path, os.O_WRONLY | os.O_CREAT | os.O_APPEND, 0o644)
                    os.write(handle, f"{answer.key}\n".encode())
                    os.close(handle)
                yield answer

        with makers(job, store, longest) as answers:
            yield counted(answers)

    frames._makers = counting


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
    stage.record()
    say("inputs", f"{len(targets)} files")


if __name__ == "__main__":
    run_cli(main)
