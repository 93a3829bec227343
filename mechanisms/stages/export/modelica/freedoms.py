"""Which coordinates a model starts from: as many as it has freedoms, and independent of each other.

J     rows of its joints and drivers by the bodies' coordinates, at the start, by differences; N: J N = 0
C     the same of coordinates of joints; rows of C N that are independent, by QR with pivots
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mechanisms.stages.export.modelica.start import Start, along, angle, place
from mechanisms.stages.export.tree import GROUND

Array = NDArray[np.float64]
Poses = Mapping[str, Array]
Key = tuple[str, str]
"""Name of a joint or body, and of its variable: phi, s; x, y, theta."""
ZERO = 1e-7
"""Singular values below this part of the largest are none."""
STEP = 1e-6


def rows(joint: Any, poses: Poses, size: float) -> list[float]:
    """What a joint or driver holds, free of dimension."""
    turn, (x, y) = angle(poses, joint), along(poses, joint) / size
    match joint.kind.name:
        case "revolute":
            return [x, y]
        case "prismatic":
            return [y, turn]
        case "weld":
            return [x, y, turn]
        case "pin_in_slot":
            return [y]
        case "distance" | "drive_distance":
            return [math.hypot(x, y)]
        case "drive_coordinate":
            return [x]
        case "angle_lock" | "drive_angle" | "drive_relative_angle":
            return [turn]
        case "rack_and_pinion":
            return [x + joint.kind.numbers(joint.params)[0][2] / size * turn]
        case "gear_pair" | "belt":
            [(a, b)] = joint.kind.numbers(joint.params)
            dx, dy = place(poses, joint.j) - place(poses, joint.i)
            first, second = (poses[marker.body.name][2] for marker in (joint.i, joint.j))
            return [(a * first + b * second - (a + b) * math.atan2(dy, dx)) / size]
    raise ValueError(joint.kind.name)


@dataclass(frozen=True)
class Function:
    """Something that depends on the poses of some bodies alone."""

    bodies: tuple[str, ...]
    value: Callable[[Poses], Sequence[float]]


def coordinates(joints: Sequence[Any], loose: Sequence[str], size: float) -> dict[Key, Function]:
    """Coordinates of joints, and of bodies that no joint with a coordinate holds; free of dimension."""
    out: dict[Key, Function] = {}
    for joint in joints:
        if joint.kind.name in ("revolute", "pin_in_slot"):
            out[joint.name, "phi"] = Function(joint.bodies, lambda poses, joint=joint: [angle(poses, joint)])
        if joint.kind.name in ("prismatic", "pin_in_slot"):
            out[joint.name, "s"] = Function(joint.bodies, lambda poses, joint=joint: [along(poses, joint)[0] / size])
    for body in loose:
        for k, (axis, scale) in enumerate((("x", size), ("y", size), ("theta", 1.0))):
            out[body, axis] = Function((body,), lambda poses, body=body, k=k, scale=scale: [poses[body][k] / scale])
    return out


def chosen(start: Start, held: Sequence[Any], loose: Sequence[str], size: float) -> set[Key]:
    """The coordinates to start from, of a model that these joints and drivers hold."""
    wanted = coordinates(held, loose, size)
    joints = [Function(joint.bodies, lambda poses, joint=joint: rows(joint, poses, size)) for joint in held]
    free = _null(_jacobian(start, joints, size))
    if not free.shape[1] or not wanted:
        return set()
    moved = _jacobian(start, list(wanted.values()), size) @ free
    return {list(wanted)[k] for k in _independent(moved)}


def _jacobian(start: Start, functions: Sequence[Function], size: float) -> Array:
    """(m, 3 bodies): all values by the bodies' coordinates, by differences."""
    names = [name for name in start.poses if name != GROUND]
    columns = {name: 3 * k for k, name in enumerate(names)}
    blocks: list[Array] = [np.zeros((0, 3 * len(names)))]
    for function in functions:
        block = np.zeros((len(function.value(start.poses)), 3 * len(names)))
        for name in set(function.bodies) - {GROUND}:
            for k, scale in enumerate((size, size, 1.0)):
                step = np.eye(3)[k] * STEP * scale
                ahead, back = (function.value({**start.poses, name: start.poses[name] + s * step}) for s in (1, -1))
                block[:, columns[name] + k] = (np.array(ahead) - np.array(back)) / (2 * STEP)
        blocks.append(block)
    return np.concatenate(blocks)


def _null(matrix: Array) -> Array:
    """(n, k) all that a matrix (m, n) takes to zero."""
    if not len(matrix):
        return np.eye(matrix.shape[1])
    _, values, rows = np.linalg.svd(matrix)
    return rows[int((values > ZERO * max(1.0, values.max(initial=0.0))).sum()) :].T


def _independent(matrix: Array) -> list[int]:
    """Numbers of rows that are independent, as many as there are."""
    from scipy.linalg import qr

    r, pivots = qr(matrix.T, mode="r", pivoting=True)  # pyright: ignore[reportAssignmentType]
    sizes = np.abs(np.diag(r))
    return [int(k) for k in pivots[: int((sizes > ZERO * max(1.0, sizes.max(initial=0.0))).sum())]]
