"""Rods: distance joints, and what is like a body here. A rod has an eye on the pin at either of its ends.

In the model it is a constraint without mass, so it has no pose of its own: its frame is at the joint's first marker,
and its x axis goes to the second.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from mechanisms.stages.automatic.layout.extents import ROD, Extent, extent

if TYPE_CHECKING:
    from mbsd import Solution
    from mbsd.model.joint import Joint
    from mechanisms.stages.automatic.layout.layout import Layout
    from shared.shapes.bodies import Place

LEAST = 22.0
"""Least length of a rod (rmm): that of a bar between two pins."""


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


@extent(ROD)
def extent_of(joint: Joint, solution: Solution) -> Extent:
    """As long as a bar."""
    return Extent(least=((joint.params["length"], LEAST),))
