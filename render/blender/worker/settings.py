"""Settings of Cycles: device, samples, colours."""

from __future__ import annotations

import os
from typing import Any

from render.blender.job import Job

# The device Cycles renders on: a GPU where one is found, else the CPU. The choice is always reported.

# pyright: reportAttributeAccessIssue=false
# bpy fills itself in when it is imported, its stubs are empty.


BACKENDS = ("OPTIX", "CUDA", "HIP", "METAL", "ONEAPI")


def choose(scene: Any) -> str:
    """Set the device for ``scene`` and name it, for example ``CPU (2 threads)`` or ``OPTIX: GeForce RTX 4070``."""
    import bpy

    # Without a window the add-on's preferences start empty: no backend, no devices.
    preferences = bpy.context.preferences.addons["cycles"].preferences
    for backend in BACKENDS:
        try:
            preferences.compute_device_type = backend
            preferences.refresh_devices()
        except (TypeError, ValueError, RuntimeError):
            continue  # this build of Cycles does not know the backend
        gpus = [device for device in preferences.devices if device.type == backend]
        if gpus:
            for device in preferences.devices:
                device.use = device.type == backend
            scene.cycles.device = "GPU"
            scene.cycles.denoising_use_gpu = True
            return f"{backend}: {', '.join(sorted({device.name for device in gpus}))}"
    preferences.compute_device_type = "NONE"
    scene.cycles.device = "CPU"
    return f"CPU ({os.process_cpu_count()} threads, Cycles found no GPU)"


# Size, samples and denoising of a picture, and of the arrows that are laid over it.

FRONT_SAMPLES = 24
"""A pixel of arrows."""

LARGE = 2000
"""Pixels of a picture's width above which each has one code."""


def picture_settings(scene: Any, job: Job) -> None:
    """Set size, samples and denoising; denoiser and bounces are chosen for little noise in little time."""
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
    cycles.filter_width = 1.0  # engraving is a pixel wide: Blender's 1.5 spreads it over its neighbours
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
    cycles.denoising_quality = "HIGH"
    cycles.denoising_prefilter = "FAST"
    cycles.denoising_input_passes = "RGB_ALBEDO_NORMAL"


def drawing_settings(scene: Any, job: Job) -> None:
    """Set a code for each pixel, and for its quarters if the picture is not too large: one sample in its middle."""
    render, cycles = scene.render, scene.cycles
    render.resolution_percentage = 100 * fineness(job)
    render.film_transparent = True
    render.image_settings.file_format = "OPEN_EXR"
    render.image_settings.color_depth = "32"
    render.use_motion_blur = False
    render.dither_intensity = 0.0
    cycles.samples = 1
    cycles.pixel_filter_type, cycles.filter_width = "BOX", 0.01
    cycles.use_denoising = False
    cycles.max_bounces = 0


def fineness(job: Job) -> int:
    """Return codes along the side of a drawing's pixel."""
    return 2 if job.width <= LARGE else 1


def front_settings(front: Any, scene: Any, job: Job) -> None:
    """Set what the picture has, with an alpha, and sharp edges from more samples: flat colours have no noise."""
    picture_settings(front, job)
    front.render.image_settings.color_mode = "RGBA"
    front.render.dither_intensity = 0.0
    front.cycles.device = scene.cycles.device
    front.cycles.samples = max(FRONT_SAMPLES, job.samples)
    front.cycles.use_denoising = False
    front.cycles.max_bounces = 0
