"""Position of a penalty contact's disc, or a tyre, to its surface, and of a journal to its bearing."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from mbsd.arrays.reactions import marker_axes, marker_places
from mbsd.arrays.starts import relative_poses
from mbsd.base.codes import AXIS
from mbsd.equations.interactions.law import OWN, STATE, tabulate_stand
from mbsd.model.force import Element
from mbsd.results.measured import measured

if TYPE_CHECKING:
    from mbsd.arrays.packing import Packed
    from mbsd.model.force import Force


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

    Along poses q (T, 3 nb).
    """
    if force.kind.mesh is not None:
        phase = packed.phases.get(force.name, 0.0)
        return force.kind.mesh.flanks(force, phase, *relative_poses(packed, force, q)).clip(min=0.0)
    return (-foot_of(packed, force, q).gap).clip(min=0.0)[None]
