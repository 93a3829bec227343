"""The scene as a .blend that plays, written whole."""

# pyright: reportAttributeAccessIssue=false
# bpy fills itself in when it is imported, its stubs are empty.
from __future__ import annotations

import os
from pathlib import Path
from typing import Any

from render.blender.worker.saved import save_whole
from render.blender.worker.settings import picture_settings

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
