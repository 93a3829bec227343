"""Reactions of joints from multipliers, and how well a motion fulfils its equations."""

from __future__ import annotations

import numpy as np

from mbsd.arrays.packing import Packed

MANY_ROWS = 200
"""From here on rows are added all at once, which is slower for few."""


def wrenches(packed: Packed, compact: np.ndarray, q: np.ndarray, lam: np.ndarray) -> np.ndarray:
    """(T, joints, 3) -J_b^T lam on each joint's second body b, moved from its centre of mass to the second marker.

    compact (T, m, 6), q (T, 3 nb), lam (T, m); N and N m. Ground as second body takes the opposite of what the first
    body gets.
    """
    system = packed.system
    out = np.zeros((len(lam), len(packed.joints), 3))
    cosines, sines = np.cos(q[:, 2::3]), np.sin(q[:, 2::3])
    for joint, (i, j) in enumerate(packed.markers):
        rows = slice(packed.first_row[joint], packed.first_row[joint + 1])
        second = bool(system.marker_body[j])
        body, sign = (system.marker_body[j], -1.0) if second else (system.marker_body[i], 1.0)
        columns = slice(3, 6) if second else slice(0, 3)
        push = sign * np.einsum("trc,tr->tc", compact[:, rows, columns], lam[:, rows])
        carrier = system.marker_body[j]
        x, y = system.marker_arm[j]
        c, s = cosines[:, carrier], sines[:, carrier]
        arm_x = q[:, 3 * carrier] + (c * x - s * y) - q[:, 3 * body]
        arm_y = q[:, 3 * carrier + 1] + (s * x + c * y) - q[:, 3 * body + 1]
        push[:, 2] -= arm_x * push[:, 1] - arm_y * push[:, 0]
        out[:, joint] = push
    return out


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
    """(T, m) J x for compact J (T, m, 6) and x (T, 3 nb)."""
    bodies = x.reshape(len(x), -1, 3)
    first, second = packed.system.row_body.T
    return (compact[..., :3] * bodies[:, first]).sum(axis=-1) + (compact[..., 3:] * bodies[:, second]).sum(axis=-1)


def generalised(packed: Packed, compact: np.ndarray, lam: np.ndarray) -> np.ndarray:
    """(T, 3 nb) J^T lam for compact J (T, m, 6) and lam (T, m); ground's entries hold what ground takes."""
    out = np.zeros((len(lam), len(packed.body_names), 3))
    for side in (0, 1):
        parts = compact[..., 3 * side : 3 * side + 3] * lam[..., None]
        bodies = packed.system.row_body[:, side]
        if len(bodies) > MANY_ROWS:
            np.add.at(out.swapaxes(0, 1), bodies, parts.swapaxes(0, 1))
            continue
        for row, body in enumerate(bodies):
            out[:, body] += parts[:, row]
    return out.reshape(len(lam), -1)
