"""One picture: rendered, with what lies over it, and saved whole."""

# pyright: reportAttributeAccessIssue=false
# bpy fills itself in when it is imported, its stubs are empty.
from __future__ import annotations

import os
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from render.blender.job import Job, Picture
from render.blender.picture_file import fault, name_of
from render.blender.worker.saved import save_whole
from render.blender.worker.settings import fineness


def render(scene: Any) -> float:
    """Render one picture; returns the seconds between Blender's own start and end."""
    import bpy

    span: dict[str, float] = {}
    on_start, on_end = bpy.app.handlers.render_pre, bpy.app.handlers.render_post

    def started(*_: Any) -> None:
        span["start"] = time.perf_counter()

    def ended(*_: Any) -> None:
        span["end"] = time.perf_counter()

    on_start.append(started)
    on_end.append(ended)
    try:
        bpy.ops.render.render(scene=scene.name)
    finally:
        on_start.remove(started)
        on_end.remove(ended)
    return span["end"] - span["start"]


@contextmanager
def signs_of_life(tell: Callable[[str], None]) -> Iterator[None]:
    """Tell what Cycles does meanwhile, at most once a second."""
    import bpy

    last = [""]
    when = [0.0]

    def stats(text: Any, *_: Any) -> None:
        doing = str(text).rpartition("Mem:")[2].partition("|")[2].strip()
        if doing != last[0] and time.monotonic() - when[0] >= 1.0:
            last[0], when[0] = doing, time.monotonic()
            tell(doing)

    bpy.app.handlers.render_stats.append(stats)
    try:
        yield
    finally:
        bpy.app.handlers.render_stats.remove(stats)


def save_picture(scene: Any, job: Job, picture: Picture, over: Path | None) -> Path:
    """The rendered picture as a checked PNG under the name that its key and its bytes give; returns its path.

    ``over`` is a picture with an alpha that is laid over it.
    """
    import bpy

    from render.blender.worker import overlay
    from render.blender.worker.plain_png import make_plain

    def save(path: Path) -> None:
        if job.drawn:
            _save_drawing(scene, job, path)
        else:
            bpy.data.images["Render Result"].save_render(str(path), scene=scene)
        if job.flat is None:
            overlay.lay(path, over, job.scene.writing, job.states[picture.state].number)
        make_plain(path)

    part = Path(picture.folder) / f".{picture.key}.part.png"
    save_whole(
        part,
        save,
        lambda path: fault(path, job.width, job.height),
        most=3 * job.width * job.height + 4096,
        name=picture.name,
    )
    path = part.with_name(name_of(picture.key, part.read_bytes()))
    os.replace(part, path)
    return path


def _save_drawing(scene: Any, job: Job, path: Path) -> None:
    """Lines on paper instead of the codes that were rendered, as a PNG."""
    import bpy
    import numpy as np
    from PIL import Image

    from render.blender.worker import drawing

    codes = path.with_suffix(".codes.exr")
    times = fineness(job)
    try:
        bpy.data.images["Render Result"].save_render(str(codes), scene=scene)
        values = drawing.read_codes(codes, times * job.width, times * job.height)
    finally:
        codes.unlink(missing_ok=True)
    look = job.scene.studio.look.drawing
    assert look is not None
    picture = drawing.drawn(values, look, job.width, job.height)
    page = Image.fromarray(np.rint(255 * np.clip(picture, 0, 1)).astype(np.uint8), "RGB")
    page.save(path, format="PNG", compress_level=4)
