"""Blender as a plain script drives it: ``python -m benchmarks.film.plain JOB.json FOLDER`` prints seconds as JSON.

The scene is that of the film, light by light and piece by piece. All else is as Blender has it when a script says
nothing: its denoiser at its own quality, its bounces, its light tree, and nothing kept from one frame to the next.
"""

from __future__ import annotations

import json
import sys
import time
from pathlib import Path
from typing import Any

import msgspec


def main() -> None:
    """Render every picture of the job."""
    began = time.perf_counter()
    import bpy

    from render.blender.job import Job
    from render.blender.scene.built_scene import build_scene as build
    from render.blender.worker import settings

    job = msgspec.json.decode(Path(sys.argv[1]).read_bytes(), type=Job)
    built = build(job)
    settings.choose(built.scene)
    scene: Any = built.scene
    scene.render.resolution_x, scene.render.resolution_y, scene.render.resolution_percentage = (
        job.width,
        job.height,
        100,
    )
    scene.cycles.samples = job.samples
    each = []
    before = time.perf_counter() - began
    for number, picture in enumerate(job.pictures):
        begun = time.perf_counter()
        built.show(picture.state)
        scene.render.filepath = str(Path(sys.argv[2]) / f"{number:04d}.png")
        bpy.ops.render.render(write_still=True, scene=scene.name)
        each.append(time.perf_counter() - begun)
    print(json.dumps({"start": before, "each": each}))


if __name__ == "__main__":
    main()
