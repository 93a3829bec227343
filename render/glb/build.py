"""The mechanism as a glTF scene: a node for each body, its pieces below, its motion in real time.

The root turns what points up in the scene into y of glTF. A body's translation and rotation are its frame in data.json;
the ground stands still; springs, ropes and belts stand beside the bodies. There is no floor, no light and no camera:
viewers bring theirs.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from render.film.film import Film
from render.film.scene import PieceSpec
from render.film.solids import read_triangles
from render.glb.cut import faces_of, front_of, pieces_of
from render.glb.document import CLEARCOAT, INDICES, VERTICES, Animation, Document, Paints, smooth
from render.glb.tubes import Springs, add_belt
from shared.contract.parts import Vector, Z

Quaternion = tuple[float, float, float, float]


def turn(up: Vector) -> Quaternion:
    """Return the quaternion x, y, z, w that turns ``up`` to y of glTF.

    ``up`` is z or a unit vector in the plane: it is a quarter turn about x, backwards, or a turn about z.
    """
    if up == Z:
        return -(0.5**0.5), 0.0, 0.0, 0.5**0.5
    half = math.atan2(up[0], up[1]) / 2
    return 0.0, 0.0, math.sin(half), math.cos(half)


def glb(film: Film) -> bytes:
    """Return the file's bytes, the same each time."""
    return _content(film, pieces_of(film), front_of(film))


def tubes(film: Film) -> bytes:
    """Return a file with springs, ropes and belts alone."""
    return _content(film, [])


def _content(film: Film, pieces: Sequence[PieceSpec], front: float = math.inf) -> bytes:
    document, animation = scene_of(film, pieces, front)
    if any("extensions" in paint for paint in document.json["materials"]):
        document.json["extensionsUsed"] = [CLEARCOAT]
    document.add("animations", animation.content())
    return document.content()


def scene_of(film: Film, pieces: Sequence[PieceSpec], front: float = math.inf) -> tuple[Document, Animation]:
    """Return the scene with these pieces and all springs, ropes and belts, and the work of its nodes.

    Springs, ropes and belts are left out where they are higher than ``front`` (m).
    """
    document, motion = Document(), film.motion
    paints, animation = Paints(document), Animation(document, motion)
    nodes: dict[str, int] = {}
    children: dict[tuple[str, str], int] = {}
    for piece in pieces:
        if piece.body not in nodes:
            nodes[piece.body] = document.add("nodes", {"name": piece.body, "children": []})
        node: dict[str, Any] = {
            "name": f"{piece.body}/{piece.name}",
            "mesh": mesh_of(document, piece, paints, film.studio.radius),
        }
        if piece.turns_about is not None:
            node["translation"] = [*piece.turns_about, 0.0]
        child = children[piece.body, piece.name] = document.add("nodes", node)
        document.json["nodes"][nodes[piece.body]]["children"].append(child)
    for name in nodes:
        if film.in_space is not None:
            if name != "ground":
                place, turned = film.poses.over(name, film.poses.time[animation.kept])
                animation.pose(nodes[name], place, turned)
        elif name in motion.bodies:
            body = motion.bodies[name]
            x, y, theta = (np.array(series)[animation.kept] for series in (body.x, body.y, body.theta))
            animation.place(nodes[name], np.stack([x, y, 0 * x], axis=1), theta)
    for roller in (each for each in film.rollers.found if (each.body, each.piece) in children):
        animation.turn(children[roller.body, roller.piece], roller.turned[animation.kept])
    springs = Springs(document, animation, paints, motion, front)
    if film.in_space is not None:
        return _finished(document, animation, film, [*nodes.values()])
    for stretched in film.stretched:
        springs.stretched(stretched)
    for spiral in film.spirals:
        springs.spiral(spiral)
    for cable in film.cables:
        springs.cable(cable, film.poses)
    belts = [node for belt in film.belts for node in add_belt(document, animation, paints, film.poses, belt, front)]
    return _finished(document, animation, film, [*nodes.values(), *springs.nodes, *belts])


def _finished(document: Document, animation: Animation, film: Film, children: list[int]) -> tuple[Document, Animation]:
    """Return the document with the root of its nodes, which turns what points up."""
    name = film.motion.mechanism
    root = {"name": name, "rotation": list(turn(film.parts.mount.up)), "children": children}
    document.add("scenes", {"name": name, "nodes": [document.add("nodes", root)]})
    document.json["scene"] = 0
    return document, animation


def mesh_of(document: Document, piece: PieceSpec, paints: Paints, radius: float) -> int:
    """Return the number of a piece's mesh in the document, as far as a section leaves it.

    The machine has this radius (m).
    """
    triangles = read_triangles(Path(piece.stl))
    faces = faces_of(triangles, piece, radius) if piece.cut else [(triangles, piece.surface)]
    primitives = [_primitive(document, part, piece, paints.number_of(surface)) for part, surface in faces if len(part)]
    return document.add("meshes", {"name": f"{piece.body}/{piece.name}", "primitives": primitives})


def _primitive(document: Document, triangles: np.ndarray, piece: PieceSpec, paint: int) -> dict[str, Any]:
    positions, normals, corners = smooth(triangles)
    if piece.turns_about is not None:
        positions = positions - np.array([*piece.turns_about, 0.0], np.float32)
    return {
        "attributes": {
            "POSITION": document.array(positions, VERTICES, bounds=True),
            "NORMAL": document.array(normals, VERTICES),
        },
        "indices": document.array(corners, INDICES),
        "material": paint,
    }
