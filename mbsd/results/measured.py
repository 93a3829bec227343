"""The scalar that an element of a force measures between its markers."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from mbsd.arrays.packing import Packed
from mbsd.arrays.reactions import marker_axes, marker_places, relative_velocity
from mbsd.arrays.states import own_states
from mbsd.base.codes import AXIS, LINE, TURN
from mbsd.model.force import Element

if TYPE_CHECKING:
    from mbsd.arrays.packing import Packed


def measured(packed: Packed, element: Element, i: int, j: int, q: np.ndarray) -> np.ndarray:
    """(T,) the scalar x (m or rad) of an element between markers i and j along poses q (T, 3 nb)."""
    bi, bj = packed.system.marker_body[i], packed.system.marker_body[j]
    if element.kind == TURN:
        return q[:, 3 * bj + 2] - q[:, 3 * bi + 2]
    gap = marker_places(packed, q, j) - marker_places(packed, q, i)
    if element.kind == LINE:
        return np.hypot(gap[:, 0], gap[:, 1])
    assert element.kind == AXIS, "a push measures nothing"
    return (marker_axes(packed, q, i, element.turned) * gap).sum(axis=1)


def measured_rate(packed: Packed, element: Element, i: int, j: int, q: np.ndarray, v: np.ndarray) -> np.ndarray:
    """(T,) its rate (m/s or rad/s) along q and v (T, 3 nb)."""
    bi, bj = packed.system.marker_body[i], packed.system.marker_body[j]
    if element.kind == TURN:
        return v[:, 3 * bj + 2] - v[:, 3 * bi + 2]
    speed = relative_velocity(packed, q, v, i, j)
    if element.kind == AXIS:
        return (marker_axes(packed, q, i, element.turned) * speed).sum(axis=1)
    gap = marker_places(packed, q, j) - marker_places(packed, q, i)
    length = np.hypot(gap[:, 0], gap[:, 1])
    return np.divide((gap * speed).sum(axis=1), length, out=np.zeros_like(length), where=length > 0.0)


def check_states(packed: Packed, t: np.ndarray, q: np.ndarray, states: np.ndarray) -> None:
    """Check each force's states (T, n) (SI) along q (T, 3 nb) at times (T,); raises ModelError."""
    for force, (i, j) in zip(packed.forces, packed.force_markers, strict=True):
        if force.kind.states is not None:
            assert force.kind.along is not None
            value = measured(packed, force.kind.along(force), i, j, q)
            force.kind.states.check(packed.name, force, t, value, states[:, own_states(packed.forces, force.name)])
