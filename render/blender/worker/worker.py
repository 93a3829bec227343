"""The Blender process: ``python -m render.blender.worker.worker JOB.json``. Answers in JSON lines.

It ends by itself when its standard input closes, so that it never outlives the process that started it.
"""

# pyright: reportAttributeAccessIssue=false
# bpy fills itself in when it is imported, its stubs are empty.
from __future__ import annotations

import os
import signal
import sys
from collections.abc import Callable, Iterator
from itertools import chain
from pathlib import Path
from typing import Any

import msgspec

from render.blender.job import Answer, Job, Picture
from render.blender.worker.libraries import missing_library
from render.blender.worker.parent import die_with_parent
from render.film.scene import State
from shared.stage.errors import UserError
from shared.stage.signals import end_with_parent


def main() -> int:
    """Do the job named on the command line."""
    answers = os.fdopen(os.dup(1), "w", buffering=1)
    os.dup2(2, 1)  # Blender chats on stdout; the parent keeps stderr for the case of a failure

    def answer(**fields: Any) -> None:
        answers.write(msgspec.json.encode(Answer(**fields)).decode() + "\n")
        answers.flush()

    lines = die_with_parent()
    job = msgspec.json.decode(Path(sys.argv[1]).read_bytes(), type=Job)
    if not job.waits:  # else it is kept from picture to picture by a process whose threads come and go
        end_with_parent(signal.SIGKILL)
    more = (msgspec.json.decode(line, type=Picture) for line in lines) if job.waits else iter(())
    answer(doing="loads Blender")
    try:
        import bpy  # noqa: F401  # first, so that a missing system library is reported as such
    except ImportError as error:
        answer(error=missing_library(str(error)))
        return 1
    try:
        _work(job, more, answer)
    except UserError as error:
        answer(error=str(error))
        return 1
    return 0


def _work(job: Job, more: Iterator[Picture], answer: Callable[..., None]) -> None:
    """Build the scene and make what the job asks for, and ``more``."""
    import bpy

    from render.blender.scene.built_scene import build
    from render.blender.worker import device
    from render.blender.worker.picture import render, save_picture, signs_of_life
    from render.blender.worker.scene_file import save_scene
    from render.blender.worker.settings import drawing_settings, front_settings, picture_settings

    answer(doing="builds the scene")
    built = build(job)
    answer(device=device.choose(built.scene))
    if job.blend is not None:
        answer(doing="saves the scene")
        save_scene(built, Path(job.blend))
        answer(path=job.blend)
        return
    picture_settings(built.scene, job)
    if built.front is not None:
        front_settings(built.front, built.scene, job)
    if job.drawn:
        drawing_settings(built.scene, job)
    for picture in chain(job.pictures, more):
        built.show(picture.state)
        over = None
        with signs_of_life(lambda doing, name=picture.name: answer(doing=f"renders {name}: {doing}")):
            seconds = 0.0
            if built.front is not None and _is_drawn(job.states[picture.state]):
                over = Path(picture.folder) / f".{picture.key}.over.part.png"
                seconds += render(built.front)
                bpy.data.images["Render Result"].save_render(str(over), scene=built.front)
            seconds += render(built.scene)
        answer(doing=f"saves {picture.name}")
        answer(path=str(save_picture(built.scene, job, picture, over)), key=picture.key, cycles=seconds)
        if over is not None:
            over.unlink()


def _is_drawn(state: State) -> bool:
    """Whether any arrow is seen: one without a length takes as long as the picture, and changes nothing."""
    return any(tail != tip for tail, tip in state.arrows) or any(sweep for _, sweep in state.arcs)


if __name__ == "__main__":
    sys.exit(main())
