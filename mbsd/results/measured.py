"""Values that forces measure along a motion: lengths and angles of elements, gaps, depths."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from mbsd.arrays.packing import Packed
from mbsd.arrays.reactions import marker_axes, marker_places, relative_velocity
from mbsd.arrays.starts import relative_poses
from mbsd.arrays.states import own_states
from mbsd.base.codes import AXIS, LINE, TURN
from mbsd.equations.interactions.law import OWN, STATE, tabulate_stand
from mbsd.model.force import Element

if TYPE_CHECKING:
    from mbsd.model.force import Force


@dataclass(frozen=True)
class Moved:
    """The source of views: a motion of T times, and what was computed together with it."""

    packed: Packed
    t: np.ndarray
    q: np.ndarray
    """(T, 3 nb)"""
    v: np.ndarray
    lam: np.ndarray
    """(T, m)"""
    held: np.ndarray | None
    """(T, m) rows that held; None: all."""
    span: tuple[float, float]
    """Times (s) over which the run prepared its laws."""
    a: np.ndarray
    """(T, 3 nb)"""
    approached: np.ndarray | None = None
    """(T, n) how fast the contact of each interaction approached when it began (m/s), where one asks for it."""
    states: np.ndarray | None = None
    """(T, n) of all forces that carry states (SI); None: none does."""
    pairs: np.ndarray | None = None
    """(T, o) pairs of outlines that touched; None without outlines."""


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


class Foot(NamedTuple):
    """Position of a disc to a surface, (T, ...) arrays in world axes; a bearing is around its journal."""

    gap: np.ndarray
    """(T,) distance of the surface less the disc's radius (m)."""
    place: np.ndarray
    """(T, 2) nearest point of the surface (m)."""
    normal: np.ndarray
    """(T, 2) unit, out of the surface."""


def foot_of(packed: Packed, force: Force, q: np.ndarray) -> Foot:
    """Return the foot of the disc or journal of a force along poses q (T, 3 nb).

    The force's kind has a ``surface`` or ``journal``.
    """
    if force.kind.journal is not None:
        return _in_bearing(packed, force, q)
    assert force.kind.surface is not None
    i, j = packed.markers_of(force)
    numbers, stand = np.array([0.0] * OWN + force.kind.surface(force)), np.zeros((len(q), 3))
    x, y = (measured(packed, Element(AXIS, (), turned), i, j, q) for turned in (False, True))
    tabulate_stand(numbers, x, y, np.zeros(STATE), stand)
    distance, tx, ty = stand.T[:, :, None]
    normal = -ty * marker_axes(packed, q, i) + tx * marker_axes(packed, q, i, turned=True)
    place = marker_places(packed, q, j) - distance * normal
    return Foot(distance[:, 0] - force.params["radius"], place, normal)


def _in_bearing(packed: Packed, force: Force, q: np.ndarray) -> Foot:
    """Return the foot of a journal; in the middle of its bearing there is none, and the normal is zero."""
    assert force.kind.journal is not None
    i, j = packed.markers_of(force)
    radius, clearance = force.kind.journal(force)
    centre = marker_places(packed, q, j)
    away = centre - marker_places(packed, q, i)
    length = np.hypot(*away.T)[:, None]
    outwards = np.divide(away, length, out=np.zeros_like(away), where=length > 0.0)
    return Foot(clearance - length[:, 0], centre + radius * outwards, -outwards)


def gaps_of(packed: Packed, force: Force, q: np.ndarray) -> list[float]:
    """Return gaps or depths (m), above 0, of a journal or gears' flanks in a pose q (1, 3 nb).

    Other forces have none.
    """
    if force.kind.journal is not None:
        return [abs(float(foot_of(packed, force, q).gap[0]))]
    if force.kind.mesh is not None:
        phase = packed.phases.get(force.name, 0.0)
        return np.abs(force.kind.mesh.flanks(force, phase, *relative_poses(packed, force, q))[:, 0]).tolist()
    return []


def depths(packed: Packed, force: Force, q: np.ndarray) -> np.ndarray:
    """(k, T) depth (m) of the disc in the surface, of both flanks of gears, 0 where they do not touch.

    Along poses q (T, 3 nb). Of what counts its turn it is that turn (rad).
    """
    if force.kind.counts_turn:
        return (relative_poses(packed, force, q)[2] - packed.phases.get(force.name, 0.0))[None]
    if force.kind.mesh is not None:
        phase = packed.phases.get(force.name, 0.0)
        return force.kind.mesh.flanks(force, phase, *relative_poses(packed, force, q)).clip(min=0.0)
    return (-foot_of(packed, force, q).gap).clip(min=0.0)[None]
