"""The worker inside Blender: reads jobs, draws pictures, saves scenes, and ends with its parent."""

from __future__ import annotations

import os
import queue
import signal
import sys
import threading
from collections.abc import Callable, Iterator
from itertools import chain
from pathlib import Path
from typing import TYPE_CHECKING, Any

import msgspec

from render.blender.job import Answer, Job, Picture
from render.blender.worker.picture import save_whole
from render.blender.worker.settings import picture_settings
from render.film.scene import State
from shared.stage.errors import UserError
from shared.stage.signals import end_with_parent

if TYPE_CHECKING:
    from render.blender.regions.plates import Plates

# System libraries that Blender needs, and the packages that have them.

APT = {
    "libGL": "libgl1",
    "libSM": "libsm6",
    "libICE": "libice6",
    "libX11": "libx11-6",
    "libXext": "libxext6",
    "libXi": "libxi6",
    "libXrender": "libxrender1",
    "libXfixes": "libxfixes3",
    "libxkbcommon": "libxkbcommon0",
    "libgomp": "libgomp1",
    "libEGL": "libegl1",
}
"""Debian's package for each library bpy may miss."""


def missing_library(message: str) -> str:
    """Return the remedy for an ImportError of bpy with that message."""
    library = message.split(":")[0]
    package = APT.get(library.split(".so")[0])
    cure = f"sudo apt-get install -y {package}" if package else "install the package that has it"
    return f"Blender needs the system library {library}: {cure}" if ".so" in library else f"bpy cannot start: {message}"


# The Blender process ends with the one that started it, however that ends.


def die_with_parent() -> Iterator[bytes]:
    """End when the parent ends, however it does: our standard input closes then, and Linux can tell as well.

    Returns the lines that come meanwhile; waiting for the next one ends with this process.
    """
    lines: queue.SimpleQueue[bytes] = queue.SimpleQueue()
    threading.Thread(target=_end_with_input, args=(lines,), daemon=True).start()
    return iter(lines.get, None)


def _end_with_input(lines: queue.SimpleQueue[bytes]) -> None:
    rest = b""
    while block := os.read(0, 65536):
        *whole, rest = (rest + block).split(b"\n")
        for line in whole:
            lines.put(line)
    os._exit(1)


# The scene as a .blend that plays, written whole.

# pyright: reportAttributeAccessIssue=false
# bpy fills itself in when it is imported, its stubs are empty.


ZSTD_SEEKABLE = b"\xb1\xea\x92\x8f"
"""The last bytes of a seekable file of Zstandard."""
BLEND = 20_000_000
"""Bytes that a saved scene may need."""


def save_scene(built: Any, path: Path) -> None:
    """Write ``built``, a :class:`render.blender.scene.built_scene.BuiltScene`, to ``path``; raises UserError."""
    import bpy

    from render.blender.scene.built_scene import bake_shapes

    bake_shapes(built)
    picture_settings(built.scene, built.job)
    if built.front is not None:  # in the saved scene the arrows are among the parts
        for thing in built.front.objects:
            if thing.type != "CAMERA":
                built.scene.collection.objects.link(thing)
    built.scene.frame_set(0)
    part = path.with_name(f".{path.stem}.part.blend")
    bpy.context.preferences.filepaths.save_version = 0
    save_whole(
        part,
        lambda path: bpy.ops.wm.save_as_mainfile(filepath=str(path), compress=True, copy=True),
        _blend_fault,
        most=BLEND,
        name=path.name,
    )
    os.replace(part, path)


def _blend_fault(path: Path) -> str | None:
    """Return the fault of a .blend that was cut short, or None; a whole one ends with a table of its pieces."""
    import bpy

    content = path.read_bytes() if path.exists() else b""
    if not content.endswith(ZSTD_SEEKABLE):
        return f"is cut short after {len(content)} bytes"
    try:
        with bpy.data.libraries.load(str(path)):
            return None
    except OSError as error:
        return f"cannot be read ({error})"


# The Blender process: ``python -m render.blender.worker.worker JOB.json``. Answers in JSON lines.
#
# It ends by itself when its standard input closes, so that it never outlives the process that started it.

# pyright: reportAttributeAccessIssue=false
# bpy fills itself in when it is imported, its stubs are empty.


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

    from render.blender.regions.plates import Plates
    from render.blender.scene.built_scene import build_scene as build
    from render.blender.worker import settings
    from render.blender.worker.picture import render, save_picture, signs_of_life
    from render.blender.worker.settings import drawing_settings, front_settings, picture_settings

    answer(doing="builds the scene")
    built = build(job)
    answer(device=settings.choose(built.scene))
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
    plates = Plates(built, render, lambda doing: answer(doing=doing)) if job.plates else None
    for picture in chain(job.pictures, more):
        built.show(picture.state)
        over, painted = None, None
        with signs_of_life(lambda doing, name=picture.name: answer(doing=f"renders {name}: {doing}")):
            seconds = 0.0
            if built.front is not None and _is_drawn(job.states[picture.state]):
                over = Path(picture.folder) / f".{picture.key}.over.part.png"
                seconds += render(built.front)
                bpy.data.images["Render Result"].save_render(str(over), scene=built.front)
            if plates is not None and picture.plate >= 0:
                painted = plates.painted(job.plates[picture.plate], picture.state)
                _tell_of_plates(plates, answer)
            if painted is None:
                built.show(picture.state)
                seconds += render(built.scene)
            else:
                seconds += painted.seconds
        answer(doing=f"saves {picture.name}")
        light = None if painted is None else painted.light
        answer(path=str(save_picture(built.scene, job, picture, over, light)), key=picture.key, cycles=seconds)
        if over is not None:
            over.unlink()


def _tell_of_plates(plates: Plates, answer: Callable[..., None]) -> None:
    """Tell how long plates took, and what was found, if any was made for the last picture."""
    if plates.seconds:
        answer(plates=plates.seconds)
    for note in plates.notes:
        answer(note=note)
    plates.seconds, plates.notes = 0.0, []


def _is_drawn(state: State) -> bool:
    """Return True if any arrow is seen: one without a length takes as long as the picture, and changes nothing."""
    return any(tail != tip for tail, tip in state.arrows) or any(sweep for _, sweep, _ in state.arcs)


if __name__ == "__main__":
    sys.exit(main())
