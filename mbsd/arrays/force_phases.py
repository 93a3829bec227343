"""Phases of gears with play: the constant of their equation, decided by the closed start pose.

It belongs to the packed mechanism, as the phases of gears without play do (mbsd/kinematics/pose/phases.py).
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from mbsd.arrays.packing import Packed
from mbsd.arrays.reactions import marker_axes, marker_places
from mbsd.model.force import Force


def take_force_phases(packed: Packed, q: np.ndarray) -> None:
    """Take the constants of all meshes from the start pose q (3 nb,)."""
    for force in packed.forces:
        if force.kind.mesh is not None:
            line, first, second = world_angles(packed, force, q)
            phase = force.params["phase"]
            if phase is not None:
                first, second = phase[0] + force.i.angle, phase[1] + force.j.angle
            packed.phases[force.name] = force.kind.mesh.rolled(force, line, first, second)


def world_angles(packed: Packed, force: Force, q: np.ndarray) -> tuple[float, float, float]:
    """Angles (rad) of the line from marker i to j, and of both markers, in the pose q (3 nb,)."""
    i, j = packed.markers_of(force)
    bi, bj = (int(packed.system.marker_body[marker]) for marker in (i, j))
    away = marker_places(packed, q[None], j)[0] - marker_places(packed, q[None], i)[0]
    line = math.atan2(away[1], away[0])
    return line, float(q[3 * bi + 2]) + force.i.angle, float(q[3 * bj + 2]) + force.j.angle


def relative_poses(packed: Packed, force: Force, q: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """(T,) place x, y (m) and angle (rad) of marker j in the axes of marker i along poses q (T, 3 nb)."""
    i, j = packed.markers_of(force)
    bi, bj = (int(packed.system.marker_body[marker]) for marker in (i, j))
    away = marker_places(packed, q, j) - marker_places(packed, q, i)
    x, y = ((marker_axes(packed, q, i, turned) * away).sum(axis=1) for turned in (False, True))
    return x, y, q[:, 3 * bj + 2] + force.j.angle - q[:, 3 * bi + 2] - force.i.angle


def placed_params(packed: Packed, force: Force, q: np.ndarray) -> dict[str, Any]:
    """Params with which a force that takes the place of a joint starts as it stands in the pose q (3 nb,)."""
    out = {**force.params, "start": None}
    if force.kind.mesh is None:
        return out
    line, first, second = world_angles(packed, force, q)
    rolled = force.kind.mesh.rolled
    now, ahead = rolled(force, line, first, second), rolled(force, line, first, second + 1.0)
    own = force.kind.interactions(force, packed.masses)[0].numbers[0]
    middle = packed.phases.get(force.name, now) + own - now
    return {**out, "phase": (first - force.i.angle, second - force.j.angle + middle / (ahead - now))}
