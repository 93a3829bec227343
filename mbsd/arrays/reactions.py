"""Reactions of joints from multipliers, and how well a motion fulfils its equations."""

from __future__ import annotations

import numpy as np

from mbsd.arrays.packing import Packed

MANY_ROWS = 200
"""From here on rows are added all at once, which is slower for few."""


def rows_of_joints(packed: Packed, joints: np.ndarray) -> np.ndarray:
    """Rows of J of some joints (k,), one joint after the other."""
    first, end = packed.first_row[joints], packed.first_row[joints + 1]
    return np.concatenate([np.zeros(0, np.int64), *map(np.arange, first, end)])


def wrenches(
    packed: Packed, compact: np.ndarray, q: np.ndarray, lam: np.ndarray, joints: np.ndarray | None = None
) -> np.ndarray:
    """(T, joints, 3) -J_b^T lam on each joint's second body b, moved from its centre of mass to the second marker.

    compact (T, m, 6), q (T, 3 nb), lam (T, m); N and N m. Ground as second body takes the opposite of what the first
    body gets. With ``joints`` (k,) (T, k, 3) of these, whose rows compact and lam hold (:func:`rows_of_joints`).
    """
    system, counts, markers = packed.system, np.diff(packed.first_row), packed.markers
    if joints is not None:
        counts, markers = counts[joints], markers[joints]
    first_row = np.cumsum(counts) - counts
    i, j = markers.T
    carrier, (x, y) = system.marker_body[j], system.marker_arm[j].T[..., None]
    second = carrier > 0
    body = np.where(second, carrier, system.marker_body[i])
    rows = _by_row(compact)
    own = rows[:, 3:] if second.all() else np.where(np.repeat(second, counts)[:, None, None], rows[:, 3:], rows[:, :3])
    parts = own * _by_time(lam)[:, None]
    push = np.zeros((len(counts), 3, len(lam)))
    for total, start, count in zip(push, first_row, counts, strict=True):
        for row in range(start, start + count):
            total += parts[row]
    push *= np.where(second, -1.0, 1.0)[:, None, None]
    poses, ground = q.reshape(len(q), -1, 3), 1
    if joints is not None:
        bodies, at = np.unique([carrier, body], return_inverse=True)
        poses, (carrier, body), ground = poses[:, bodies], at.reshape(2, -1), int((bodies == 0).any())
    pose = _by_row(poses)
    turn = np.zeros((2, len(pose), len(lam)))
    turn[0, :ground] = 1.0
    np.cos(pose[ground:, 2], out=turn[0, ground:])
    np.sin(pose[ground:, 2], out=turn[1, ground:])
    c, s = turn[:, carrier]
    arm_x = pose[carrier, 0] + (c * x - s * y) - pose[body, 0]
    arm_y = pose[carrier, 1] + (s * x + c * y) - pose[body, 1]
    push[:, 2] -= arm_x * push[:, 1] - arm_y * push[:, 0]
    return np.ascontiguousarray(push.transpose(2, 0, 1))


def _by_row(array: np.ndarray) -> np.ndarray:
    """(a, b, T) of an array (T, a, b): all times of one number side by side, as numpy computes fastest."""
    return np.ascontiguousarray(array.transpose(1, 2, 0))


def _by_time(array: np.ndarray) -> np.ndarray:
    """(a, T) of an array (T, a), or the other way round."""
    return np.ascontiguousarray(array.T)


def marker_places(packed: Packed, q: np.ndarray, marker: int) -> np.ndarray:
    """(T, 2) world places of a marker (m) at poses q (T, 3 nb)."""
    body = packed.system.marker_body[marker]
    x, y = packed.system.marker_arm[marker]
    c, s = np.cos(q[:, 3 * body + 2]), np.sin(q[:, 3 * body + 2])
    return q[:, 3 * body : 3 * body + 2] + np.stack([c * x - s * y, s * x + c * y], axis=1)


def marker_axes(packed: Packed, q: np.ndarray, marker: int, turned: bool = False) -> np.ndarray:
    """(T, 2) unit x axes of a marker, y axes if ``turned``, in the world at poses q (T, 3 nb)."""
    x, y = packed.system.marker_axis[marker]
    if turned:
        x, y = -y, x
    angle = q[:, 3 * packed.system.marker_body[marker] + 2]
    c, s = np.cos(angle), np.sin(angle)
    return np.stack([c * x - s * y, s * x + c * y], axis=1)


def relative_velocity(packed: Packed, q: np.ndarray, v: np.ndarray, i: int | None, j: int) -> np.ndarray:
    """(T, 2) velocity (m/s, world axes) of marker j as the body of marker i sees it; as ground does where i is None."""
    place = marker_places(packed, q, j)
    out = _velocity(q, v, packed.system.marker_body[j], place)
    return out if i is None else out - _velocity(q, v, packed.system.marker_body[i], place)


def _velocity(q: np.ndarray, v: np.ndarray, body: int, place: np.ndarray) -> np.ndarray:
    """(T, 2) of what of a body is at a world place (T, 2)."""
    arm = place - q[:, 3 * body : 3 * body + 2]
    return v[:, 3 * body : 3 * body + 2] + v[:, 3 * body + 2, None] * np.stack([-arm[:, 1], arm[:, 0]], axis=1)


def times_compact(packed: Packed, compact: np.ndarray, x: np.ndarray) -> np.ndarray:
    """(T, m) J x for compact J (T, m, 6) and x (T, 3 nb), whose entries of ground are zero."""
    rows, bodies = _by_row(compact), _by_row(x.reshape(len(x), -1, 3))
    first, second = packed.system.row_body.T
    out = _products(rows[:, 3:], bodies[second])
    return _by_time(_products(rows[:, :3], bodies[first]) + out if first.any() else out)


def _products(rows: np.ndarray, x: np.ndarray) -> np.ndarray:
    """(m, T) of (m, 3, T) times (m, 3, T)."""
    parts = rows * x
    return parts[:, 0] + parts[:, 1] + parts[:, 2]


def generalised(packed: Packed, compact: np.ndarray, lam: np.ndarray) -> np.ndarray:
    """(T, 3 nb) J^T lam for compact J (T, m, 6) and lam (T, m); ground's entries hold what ground takes."""
    parts = _by_row(compact) * _by_time(lam)[:, None]
    out = np.zeros((len(packed.body_names), 3, len(lam)))
    for side in (0, 1):
        bodies, own = packed.system.row_body[:, side], parts[:, 3 * side : 3 * side + 3]
        if len(bodies) > MANY_ROWS:
            np.add.at(out, bodies, own)
            continue
        for row, body in enumerate(bodies):
            out[body] += own[row]
    return _by_time(out.reshape(-1, len(lam)))
