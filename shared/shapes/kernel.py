"""Failures of the CAD kernel, and shapes that are tried one after the other until one succeeds."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING

from shared.shapes.facets import enclosed, facets, is_closed, ruled, volume_of
from shared.shapes.rough_box import rough_size

if TYPE_CHECKING:
    import cadquery as cq

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
