"""The Blender process: ``python -m render.blender.worker JOB.json``. Answers in JSON lines.

It ends by itself when its standard input closes, so that it never outlives the process that started it.
"""

# pyright: reportAttributeAccessIssue=false
# bpy fills itself in when it is imported, its stubs are empty.
from __future__ import annotations

import ctypes
import os
import signal
import sys
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import msgspec

from render.blender.job import Answer, Job, Picture
from render.blender.saved import save_whole
from render.picture_file import fault, name_of
from shared.errors import UserError

PR_SET_PDEATHSIG = 1
"""Number of the request in Linux's <sys/prctl.h>."""
ZSTD_SEEKABLE = b"\xb1\xea\x92\x8f"
"""The last bytes of a seekable file of Zstandard."""
FRONT_SAMPLES = 24
"""A pixel of arrows."""
BLEND = 20_000_000
"""Bytes that a saved scene may need."""


def main() -> int:
    """Do the job named on the command line."""
    answers = os.fdopen(os.dup(1), "w", buffering=1)
    os.dup2(2, 1)  # Blender chats on stdout; the parent keeps stderr for the case of a failure

    def answer(**fields: Any) -> None:
        answers.write(msgspec.json.encode(Answer(**fields)).decode() + "\n")
        answers.flush()

    _die_with_parent()
    job = msgspec.json.decode(Path(sys.argv[1]).read_bytes(), type=Job)
    answer(doing="loads Blender")
    try:
        import bpy  # noqa: F401  # first, so that a missing system library is told as such
    except ImportError as error:
        answer(error=_missing_library(str(error)))
        return 1
    try:
        _work(job, answer)
    except UserError as error:
        answer(error=str(error))
        return 1
    return 0


def _work(job: Job, answer: Callable[..., None]) -> None:
    """Build the scene and make what the job asks for."""
    import bpy

    from render.blender import device, stage

    answer(doing="builds the scene")
    built = stage.build(job)
    answer(device=device.choose(built.scene))
    if job.blend is not None:
        answer(doing="saves the scene")
        _save(built, Path(job.blend))
        answer(path=job.blend)
        return
    _settings(built.scene, job)
    if built.front is not None:
        _front_settings(built.front, built.scene, job)
    for picture in job.pictures:
        built.show(picture.state)
        over = None
        with _signs_of_life(lambda doing, name=picture.name: answer(doing=f"renders {name}: {doing}")):
            seconds = 0.0
            if built.front is not None:
                over = Path(picture.folder) / f".{picture.key}.over.part.png"
                seconds += _render(built.front)
                bpy.data.images["Render Result"].save_render(str(over), scene=built.front)
            seconds += _render(built.scene)
        answer(doing=f"saves {picture.name}")
        answer(path=str(_save_picture(built.scene, job, picture, over)), key=picture.key, cycles=seconds)
        if over is not None:
            over.unlink()


def _settings(scene: Any, job: Job) -> None:
    """Size, samples, denoising: what facts on noise and time at few samples led to."""
    render, cycles = scene.render, scene.cycles
    render.resolution_x, render.resolution_y, render.resolution_percentage = job.width, job.height, 100
    render.image_settings.file_format = "PNG"
    render.image_settings.color_mode = "RGB"
    render.image_settings.color_depth = "8"
    render.image_settings.compression = 30
    render.dither_intensity = 0.0 if job.flat else 1.0  # without it the dark floor shows bands
    render.use_persistent_data = True
    render.use_motion_blur = job.motion_blur and job.flat is None
    render.motion_blur_shutter = 0.5
    cycles.samples = job.samples
    cycles.use_adaptive_sampling = False
    cycles.seed = 0
    cycles.use_light_tree = False  # a handful of lights: picking one by its power is a third faster
    cycles.max_bounces = 4
    cycles.diffuse_bounces, cycles.glossy_bounces = 1, 3
    cycles.transparent_max_bounces = 8
    cycles.caustics_reflective = cycles.caustics_refractive = False
    cycles.sample_clamp_indirect = 3.0
    cycles.blur_glossy = 1.0
    cycles.use_denoising = job.flat is None
    cycles.denoiser = "OPENIMAGEDENOISE"
    cycles.denoising_quality = "FAST"
    cycles.denoising_prefilter = "FAST"
    cycles.denoising_input_passes = "RGB_ALBEDO_NORMAL"


def _front_settings(front: Any, scene: Any, job: Job) -> None:
    """As those of the picture, with an alpha, and sharp edges from more samples: flat colours have no noise."""
    _settings(front, job)
    front.render.image_settings.color_mode = "RGBA"
    front.render.dither_intensity = 0.0
    front.cycles.device = scene.cycles.device
    front.cycles.samples = max(FRONT_SAMPLES, job.samples)
    front.cycles.use_denoising = False
    front.cycles.max_bounces = 0


def _render(scene: Any) -> float:
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
def _signs_of_life(tell: Callable[[str], None]) -> Iterator[None]:
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


def _save_picture(scene: Any, job: Job, picture: Picture, over: Path | None) -> Path:
    """The rendered picture as a checked PNG under the name that its key and its bytes give; returns its path.

    ``over`` is a picture with an alpha that is laid over it.
    """
    import bpy

    from render.blender import overlay

    def save(path: Path) -> None:
        bpy.data.images["Render Result"].save_render(str(path), scene=scene)
        if job.flat is None:
            overlay.lay(path, over, job.scene.writing, job.states[picture.state].number)

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


def _save(built: Any, path: Path) -> None:
    """The scene as a .blend that plays, written whole."""
    import bpy

    from render.blender import stage

    stage.bake_shapes(built)
    _settings(built.scene, built.job)
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
    """Whether a .blend was cut short: it ends with the table of its compressed pieces, and Blender can read it."""
    import bpy

    content = path.read_bytes() if path.exists() else b""
    if not content.endswith(ZSTD_SEEKABLE):
        return f"is cut short after {len(content)} bytes"
    try:
        with bpy.data.libraries.load(str(path)):
            return None
    except OSError as error:
        return f"cannot be read ({error})"


def _missing_library(message: str) -> str:
    library = message.split(":")[0]
    package = APT.get(library.split(".so")[0])
    cure = f"sudo apt-get install -y {package}" if package else "install the package that has it"
    return f"Blender needs the system library {library}: {cure}" if ".so" in library else f"bpy cannot start: {message}"


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


def _die_with_parent() -> None:
    """End when the parent ends, however it does: our standard input closes then, and Linux can tell as well."""
    threading.Thread(target=_end_with_input, daemon=True).start()
    if sys.platform == "linux":
        ctypes.CDLL(None).prctl(PR_SET_PDEATHSIG, signal.SIGKILL)


def _end_with_input() -> None:
    while os.read(0, 4096):
        pass
    os._exit(1)


if __name__ == "__main__":
    sys.exit(main())
