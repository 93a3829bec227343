"""Springs, belts and other tubes of a GLB."""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from render.blender.scene.tubes import SIDES
from render.blender.scene.tubes import tube_vertices as vertices
from render.film.poses import Moment, Poses, moved
from render.film.scene import TubeSpec
from render.film.tubes.belts import CHAIN, Belt
from render.film.tubes.cables import Cable
from render.film.tubes.spirals import Spiral
from render.film.tubes.stretched import Path, Stretched
from render.glb.document import INDICES, VERTICES, Animation, Document, Paints
from shared.contract import Motion
from shared.contract.geometry import LONG, PIN

# Tubes as meshes of a glTF document.

Array = NDArray[np.float64]
Tube = tuple[Array, Array, NDArray[np.signedinteger]]
"""Positions and normals (n, 3), corners (m,)."""


def below(tube: Tube, place: float) -> Tube:
    """Return a tube without what is higher than ``place`` (m), closed by a flat cut face.

    It has no corners if all of it is higher. What is beyond is laid into the plane, and goes between rings that are
    wholly there: exact for a tube that stands upright, to within a facet for one that lies level, to within a ring for
    a coil.
    """
    positions, normals, corners = tube
    beyond = positions[:, 2] > place
    gone = beyond.reshape(-1, SIDES).all(axis=1)  # rings, then both ends
    gone[-2:] = gone[0] & gone[1], gone[-4] & gone[-3]
    triangles = corners.reshape(-1, 3)
    kept = triangles[~gone[triangles // SIDES].all(axis=1)]
    laid = np.column_stack([positions[:, :2], np.minimum(positions[:, 2], place)])
    return laid, np.where(beyond[:, None], [0.0, 0.0, 1.0], normals), kept.reshape(-1)


def tube_mesh(document: Document, paints: Paints, spec: TubeSpec, name: str, tubes: list[Tube]) -> int:
    """Return the number of a mesh; tubes beyond the first are shapes that it may be blended to."""
    (positions, normals, _), *others = tubes
    part = primitive(document, paints, spec, tubes[0])
    if others:
        part["targets"] = [
            {
                "POSITION": document.array((p - positions).astype(np.float32), VERTICES, bounds=True),
                "NORMAL": document.array((n - normals).astype(np.float32), VERTICES),
            }
            for p, n, _ in others
        ]
    mesh: dict[str, Any] = {"name": name, "primitives": [part]}
    if others:
        mesh["weights"] = [0.0] * len(others)
    return document.add("meshes", mesh)


def primitive(document: Document, paints: Paints, spec: TubeSpec, tube: Tube) -> dict[str, Any]:
    """Return a tube as a part of a mesh."""
    positions, normals, corners = tube
    return {
        "attributes": {
            "POSITION": document.array(positions.astype(np.float32), VERTICES, bounds=True),
            "NORMAL": document.array(normals.astype(np.float32), VERTICES),
        },
        "indices": document.array(corners.astype(np.uint16 if len(positions) < 65535 else np.uint32), INDICES),
        "material": paints.number_of(spec.surface),
    }


def tube(path: Array, radius: float) -> Tube:
    """Return positions and normals (n, 3) and corners (m,) of a tube along a path (k, 3) with flat ends."""
    line = [(float(x), float(y), float(z)) for x, y, z in path]
    rings = vertices(line, radius).astype(float).reshape(-1, SIDES, 3)
    middles = np.asarray(path)[:, None]
    outwards = (rings - middles) / radius
    ends = [(path[0] - path[1]), (path[-1] - path[-2])]
    faces = [np.tile(end / np.linalg.norm(end), (SIDES, 1)) for end in ends]
    positions = np.concatenate([rings.reshape(-1, 3), rings[0], rings[-1]])
    normals = np.concatenate([outwards.reshape(-1, 3), *faces])
    side, following = np.arange(SIDES), (np.arange(SIDES) + 1) % SIDES
    quads = []
    for ring in range(len(path) - 1):
        a, b = ring * SIDES + side, ring * SIDES + following
        quads += [np.stack([a, b, b + SIDES], axis=1), np.stack([a, b + SIDES, a + SIDES], axis=1)]
    first, last = len(path) * SIDES, (len(path) + 1) * SIDES
    fan = np.stack([np.zeros(SIDES - 2, int), np.arange(1, SIDES - 1), np.arange(2, SIDES)], axis=1)
    corners = np.concatenate([*quads, first + fan[:, ::-1], last + fan])
    return positions, normals, corners.reshape(-1)


# Belts and chains as nodes of a glTF scene.
#
# A round belt is a loop that lies still against its line of centres, and marks that are moved and turned along it. A
# chain is its links, each a roller, a pin and two plates that are moved and turned so that they reach to the next. All
# marks are one mesh, and so are all inner and all outer links. Belts that an event releases shrink to nothing there.


def add_belt(
    document: Document, animation: Animation, paints: Paints, poses: Poses, belt: Belt, front: float = math.inf
) -> list[int]:
    """Return its nodes, which stand at the root; what is higher than ``front`` (m) is cut away."""
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
    """Return a tube about the belt's middle without what is higher than ``left`` (m)."""
    return below(shape, left) if left < math.inf else shape


def _flat(belt: Belt) -> Array:
    """Return the loop's points (n, 3) from its first centre, the second on the x axis."""
    return np.array(belt.still().points(belt.closed)) - [0.0, 0.0, belt.z]


def _links(document: Document, paints: Paints, belt: Belt, ahead: Array, left: float) -> list[int]:
    """Return meshes of links, without what is higher than ``left`` (m) over their middle.

    The links alternate. There are none where nothing is left.
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
    """Return equal things at places (T, n, 3), turned to ways (T, n, 3) about z."""
    nodes = []
    for k in range(places.shape[1] if meshes else 0):
        nodes.append(document.add("nodes", {"name": f"{name} {k + 1}", "mesh": meshes[k % len(meshes)]}))
        angle = np.unwrap(np.arctan2(ways[:, k, 1], ways[:, k, 0]), period=math.tau)
        animation.place(nodes[-1], places[:, k], angle)
    return nodes


# Tubes that change their shape, as nodes of a glTF scene.
#
# straight   a tube along x from its first end: moved, turned, and longer or shorter by its scale along x
# coil       the same with the coil of its mean length
# rope       LINKS straight tubes end to end
# spiral     moved and turned as its stud; shapes at several windings, blended (morph targets)

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
        """Add the springs of a motion; cut away what is higher than ``front`` (m)."""
        self._document, self._animation, self._paints, self._motion = document, animation, paints, motion
        self._front = front
        self.nodes: list[int] = []

    def stretched(self, spring: Stretched) -> None:
        """Add a spring, damper or rope."""
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

    def cable(self, cable: Cable, poses: Poses) -> None:
        """Add a cable over pulleys: straight tubes from point to point of its path."""
        [spec] = cable.specs
        moments = [Moment(float(poses.time[k]), 0) for k in self._animation.fewer]
        paths = np.array([cable.paths(poses, at)[0] for at in moments])
        for k in range(spec.points - 1):
            self._straight(spec, f"{spec.name} {k + 1}", paths[:, k : k + 2])

    def spiral(self, spring: Spiral) -> None:
        """Add a torsion spring."""
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
            self._animation.place(node, _in_plane(place), start)
        if node is not None and most > least:
            weights = np.maximum(0.0, 1 - np.abs(turned[:, None] - shapes) / (shapes[1] - shapes[0]))[:, 1:]
            self._animation.add(node, "weights", weights)
            self._document.json["nodes"][node]["weights"] = weights[0].astype(np.float32).tolist()
        rim = place + spring.rim * np.stack([np.cos(start), np.sin(start)], axis=1)
        for spec, places, low in ((hub, place, spring.site.hub), (stud, rim, spring.site.base)):
            self._upright(spec, spec.name, places, low, spring.top)

    def _ends(self, body: str, marker: tuple[float, float, float], z: float) -> Array:
        """Return (T, 3) of a marker, at the height of what hangs on it."""
        place = moved(self._motion, body, marker)[0][self._animation.fewer]
        return np.column_stack([place, np.full(len(place), z)])

    def _straight(self, spec: TubeSpec, name: str, lines: Array) -> None:
        """Add a straight tube between two points (T, 2, 3) that move."""
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
        """Add a tube from one height to another (m) at places (T, 2)."""
        node = self._node(spec, name, [tube(np.array([[0.0, 0, low], [0.0, 0, high]]), spec.radius)])
        if node is not None:
            self._animation.place(node, _in_plane(places), np.zeros(len(places)))

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
        """Return a node at a height (m) with a tube as its mesh; None where all of it is cut away.

        Tubes beyond the first are shapes that it may be blended to.
        """
        if self._front < math.inf:
            tubes = [below(shape, self._front - height) for shape in tubes]
        if not len(tubes[0][2]):
            return None
        mesh = tube_mesh(self._document, self._paints, spec, name, tubes)
        self.nodes.append(self._document.add("nodes", {"name": name, "mesh": mesh}))
        return self.nodes[-1]


def _in_plane(places: Array) -> Array:
    """Return (n, 3) of places (n, 2), at height 0."""
    return np.column_stack([places, np.zeros(len(places))])
