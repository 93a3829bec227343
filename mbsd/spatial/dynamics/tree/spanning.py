"""The choice of a spanning tree: as few rates as can be, and among these short branches.

A joint of the tree holds its rows by the choice of coordinates, so the tree of most rows has the fewest rates: Prim's
algorithm from ground on. A body that no such joint leads to is free.
"""

from __future__ import annotations

import heapq
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
    ways: dict[int, list[tuple[int, int]]] = {b: [] for b in range(len(bodies))}
    for n, joint in enumerate(joints):
        if joint.kind.name in KINDS:
            first, second = (number[name] for name in joint.bodies)
            ways[first].append((n, second))
            ways[second].append((n, first))
    links: list[Link] = []
    known: set[int] = set()
    edges: list[tuple[int, int, int, int, int]] = []

    def reach(body: int, depth: int) -> None:
        known.add(body)
        for n, other in ways[body]:
            heapq.heappush(edges, (arrays.RATES[KINDS[joints[n].kind.name]], depth, n, other, body))

    reach(0, 0)
    for free in range(len(bodies)):
        if free not in known:
            links.append(Link(free, 0, arrays.FREE, None))
            reach(free, 1)
        while edges:
            _, depth, n, body, parent = heapq.heappop(edges)
            if body not in known:
                links.append(Link(body, parent, KINDS[joints[n].kind.name], joints[n]))
                reach(body, depth + 1)
    return links
