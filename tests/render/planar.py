"""Poses of pictures in the plane."""

from __future__ import annotations

import math

from render.film.scene import Pose


def in_plane(pose: Pose) -> tuple[float, float, float]:
    """Return x, y (m) and the angle (rad, within a turn) of a body in the plane."""
    x, y, _, w, _, _, z = pose
    return x, y, 2 * math.atan2(z, w)
