"""Belts and chains as nodes of a glTF scene.

A round belt is a loop that lies still against its line of centres, and marks that are moved and turned along it. A
chain is its links, each a roller, a pin and two plates that are moved and turned so that they reach to the next. All
marks are one mesh, and so are all inner and all outer links. What an event releases shrinks to nothing there.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from render.film.poses import Moment, Poses
from render.film.scene import TubeSpec
from render.film.tubes.belts import CHAIN, Belt
from render.glb.animation import Animation
from render.glb.document import Document
from render.glb.materials import Paints
from render.glb.tubes import Tube, below, primitive, tube, tube_mesh
from shared.contract.belt_section import LONG, PIN

Array = NDArray[np.float64]


def add_belt(
    document: Document, animation: Animation, paints: Paints, poses: Poses, belt: Belt, front: float = math.inf
) -> list[int]:
    """Its nodes, which stand at the root; what is higher than ``front`` (m) is cut away."""
    moments = [Moment(float(poses.time[k]), 0) for k in animation.fewer]
    runs = [belt.run(poses, at) for at in moments]
    places = np.array([place.points(every) for place, every in runs])  # (T, count, 3)
    left = front - belt.z
    if belt.chain:
        ahead = np.roll(places, -1, axis=1) - places
        links = _links(document, paints, belt, ahead, left)
        return _leaving(
            animation, belt, moments, _units(document, animation, links, f"{belt.name} link", places, ahead)
        )
    loop, *marks = belt.specs
    shape = _cut(tube(_flat(belt), loop.radius), left)
    if not len(shape[2]):
        return []
    mesh = tube_mesh(document, paints, loop, belt.name, [shape])
    node = document.add("nodes", {"name": belt.name, "mesh": mesh})
    start = np.array([[*place.origin, belt.z] for place, _ in runs])
    animation.place(node, start, np.unwrap([place.line for place, _ in runs]))
    step = LONG * belt.radius
    ends = [np.array([place.points(every + side * step) for place, every in runs]) for side in (-1.0, 1.0)]
    half = np.array([[-step, 0.0, 0.0], [step, 0.0, 0.0]])
    shape = _cut(tube(half, marks[0].radius), left)
    mark = tube_mesh(document, paints, marks[0], f"{belt.name} mark", [shape])
    marks_of = _units(document, animation, [mark], f"{belt.name} mark", places, ends[1] - ends[0])
    return _leaving(animation, belt, moments, [node, *marks_of])


def _leaving(animation: Animation, belt: Belt, moments: Sequence[Moment], nodes: list[int]) -> list[int]:
    """Shrink the nodes of a belt to nothing from its release on, if it has one; returns them."""
    if belt.until < math.inf:
        size = np.array([[float(at.time <= belt.until)] * 3 for at in moments])
        for node in nodes:
            animation.add(node, "scale", size)
    return nodes


def _cut(shape: Tube, left: float) -> Tube:
    """A tube about the belt's middle without what is higher than ``left`` (m)."""
    return below(shape, left) if left < math.inf else shape


def _flat(belt: Belt) -> Array:
    """The loop's points (n, 3) from its first centre, the second on the x axis."""
    return np.array(belt.still().points(belt.closed)) - [0.0, 0.0, belt.z]


def _links(document: Document, paints: Paints, belt: Belt, ahead: Array, left: float) -> list[int]:
    """Meshes of the links that take turns, without what is higher than ``left`` over their middle (m); none where
    nothing is left.
    """
    length = float(np.hypot(*np.moveaxis(ahead[..., :2], -1, 0)).mean())
    specs = {
        what: TubeSpec(name=what, surface=surface, radius=part * belt.radius, points=2) for what, surface, part in CHAIN
    }
    links = []
    for k in range(1 if belt.alike else 2):
        aside, pin = belt.aside(k), PIN * belt.radius
        lines = {
            "roller": [[0.0, 0, -belt.roller], [0.0, 0, belt.roller]],
            "pin": [[0.0, 0, -pin], [0.0, 0, pin]],
            "lower plate": [[0.0, 0, -aside], [length, 0, -aside]],
            "upper plate": [[0.0, 0, aside], [length, 0, aside]],
        }
        shapes = {what: _cut(tube(np.array(line), specs[what].radius), left) for what, line in lines.items()}
        parts = [primitive(document, paints, specs[what], shape) for what, shape in shapes.items() if len(shape[2])]
        if not parts:
            return []
        links.append(document.add("meshes", {"name": f"{belt.name} link {k + 1}", "primitives": parts}))
    return links


def _units(
    document: Document, animation: Animation, meshes: Sequence[int], name: str, places: Array, ways: Array
) -> list[int]:
    """Equal things at places (T, n, 3), turned to ways (T, n, 3) about z."""
    nodes = []
    for k in range(places.shape[1] if meshes else 0):
        nodes.append(document.add("nodes", {"name": f"{name} {k + 1}", "mesh": meshes[k % len(meshes)]}))
        angle = np.unwrap(np.arctan2(ways[:, k, 1], ways[:, k, 0]), period=math.tau)
        animation.place(nodes[-1], places[:, k], angle)
    return nodes
