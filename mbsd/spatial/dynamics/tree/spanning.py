"""The choice of a spanning tree: as few rates as can be, and among these short branches.

A joint of the tree holds its rows by the choice of coordinates, so the tree of most rows has the fewest rates: Prim's
algorithm from ground on. A body that no such joint leads to is free.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

from mbsd.spatial.dynamics.tree import arrays
from mbsd.spatial.model.body import Body
from mbsd.spatial.model.joint import Joint

KINDS = {
    "fixed": arrays.WELD,
    "revolute": arrays.REVOLUTE,
    "prismatic": arrays.PRISMATIC,
    "cylindrical": arrays.CYLINDRICAL,
    "screw": arrays.CYLINDRICAL,
    "universal": arrays.UNIVERSAL,
    "spherical": arrays.SPHERICAL,
}
"""Joints of a mechanism that a tree may have, by the name of their kind. The thread of a screw stays a row."""


class Link(NamedTuple):
    """A body of a tree with the joint that leads to it."""

    body: int
    parent: int
    kind: int
    joint: Joint | None
    """None: the body is free."""


def spanning_tree(bodies: Sequence[Body], joints: Sequence[Joint]) -> list[Link]:
    """Return the links of a tree over all bodies but ground, which is the first; parents come first."""
    number = {body.name: b for b, body in enumerate(bodies)}
    edges = [(KINDS[j.kind.name], [number[name] for name in j.bodies], j) for j in joints if j.kind.name in KINDS]
    depth = {0: 0}
    links: list[Link] = []
    while len(depth) < len(bodies):
        ways = [
            (arrays.RATES[kind], depth[ends[side]], n, side)
            for n, (kind, ends, _) in enumerate(edges)
            for side in (0, 1)
            if ends[side] in depth and ends[1 - side] not in depth
        ]
        if ways:
            _, level, n, side = min(ways)
            kind, ends, joint = edges[n]
            links.append(Link(ends[1 - side], ends[side], kind, joint))
            depth[ends[1 - side]] = level + 1
        else:
            free = min(b for b in range(len(bodies)) if b not in depth)
            links.append(Link(free, 0, arrays.FREE, None))
            depth[free] = 1
    return links
