"""The Blender process: ``python -m render.blender.worker JOB.json``. Answers one JSON line per picture.

It ends by itself when its standard input closes, so that it never outlives the process that started it.
"""

# pyright: reportAttributeAccessIssue=false
# bpy fills itself in when it is imported, its stubs are empty.
from __future__ import annotations

import os
import sys
import threading
import time
from pathlib import Path
from typing import Any

import msgspec

from render.blender.job import Answer, Job


def main() -> int:
    """Do the job named on the command line."""
    answers = os.fdopen(os.dup(1), "w", buffering=1)
    os.dup2(2, 1)  # Blender chats on stdout; the parent keeps stderr for the case of a failure

    def answer(**fields: Any) -> None:
        answers.write(msgspec.json.encode(Answer(**fields)).decode() + "\n")
        answers.flush()

    threading.Thread(target=_end_with_parent, daemon=True).start()
    job = msgspec.json.decode(Path(sys.argv[1]).read_bytes(), type=Job)
    try:
        import bpy  # noqa: F401  # first, so that a missing system library is told as such
    except ImportError as error:
        answer(error=_missing_library(str(error)))
        return 1
    from render.blender import device, stage

    built = stage.build(job)
    answer(device=device.choose(built.scene))
    if job.blend is not None:
        _save(built, Path(job.blend))
        answer(path=job.blend)
        return 0
    _settings(built.scene, job)
    for picture in job.pictures:
        built.show(picture.state)
        seconds = _render(built.scene, Path(picture.path))
        answer(path=picture.path, cycles=seconds)
    return 0


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


def _render(scene: Any, path: Path) -> float:
    """Render to a file beside ``path``, then rename; returns the seconds between Blender's own start and end."""
    import bpy

    span: dict[str, float] = {}
    on_start, on_end = bpy.app.handlers.render_pre, bpy.app.handlers.render_post

    def started(*_: Any) -> None:
        span["start"] = time.perf_counter()

    def ended(*_: Any) -> None:
        span["end"] = time.perf_counter()

    on_start.append(started)
    on_end.append(ended)
    part = path.with_name(f".{path.stem}.part.png")
    try:
        bpy.ops.render.render()
        bpy.data.images["Render Result"].save_render(str(part), scene=scene)
        with part.open("rb") as written:
            os.fsync(written.fileno())
        os.replace(part, path)
    finally:
        on_start.remove(started)
        on_end.remove(ended)
        part.unlink(missing_ok=True)
    return span["end"] - span["start"]


def _save(built: Any, path: Path) -> None:
    """The scene as a .blend that plays, written whole."""
    import bpy

    from render.blender import stage

    stage.bake_trails(built)
    _settings(built.scene, built.job)
    built.scene.frame_set(0)
    part = path.with_name(f".{path.stem}.part.blend")
    bpy.context.preferences.filepaths.save_version = 0
    bpy.ops.wm.save_as_mainfile(filepath=str(part), compress=True, copy=True)
    os.replace(part, path)


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


def _end_with_parent() -> None:
    while os.read(0, 4096):
        pass
    os._exit(1)


if __name__ == "__main__":
    sys.exit(main())
