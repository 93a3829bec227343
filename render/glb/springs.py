"""What changes its shape, as nodes of a glTF scene.

straight   a tube along x from its first end: moved, turned, and longer or shorter by its scale along x
coil       the same with the coil of its mean length
rope       LINKS straight tubes end to end
spiral     moved and turned as its stud; shapes at several windings, blended (morph targets)
"""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from render.film.markers import moved
from render.film.scene import TubeSpec
from render.film.tubes.spirals import Spiral
from render.film.tubes.stretched import Path, Stretched
from render.glb.animation import Animation
from render.glb.document import Document
from render.glb.materials import Paints
from render.glb.tubes import Tube, below, tube, tube_mesh
from shared.contract import Motion

Array = NDArray[np.float64]
LINKS = 24
"""Number of links of a rope."""
WINDING = 0.35
"""Angle (rad) between two shapes of a spiral, at most, as long as there are no more than SHAPES."""
SHAPES = 32


class Springs:
    """Adds them to a document; ``nodes`` are those that stand at its root."""

    def __init__(
        self, document: Document, animation: Animation, paints: Paints, motion: Motion, front: float = math.inf
    ) -> None:
        """What is higher than ``front`` (m) is cut away."""
        self._document, self._animation, self._paints, self._motion = document, animation, paints, motion
        self._front = front
        self.nodes: list[int] = []

    def stretched(self, spring: Stretched) -> None:
        """A spring, damper or rope."""
        a, b = (
            self._ends(body, marker, spring.z)
            for body, marker in zip(spring.shape.bodies, spring.shape.markers, strict=True)
        )
        for spec, path in spring.tubes:
            if spec.points == 2:
                lines = np.array([path(*ends) for ends in zip(a, b, strict=True)])
                self._straight(spec, spec.name, lines)
            elif spring.name in self._motion.contacts:
                ropes = np.array([path(*ends) for ends in zip(a, b, strict=True)])
                cuts = np.linspace(0, spec.points - 1, LINKS + 1).round().astype(int)
                for k, (first, last) in enumerate(pairwise(cuts)):
                    self._straight(spec, f"{spec.name} {k + 1}", ropes[:, [first, last]])
            else:
                self._coil(spec, path, a, b)

    def spiral(self, spring: Spiral) -> None:
        """A torsion spring."""
        wire, hub, stud = spring.specs
        fewer = self._animation.fewer
        place, start = (values[fewer] for values in moved(self._motion, spring.outer, spring.at))
        inner = moved(self._motion, spring.inner, (0.0, 0.0, 0.0))[1][fewer]
        turned = inner - (start - spring.at[2])
        least, most = float(turned.min()), float(turned.max())
        shapes = np.linspace(least, most, min(SHAPES, max(2, math.ceil((most - least) / WINDING) + 1)))
        tubes = [tube(spring.curve(angle), wire.radius) for angle in shapes]
        node = self._node(wire, wire.name, tubes)
        if node is not None:
            self._animation.place(node, _flat(place), start)
        if node is not None and most > least:
            weights = np.maximum(0.0, 1 - np.abs(turned[:, None] - shapes) / (shapes[1] - shapes[0]))[:, 1:]
            self._animation.add(node, "weights", weights)
            self._document.json["nodes"][node]["weights"] = weights[0].astype(np.float32).tolist()
        rim = place + spring.rim * np.stack([np.cos(start), np.sin(start)], axis=1)
        for spec, places, low in ((hub, place, spring.site.hub), (stud, rim, spring.site.base)):
            self._upright(spec, spec.name, places, low, spring.top)

    def _ends(self, body: str, marker: tuple[float, float, float], z: float) -> Array:
        """(T, 3) of a marker, at the height of what hangs on it."""
        place = moved(self._motion, body, marker)[0][self._animation.fewer]
        return np.column_stack([place, np.full(len(place), z)])

    def _straight(self, spec: TubeSpec, name: str, lines: Array) -> None:
        """Between two points (T, 2, 3) that move."""
        way = lines[:, 1] - lines[:, 0]
        if not way[:, :2].any():
            low, high = (float(z) for z in lines[0, :, 2])
            self._upright(spec, name, lines[:, 0, :2], low, high)
            return
        length = np.hypot(way[:, 0], way[:, 1])
        mean = float(length.mean())
        level = tube(np.array([[0.0, 0, 0], [mean, 0, 0]]), spec.radius)
        node = self._node(spec, name, [level], float(lines[0, 0, 2]))
        self._between(node, lines[:, 0], way, length / mean)

    def _upright(self, spec: TubeSpec, name: str, places: Array, low: float, high: float) -> None:
        """From one height to another (m) at places (T, 2)."""
        node = self._node(spec, name, [tube(np.array([[0.0, 0, low], [0.0, 0, high]]), spec.radius)])
        if node is not None:
            self._animation.place(node, _flat(places), np.zeros(len(places)))

    def _coil(self, spec: TubeSpec, path: Path, a: Array, b: Array) -> None:
        length = np.hypot(*(b - a)[:, :2].T)
        mean = float(length.mean())
        coil = tube(path(np.zeros(3), np.array([mean, 0.0, 0.0])), spec.radius)
        node = self._node(spec, spec.name, [coil], float(a[0, 2]))
        self._between(node, a, b - a, length / mean)

    def _between(self, node: int | None, start: Array, way: Array, longer: Array) -> None:
        """Lay a node from (T, 3) along ways (T, 3), stretched by factors (T,)."""
        if node is None:
            return
        angle = np.unwrap(np.arctan2(way[:, 1], way[:, 0]))
        self._animation.place(node, start, angle)
        scale = np.column_stack([longer, np.ones((len(longer), 2))])
        self._animation.add(node, "scale", scale)
        self._document.json["nodes"][node]["scale"] = scale[0].astype(np.float32).tolist()

    def _node(self, spec: TubeSpec, name: str, tubes: list[Tube], height: float = 0.0) -> int | None:
        """A node at a height (m) with a tube as its mesh; tubes beyond the first are shapes that it may be blended to.
        None where all of it is cut away.
        """
        if self._front < math.inf:
            tubes = [below(shape, self._front - height) for shape in tubes]
        if not len(tubes[0][2]):
            return None
        mesh = tube_mesh(self._document, self._paints, spec, name, tubes)
        self.nodes.append(self._document.add("nodes", {"name": name, "mesh": mesh}))
        return self.nodes[-1]


def _flat(places: Array) -> Array:
    """(n, 3) of places (n, 2), at height 0."""
    return np.column_stack([places, np.zeros(len(places))])
