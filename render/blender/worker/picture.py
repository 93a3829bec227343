"""One picture in Blender: the scene at a moment, drawn, saved and marked."""

from __future__ import annotations

import os
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any

import numpy as np

from render.blender.job import Job, Picture
from render.blender.picture_file import fault, name_of
from render.blender.scene.materials import INKED
from render.blender.worker.settings import fineness
from render.looks import Drawing
from shared.stage.errors import UserError
from shared.stage.files import refusal

# Files that Blender saves are checked before they get their name, since Blender does not report a full disk.

ATTEMPTS = 2


def save_whole(
    part: Path, save: Callable[[Path], object], fault: Callable[[Path], str | None], most: int, name: str
) -> None:
    """Have ``save`` write the file ``part`` and check it by ``fault``, which words what is wrong with it.

    ``most`` is the number of bytes that it may need, ``name`` what messages call it. On an error ``part`` is removed.
    Raises UserError with the reason that the system gives for a file of that size.
    """
    try:
        wrong = None
        for _ in range(ATTEMPTS):
            try:
                save(part)
                wrong = fault(part)
            except RuntimeError as error:  # Blender notices a full disk now and then, without the name of the file
                wrong = f"was not written ({str(error).strip()})"
            if wrong is None:
                with part.open("rb") as written:
                    os.fsync(written.fileno())
                return
            _try_to_write(part, most)
        raise UserError(
            f"{name}: the file that Blender saved {wrong}, though the disk has room; run the same command again"
        )
    except BaseException as error:
        with suppress(OSError):
            part.unlink(missing_ok=True)
        if isinstance(error, OSError):
            raise UserError(f"{name}: {refusal(part, error)}. It may need {most / 1e6:.1f} MB") from error
        raise


def _try_to_write(part: Path, size: int) -> None:
    """Raises the OSError that Blender kept to itself, if there still is one."""
    with part.open("wb") as file:
        file.write(bytes(size))
        file.flush()
        os.fsync(file.fileno())


# A drawing made of codes (``scene/materials.py``): outlines, edges and a wash of light on squared paper.

Array = np.ndarray
OUTLINE, EDGE, BORDER = 1.9, 0.9, 1.2
"""Widths in pixels of a picture 1280 wide: around solids, of their edges, of the frame."""
TURN = 0.93
"""Cosine of the angle between two normals below which there is an edge between them."""
STEP = 0.004
"""Change of the distance's slope (radii a pixel of 1280) at which one face hides another."""
SQUARES, FINE = 32, 4
"""Squares of the paper along its width, and the finer ones in each."""
LIGHT = np.array([-0.45, 0.62, 0.64])
"""Where the wash is brightest: right, up, towards the eye."""


def drawn(codes: Array, drawing: Drawing, width: int, height: int) -> Array:
    """Return the picture (height, width, 3) of 0..1 from codes (k height, k width, 3) for a whole k."""
    times = codes.shape[1] // width
    pixel = times * width / 1280
    number, normal, away, ink = _decoded(codes)
    outline, edge = _lines(number, normal, away, STEP / pixel)
    lines = np.maximum(_thick(outline, OUTLINE * pixel), 0.75 * _thick(edge, EDGE * pixel))
    lines = np.maximum(lines, ink)
    wash = np.where(number > 0, drawing.tone * (0.25 + 0.75 * np.clip(normal @ LIGHT, 0, 1)), 0.0)
    wash, lines, there = (_smaller(part, times) for part in (wash, lines, (number > 0).astype(np.float32)))
    paper = _paper(drawing, width, height)
    bare = np.array(drawing.paper) + (1 - np.array(drawing.paper)) * wash[..., None]
    picture = paper * (1 - there[..., None]) + bare * there[..., None]
    return picture + (np.array(drawing.line) - picture) * lines[..., None]


def read_values(path: Path, width: int, height: int) -> Array:
    """Return the values (height, width, 3) of a picture as they are in its file, the upper row first."""
    import bpy

    image: Any = bpy.data.images.load(str(path))
    image.colorspace_settings.name = "Non-Color"
    values = np.empty(width * height * 4, np.float32)
    image.pixels.foreach_get(values)
    bpy.data.images.remove(image)
    return values.reshape(height, width, 4)[::-1, :, :3]


def _decoded(codes: Array) -> tuple[Array, Array, Array, Array]:
    """Return the number of the solid (0 is paper), its normal, its distance, and how strongly a pixel is inked."""
    number = np.floor(codes[..., 0]).astype(np.int32)
    inked = number >= INKED
    x = 4 * (codes[..., 0] - number) - 1
    y = 2 * codes[..., 1] - 1
    normal = np.stack([x, y, np.sqrt(np.clip(1 - x * x - y * y, 0, 1))], axis=-1)
    normal[number == 0] = 0
    ink = np.where(inked, np.sqrt(np.clip(codes[..., 1], 0, 1)), 0).astype(np.float32)
    return np.where(inked, 0, number), normal, codes[..., 2], ink


def _lines(number: Array, normal: Array, away: Array, step: float) -> tuple[Array, Array]:
    """Return where outlines and edges run: pixels whose right or lower neighbour is of another solid, or of another
    face.
    """
    outline, edge = np.zeros(number.shape, bool), np.zeros(number.shape, bool)
    for axis in (0, 1):
        here = (slice(None, -1), slice(None)) if axis == 0 else (slice(None), slice(None, -1))
        there = (slice(1, None), slice(None)) if axis == 0 else (slice(None), slice(1, None))
        outline[here] |= number[here] != number[there]
        same = (number[here] == number[there]) & (number[here] > 0)
        turned = np.einsum("ijk,ijk->ij", normal[here], normal[there]) < TURN
        edge[here] |= same & turned
        bent = np.zeros(number.shape, bool)
        middle = (slice(1, -1), slice(None)) if axis == 0 else (slice(None), slice(1, -1))
        bent[middle] = np.abs(np.diff(away, 2, axis=axis)) > step
        edge[here] |= same & bent[here] & bent[there]
    return outline, edge


