"""Mount of a mechanism's ground: on a desk, on a stand, at a wall or on the ground.

The parts stage decides it once and writes it into parts.json; film, page, GLB and prints read it there.
"""

from __future__ import annotations

import math
from typing import Literal

import msgspec

type Vector = tuple[float, float, float]
Kind = Literal["desk", "stand", "wall", "ground"]
Z: Vector = (0.0, 0.0, 1.0)
Y: Vector = (0.0, 1.0, 0.0)


class Mount(msgspec.Struct, forbid_unknown_fields=True, kw_only=True, frozen=True):
    """Holder of the ground, and the direction up in every picture.

    ``desk``: its base lies on a desk, and ``up`` is the normal of the plane, (0, 0, 1). For the others ``up`` is in the
    plane, against gravity. ``stand``: its base is a back plate on a foot. ``wall``: the back plate hangs at a wall.
    ``ground``: the road, terrain or floor of the model is the ground on which it stands.
    """

    kind: Kind = "desk"
    up: Vector = Z
    """Unit vector of the world."""


def mounted(gravity: tuple[float, float], kind: Kind | None = None, runs_on_ground: bool = False) -> Mount:
    """Return the mount for this ``gravity`` in the plane (m/s^2); ``kind`` is the author's choice.

    By default a machine without gravity in the plane lies on a desk, one that ``runs_on_ground`` stands on that, and
    any other on a stand. Without gravity y points up where an author has it stand.
    """
    pull = math.hypot(*gravity)
    if kind is None:
        kind = "desk" if pull == 0.0 else "ground" if runs_on_ground else "stand"
    if kind == "desk":
        return Mount()
    if pull == 0.0:
        return Mount(kind=kind, up=Y)
    x, y = (0.0 - component / pull for component in gravity)
    return Mount(kind=kind, up=(x, y, 0.0))
