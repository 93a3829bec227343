"""The mechanism as a glTF scene: a node for each body, its pieces below, its motion as one animation in real time.

The scene's z is up, glTF's y: the root turns it. A body's translation and rotation are its frame in data.json; the
ground stands still. There is no floor, no light and no camera: viewers bring theirs.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from render.describe import Film
from render.glb.document import INDICES, VERTICES, Document
from render.glb.materials import CLEARCOAT, material
from render.glb.mesh import smooth
from render.scene import PieceSpec, SurfaceSpec
from render.solids import read_triangles
from shared.contract import Motion

UPRIGHT = (-(0.5**0.5), 0.0, 0.0, 0.5**0.5)
"""Quaternion x, y, z, w of a quarter turn about x, backwards: z becomes y."""


def glb(film: Film) -> bytes:
    """The file's bytes, the same each time."""
    document, motion = Document(), film.motion
    nodes: dict[str, int] = {}
    paints: dict[SurfaceSpec, int] = {}
    rollers: dict[tuple[str, str], int] = {}
    for piece in film.scene.pieces:
        if piece.body not in nodes:
            nodes[piece.body] = document.add("nodes", {"name": piece.body, "children": []})
        mesh = _mesh(document, piece, paints)
        node: dict[str, Any] = {"name": f"{piece.body}/{piece.name}", "mesh": mesh}
        if piece.turns_about is not None:
            node["translation"] = [*piece.turns_about, 0.0]
        child = document.add("nodes", node)
        document.json["nodes"][nodes[piece.body]]["children"].append(child)
        if piece.turns_about is not None:
            rollers[piece.body, piece.name] = child
    root = document.add(
        "nodes", {"name": motion.mechanism, "rotation": list(UPRIGHT), "children": list(nodes.values())}
    )
    document.add("scenes", {"name": motion.mechanism, "nodes": [root]})
    document.json["scene"] = 0
    if any("extensions" in paint for paint in document.json["materials"]):
        document.json["extensionsUsed"] = [CLEARCOAT]
    turning = {rollers[one.body, one.piece]: one.turned for one in film.rollers.found}
    document.add("animations", _animation(document, motion, nodes, turning))
    return document.content()


def _mesh(document: Document, piece: PieceSpec, paints: dict[SurfaceSpec, int]) -> int:
    positions, normals, corners = smooth(read_triangles(Path(piece.stl)))
    if piece.turns_about is not None:
        positions = positions - np.array([*piece.turns_about, 0.0], np.float32)
    if piece.surface not in paints:
        paints[piece.surface] = document.add(
            "materials", material(piece.surface, f"{piece.surface.finish} {len(paints)}")
        )
    primitive = {
        "attributes": {
            "POSITION": document.array(positions, VERTICES, bounds=True),
            "NORMAL": document.array(normals, VERTICES),
        },
        "indices": document.array(corners, INDICES),
        "material": paints[piece.surface],
    }
    return document.add("meshes", {"name": f"{piece.body}/{piece.name}", "primitives": [primitive]})


def _animation(
    document: Document, motion: Motion, nodes: dict[str, int], turning: dict[int, np.ndarray]
) -> dict[str, Any]:
    """Straight lines between the samples of data.json; of two at an event one, because poses agree there.

    ``turning`` has the angles (T,) of nodes that turn against their bodies (rad).
    """
    time = (np.array(motion.time) - motion.time[0]).astype(np.float32)
    kept = np.concatenate([[True], np.diff(np.maximum.accumulate(time)) > 0])
    clock = document.array(time[kept], bounds=True)
    samplers: list[dict[str, Any]] = []
    channels: list[dict[str, Any]] = []
    for name, body in motion.bodies.items():
        if name not in nodes:
            continue
        x, y, turn = np.array(body.x)[kept], np.array(body.y)[kept], _about_z(np.array(body.theta)[kept])
        place = np.stack([x, y, 0 * x], axis=1).astype(np.float32)
        for path, values in (("translation", place), ("rotation", turn)):
            samplers.append({"input": clock, "output": document.array(values), "interpolation": "LINEAR"})
            channels.append({"sampler": len(samplers) - 1, "target": {"node": nodes[name], "path": path}})
        node = document.json["nodes"][nodes[name]]
        node["translation"], node["rotation"] = place[0].tolist(), turn[0].tolist()
    for node, angle in turning.items():
        values = _about_z(angle[kept])
        samplers.append({"input": clock, "output": document.array(values), "interpolation": "LINEAR"})
        channels.append({"sampler": len(samplers) - 1, "target": {"node": node, "path": "rotation"}})
    return {"name": "motion", "samplers": samplers, "channels": channels}


def _about_z(angle: np.ndarray) -> np.ndarray:
    """Quaternions (n, 4) of turns by angles (n,) about z (rad)."""
    half, zero = angle / 2, np.zeros(len(angle))
    return np.stack([zero, zero, np.sin(half), np.cos(half)], axis=1).astype(np.float32)