def _thick(line: Array, width: float) -> Array:
    """Return a line one pixel wide made ``width`` wide, with soft sides."""
    reach = int(np.ceil(width / 2))
    out = np.zeros(line.shape, np.float32)
    padded = np.pad(line.astype(np.float32), reach)
    for down in range(-reach, reach + 1):
        for right in range(-reach, reach + 1):
            weight = np.clip(width / 2 + 0.5 - np.hypot(down, right), 0, 1)
            if weight:
                rows = slice(reach + down, reach + down + line.shape[0])
                columns = slice(reach + right, reach + right + line.shape[1])
                np.maximum(out, weight * padded[rows, columns], out=out)
    return out


def _smaller(values: Array, times: int) -> Array:
    """Return means over squares of ``times`` pixels."""
    rows, columns = (n // times for n in values.shape)
    return values.reshape(rows, times, columns, times).mean(axis=(1, 3))


def _paper(drawing: Drawing, width: int, height: int) -> Array:
    """Return squared paper (height, width, 3) with a frame."""
    paper, grid = np.array(drawing.paper), np.array(drawing.grid)
    pixel = width / 1280
    square = width / SQUARES
    x, y = np.arange(width) + 0.5 - width / 2, np.arange(height) + 0.5 - height / 2
    strength = np.zeros((height, width))
    for size, part in ((square / FINE, 0.16), (square, 0.5)):
        across, down = (np.clip(1.1 * pixel - np.abs((v + size / 2) % size - size / 2), 0, 1) for v in (x, y))
        strength = np.maximum(strength, part * np.maximum(across[None, :], down[:, None]))
    shade = 1.06 - 0.22 * (x[None, :] ** 2 / (width / 2) ** 2 + y[:, None] ** 2 / (height / 2) ** 2) / 2
    picture = (paper + (grid - paper) * strength[..., None]) * shade[..., None]
    inset = 0.011 * width
    off = np.minimum(width / 2 - inset - np.abs(x)[None, :], height / 2 - inset - np.abs(y)[:, None])
    frame = np.clip(BORDER * pixel / 2 + 0.5 - np.abs(off), 0, 1)
    return picture + (np.array(drawing.line) - picture) * 0.6 * frame[..., None]


# One picture: rendered, with what lies over it, and saved whole.

# pyright: reportAttributeAccessIssue=false
# bpy fills itself in when it is imported, its stubs are empty.


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


def save_picture(scene: Any, job: Job, picture: Picture, over: Path | None, light: Array | None = None) -> Path:
    """Save the rendered picture as a checked PNG under the name that its key and its bytes give; return its path.

    ``over`` is a picture with an alpha that is laid over it. ``light`` (H, W, 3), linear, is shown instead of what was
    rendered last.
    """
    import bpy

    from render.blender.picture_file import make_plain
    from render.blender.worker import words

    def save(path: Path) -> None:
        if job.drawn:
            _save_drawing(scene, job, path)
        elif light is not None:
            _save_light(scene, light, path)
        else:
            bpy.data.images["Render Result"].save_render(str(path), scene=scene)
        if job.flat is None:
            words.lay(path, over, job.scene.writing, job.states[picture.state].number)
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


GRAIN = 0
"""Seed of the noise that hides the steps between 256 values: the same in every frame."""


def _save_light(scene: Any, light: Array, path: Path) -> None:
    """Save linear light as the scene's view shows it, rounded to 8 bits with a noise of one step."""
    import bpy
    from PIL import Image

    height, width, _ = light.shape
    pixels = np.ones((height, width, 4), np.float32)
    pixels[..., :3] = light[::-1]
    image: Any = bpy.data.images.new("frame", width, height, float_buffer=True)
    images = scene.render.image_settings
    fine = path.with_suffix(".fine.png")
    try:
        image.pixels.foreach_set(pixels.ravel())
        images.color_depth = "16"
        image.save_render(str(fine), scene=scene)
        shown = read_values(fine, width, height)
    finally:
        images.color_depth = "8"
        bpy.data.images.remove(image)
        fine.unlink(missing_ok=True)
    grain = np.random.default_rng(GRAIN).random(shown.shape, np.float32)
    page = Image.fromarray(np.clip(np.floor(255 * shown + grain), 0, 255).astype(np.uint8), "RGB")
    page.save(path, format="PNG", compress_level=4)


def _save_drawing(scene: Any, job: Job, path: Path) -> None:
    """Save lines on paper instead of the codes that were rendered, as a PNG."""
    import bpy
    import numpy as np
    from PIL import Image

    codes = path.with_suffix(".codes.exr")
    times = fineness(job)
    try:
        bpy.data.images["Render Result"].save_render(str(codes), scene=scene)
        values = read_values(codes, times * job.width, times * job.height)
    finally:
        codes.unlink(missing_ok=True)
    look = job.scene.studio.look.drawing
    assert look is not None
    picture = drawn(values, look, job.width, job.height)
    page = Image.fromarray(np.rint(255 * np.clip(picture, 0, 1)).astype(np.uint8), "RGB")
    page.save(path, format="PNG", compress_level=4)
