"""Questions to the CAD kernel: its failures, shapes tried in turn, quick boxes and counted holes."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING

import numpy as np

from shared.shapes.facets import enclosed, facets, is_closed, ruled, volume_of

if TYPE_CHECKING:
    import cadquery as cq


# Box around a shape, found quickly: of curved faces from control points, so somewhat too large.


def rough_box(shape: cq.Workplane) -> tuple[np.ndarray, np.ndarray]:
    """Return the lowest and highest corner (3,) (mm).

    CadQuery's own box is a tight one, which takes a quarter of a second where faces are the outcome of many cuts.
    """
    from OCP.Bnd import Bnd_Box
    from OCP.BRepBndLib import BRepBndLib

    box = Bnd_Box()
    BRepBndLib.Add_s(shape.val().wrapped, box, False)
    numbers = np.array(box.Get())
    return numbers[:3], numbers[3:]


def rough_size(shape: cq.Workplane) -> float:
    """Return the diagonal of the :func:`rough_box` (mm)."""
    low, high = rough_box(shape)
    return float(np.linalg.norm(high - low))


# Failures of the CAD kernel, and shapes that are tried one after the other until one succeeds.


COARSE, ANGLE = 4e-4, 0.3
"""Tolerance of the mesh by which a shape is judged, as a part of its size, and the angle between facets (rad)."""
VOLUME = 5e-3
"""Relative difference of the volumes of solid and mesh from which on one of them is wrong."""


def is_of_kernel(error: BaseException) -> bool:
    """Return True if the CAD kernel raised this.

    It has hundreds of exceptions without a common base.
    """
    return type(error).__module__.split(".")[0] == "OCP"


def is_sound(shape: cq.Workplane) -> bool:
    """Return True if the solid is valid, its mesh closed, and the volume of both the same.

    The kernel calls fillets valid that overlap each other.
    """
    solid = shape.val()
    if not solid.isValid():
        return False
    corners = facets(ruled(solid), COARSE * rough_size(shape), ANGLE)
    return is_closed(corners) and abs(enclosed(corners) / volume_of(solid) - 1) < VOLUME


def first_sound(ways: Sequence[Callable[[], cq.Workplane]]) -> cq.Workplane | None:
    """Return the first shape that has room and that the CAD kernel builds; None if there is none."""
    for way in ways:
        try:
            shape = way()
            if is_sound(shape):
                return shape
        except Exception as error:
            if not isinstance(error, ValueError) and not is_of_kernel(error):
                raise
    return None


# Number of holes through a solid, counted on a coarse mesh, for shapes that follow from a mechanism.


HOLE_ERROR, HOLE_ANGLE = 0.05, 0.6
"""Mesh: distance from the surface, in edges, for each mm of the size; largest angle between facets (rad)."""
SAME = 1e-7
"""Corners that are nearer than this part of the size are one."""


def through_holes(shape: cq.Workplane) -> int:
    """Return the through holes n of one closed solid: V - E + F of its mesh is 2 - 2 n."""
    solid = shape.solids().vals()[0]
    size = rough_size(shape.solids())
    corners = facets(solid, HOLE_ERROR * size, HOLE_ANGLE, relative=True).reshape(-1, 3).astype(float)
    places = np.round(corners / (SAME * size)).astype(np.int64)
    _, which = np.unique(places, axis=0, return_inverse=True)
    triples = which.reshape(-1, 3)
    edges = np.sort(np.concatenate([triples[:, [0, 1]], triples[:, [1, 2]], triples[:, [2, 0]]]), axis=1)
    count = len(np.unique(triples)) - len(np.unique(edges, axis=0)) + len(triples)
    return (2 - count) // 2
