"""Reactions of joints from multipliers, and how well a motion fulfils its equations."""

from __future__ import annotations

import numpy as np

from mbsd.arrays.packing import Packed
from mbsd.equations.products import tabulate_wrenches, times_columns, times_rows


def rows_of_joints(packed: Packed, joints: np.ndarray) -> np.ndarray:
    """Return rows of J of some joints (k,), one joint after the other."""
    first, end = packed.first_row[joints], packed.first_row[joints + 1]
    return np.concatenate([np.zeros(0, np.int64), *map(np.arange, first, end)])


def wrenches(
    packed: Packed, compact: np.ndarray, q: np.ndarray, lam: np.ndarray, joints: np.ndarray | None = None
) -> np.ndarray:
    """Return (T, joints, 3) forces -J_b^T lam on each joint's second body b, at the second marker.

    compact (T, m, 6), q (T, 3 nb), lam (T, m); N and N m. Ground as second body takes the opposite of what the first
    body gets. With ``joints`` (k,) (T, k, 3) of these, whose rows compact and lam hold (:func:`rows_of_joints`).
    """
    system, bodies = packed.system, len(packed.body_names)
    if joints is None:
        joints, place, theta = np.arange(len(packed.joints)), np.arange(-1, bodies - 1), q[:, 5::3]
    else:
        carriers = np.unique(system.marker_body[packed.markers[joints, 1]])
        place, theta = np.zeros(bodies, np.int64), q[:, 3 * carriers + 2]
        place[carriers] = np.arange(len(carriers))
    turn = np.empty((2, *theta.shape))  # by numpy, whose cosine is not that of kernels in the last digit
    np.cos(theta, out=turn[0])
    np.sin(theta, out=turn[1])
    out = np.empty((len(q), len(joints), 3))
    tabulate_wrenches(
        joints, packed.first_row, packed.markers, system.marker_body, system.marker_arm, place, turn,
        _whole(compact), _whole(q), _whole(lam), out,
    )  # fmt: skip
    return out


def _whole(array: np.ndarray) -> np.ndarray:
    """Return an array as kernels take it."""
    return np.ascontiguousarray(array, float)


def marker_places(packed: Packed, q: np.ndarray, marker: int) -> np.ndarray:
    """Return (T, 2) world places of a marker (m) at poses q (T, 3 nb)."""
    body = packed.system.marker_body[marker]
    x, y = packed.system.marker_arm[marker]
    c, s = np.cos(q[:, 3 * body + 2]), np.sin(q[:, 3 * body + 2])
    return q[:, 3 * body : 3 * body + 2] + np.stack([c * x - s * y, s * x + c * y], axis=1)


def marker_axes(packed: Packed, q: np.ndarray, marker: int, turned: bool = False) -> np.ndarray:
    """Return (T, 2) unit x axes of a marker, y axes if ``turned``, in the world at poses q (T, 3 nb)."""
    x, y = packed.system.marker_axis[marker]
    if turned:
        x, y = -y, x
    angle = q[:, 3 * packed.system.marker_body[marker] + 2]
    c, s = np.cos(angle), np.sin(angle)
    return np.stack([c * x - s * y, s * x + c * y], axis=1)


def relative_velocity(packed: Packed, q: np.ndarray, v: np.ndarray, i: int | None, j: int) -> np.ndarray:
    """Return (T, 2) velocity of marker j as seen by marker i's body (m/s, world axes).

    With None as i it is seen by ground.
    """
    place = marker_places(packed, q, j)
    out = _velocity(q, v, packed.system.marker_body[j], place)
    return out if i is None else out - _velocity(q, v, packed.system.marker_body[i], place)


def _velocity(q: np.ndarray, v: np.ndarray, body: int, place: np.ndarray) -> np.ndarray:
    """Return (T, 2) of what of a body is at a world place (T, 2)."""
    arm = place - q[:, 3 * body : 3 * body + 2]
    return v[:, 3 * body : 3 * body + 2] + v[:, 3 * body + 2, None] * np.stack([-arm[:, 1], arm[:, 0]], axis=1)


def times_compact(packed: Packed, compact: np.ndarray, x: np.ndarray) -> np.ndarray:
    """Return (T, m) J x for compact J (T, m, 6) and x (T, 3 nb), whose entries of ground are zero."""
    rows, out = packed.system.row_body, np.empty(compact.shape[:2])
    times_rows(rows, not rows[:, 0].any(), _whole(compact), _whole(x), out)
    return out


def generalised(packed: Packed, compact: np.ndarray, lam: np.ndarray) -> np.ndarray:
    """Return (T, 3 nb) J^T lam, with what ground takes, for compact J (T, m, 6) and lam (T, m)."""
    out = np.zeros((len(lam), 3 * len(packed.body_names)))
    times_columns(packed.system.row_body, _whole(compact), _whole(lam), out)
    return out
