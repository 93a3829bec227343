"""The device Cycles renders on: a GPU where one is found, else the CPU. The choice is always reported."""

# pyright: reportAttributeAccessIssue=false
# bpy fills itself in when it is imported, its stubs are empty.
from __future__ import annotations

import os
from typing import Any

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
