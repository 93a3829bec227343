"""What a prim does: translate, rotateZ and scale at time codes."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

from pxr import Gf, UsdGeom

from render.glb.animation import Track

ADD = {"translation": "AddTranslateOp", "angle": "AddRotateZOp", "scale": "AddScaleOp"}
"""In the order of the prim's list: the last acts first."""


def place(thing: UsdGeom.Xformable, path: str, still: Any) -> None:
    """Put a prim where it stays; ``path`` is that of a track."""
    _op(thing, path).Set(Gf.Vec3d(*still))


def move(thing: UsdGeom.Xformable, track: Track, codes: Sequence[float]) -> None:
    """Give a prim the values of a track at codes (T,), and its first where there is no time."""
    op, values = _op(thing, track.path), _plain(track)
    op.Set(values[0])
    for code, value in zip(codes, values, strict=True):
        op.Set(value, code)


def _op(thing: UsdGeom.Xformable, path: str) -> UsdGeom.XformOp:
    return getattr(thing, ADD[path])(UsdGeom.XformOp.PrecisionDouble)


def _plain(track: Track) -> list[Any]:
    """Values as USD takes them."""
    if track.path == "angle":
        return [math.degrees(angle) for angle in track.values]
    return [Gf.Vec3d(*value) for value in track.values.tolist()]
