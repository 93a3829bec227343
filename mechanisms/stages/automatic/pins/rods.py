"""Rods: distance joints, and what is like a body here. A rod has an eye on the pin at either of its ends.

In the model it is a constraint without mass, so it has no pose of its own: its frame is at the joint's first marker,
and its x axis goes to the second.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from mechanisms.stages.automatic.layout.extents import Extent, extent
from shared.shapes.link import Eye, link, plate_link

if TYPE_CHECKING:
    from collections.abc import Collection

    import cadquery as cq

    from mbsd import Mechanism, Solution
    from mbsd.joint import Joint
    from mechanisms.stages.automatic.assembly.body_shape import PlacedEye
    from mechanisms.stages.automatic.layout.layout import Layout
    from shared.shapes.bodies import Place

KIND = "distance"
LEAST = 22.0
"""Least length of a rod (rmm): that of a bar between two pins."""
SLIM = 0.85
"""Width of its shaft in radii of its eyes."""


def rods_of(m: Mechanism, left_out: Collection[str] = ()) -> dict[str, Joint]:
    """By name, which is that of the joint, but for joints whose name a body has; without those that lack an end."""
    found: dict[str, Joint] = {}
    for name, joint in m.joints.items():
        rod = f"rod_{name}" if name in m.bodies else name
        if joint.kind.name == KIND and rod not in left_out and not any(body in left_out for body in joint.bodies):
            found[rod] = joint
    return found


def add_poses(layout: Layout) -> None:
    """Enter where each rod is over the motion."""
    for rod, joint in layout.rods.items():
        start, end = (layout.seen(marker.body.name, layout.place(marker), "ground") for marker in (joint.i, joint.j))
        way = end - start
        layout.poses[rod] = np.column_stack([start, np.unwrap(np.arctan2(way[:, 1], way[:, 0]))])


def ends(joint: Joint, layout: Layout) -> list[tuple[tuple[float, float], str, tuple[float, float]]]:
    """The place of either eye on the rod, the body that it is pinned to, and the place there (rmm)."""
    length = layout.sizes.of_metres(joint.params["length"])
    return [((x, 0.0), marker.body.name, layout.place(marker)) for x, marker in ((0.0, joint.i), (length, joint.j))]


def places(joint: Joint) -> tuple[Place, Place]:
    """What it joins, in mm."""
    first, second = ((marker.body.name, 1e3 * marker.x, 1e3 * marker.y) for marker in (joint.i, joint.j))
    return first, second


def rod_shape(eyes: list[PlacedEye], thickness: float) -> tuple[cq.Workplane, int]:
    """A slim straight shaft between two eyes, from z = 0 up, and its number of through holes."""
    (_, _, start), (length, _, end) = sorted(eyes, key=lambda eye: eye[0])
    widths = SLIM * start.radius, SLIM * end.radius
    for fillet in (8.0, 4.0):
        try:
            return link(length, thickness, start, end, widths, fillet, edge=1.2), 2
        except ValueError:
            continue
    straight: list[tuple[float, float, Eye]] = [(0.0, 0.0, start), (length, 0.0, end)]
    return plate_link(straight, thickness), 2


@extent(KIND)
def extent_of(joint: Joint, solution: Solution) -> Extent:
    """As long as a bar."""
    return Extent(least=((joint.params["length"], LEAST),))
