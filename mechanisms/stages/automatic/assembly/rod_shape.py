"""The plate of a rod: a slim straight shaft between two eyes (rmm)."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

from mechanisms.stages.automatic.assembly.body_shape import EDGES, first_made
from shared.shapes.link import Eye, link, plate_link

if TYPE_CHECKING:
    import cadquery as cq

    from mechanisms.stages.automatic.assembly.body_shape import PlacedEye

SLIM = 0.85
"""Width of its shaft in radii of its eyes."""


def rod_shape(eyes: list[PlacedEye], thickness: float) -> tuple[cq.Workplane, int]:
    """A slim straight shaft between two eyes, from z = 0 up, and its number of through holes."""
    (_, _, start), (length, _, end) = sorted(eyes, key=lambda eye: eye[0])
    widths = SLIM * start.radius, SLIM * end.radius
    straight: list[tuple[float, float, Eye]] = [(0.0, 0.0, start), (length, 0.0, end)]
    ways = [partial(link, length, thickness, start, end, widths, fillet, edge=1.2) for fillet in (8.0, 4.0)]
    return first_made([*ways, *(partial(plate_link, straight, thickness, edge=edge) for edge in EDGES)]), 2
