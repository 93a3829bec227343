"""Keys of frames: a hash of what a picture shows."""

from __future__ import annotations

import hashlib
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import msgspec

from render.film.framing import SENSOR, half_field, studio
from render.film.scene import Scene, State
from render.film.solids import MILLIMETRE
from render.presets import Preset
from shared.contract.parts import Z
from shared.stage.files import sources_hash

# The name of a picture is a hash of what it shows, so no picture is rendered twice and no wrong one is kept.

DIGITS = 9
"""Poses count to a nanometre and a nanoradian."""
BLENDER = Path(__file__).parents[1] / "blender"
LETTERS = Path(__file__).parents[1] / "letters.py"
"""The font of what Blender's side writes."""
HATCHES = Path(__file__).parents[1] / "film" / "section.py"
"""Stripes of its cut faces."""
BLENDER_SOURCES = ("job.py", "picture_file.py", "regions", "scene", "worker")
"""Sources that run in Blender; the other files of the room start it, and decide nothing that is seen."""


def scene_key(scene: Scene, preset: Preset, blender: str) -> str:
    """Return everything that all frames have in common; STL files count by content.

    ``blender`` is the version of bpy. Of other rooms, Blender's side takes the letters and these numbers.
    """
    plain = rounded(msgspec.to_builtins(scene))
    for piece in plain["pieces"]:
        del piece["stl"]
    shown = {key: part for key, part in plain.items() if key not in ("mechanism", "fps")}
    picture = [preset.width, preset.height, preset.samples, preset.motion_blur]
    turned, field = studio(scene.studio.up).tolist(), half_field(SENSOR, preset.aspect)
    return hash_of([shown, picture, _sources(), blender, SENSOR, MILLIMETRE, Z, turned, field])


def frame_key(scene: str, states: Sequence[State]) -> str:
    """Return one frame of the scene with that key: its state alone, or with both neighbours' where the shutter blurs
    them.
    """
    return hash_of([scene, [rounded(msgspec.to_builtins(state)) for state in states]])[:32]


def _sources() -> str:
    return sources_hash(*(BLENDER / name for name in BLENDER_SOURCES), LETTERS, HATCHES)


def rounded(value: Any) -> Any:
    """Return plain data with all floats rounded to :data:`DIGITS`."""
    if isinstance(value, float):
        return round(value, DIGITS) + 0.0  # -0.0 and 0.0 are one place
    if isinstance(value, dict):
        return {key: rounded(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [rounded(item) for item in value]
    return value


def hash_of(value: Any) -> str:
    """Return the SHA-256 of plain data, as hex."""
    return hashlib.sha256(msgspec.json.encode(value, order="sorted")).hexdigest()
