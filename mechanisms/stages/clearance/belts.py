"""Belts and chains as the check sees them: the band that they run in, as a solid beside the bodies.

A belt lies still against the line of its pulleys' centres, whatever runs round in it. So its band (mm) is a piece of
a body of its own: the origin is the first pulley's centre, the x axis goes to the second's. It is as wide and high as
all that the film draws of the belt (shared/contract/belt_section.py), strands that cross included.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass

import numpy as np

from mechanisms.stages.clearance.path import BodyPath
from mechanisms.stages.clearance.pieces import MeshPiece
from shared.contract import Held, JointMotion, Motion, Parts
from shared.contract.belt_path import BeltPath
from shared.contract.belt_section import half_height, half_width
from shared.shapes.units import mm

SAG = 0.02
"""At most so far (mm) the straight sides of the band's outline leave the arcs; it is wider by as much."""


@dataclass(frozen=True)
class Band:
    """One belt."""

    piece: MeshPiece
    path: BodyPath
    axes: dict[str, tuple[np.ndarray, np.ndarray]]
    """By body of a pulley: the pulley's centre in the band's frame and in the body's (mm)."""
    own: frozenset[tuple[str, str]]
    """Body and name of the pieces that hold the belt: its pulleys, which it touches."""


def bands(parts: Parts, motion: Motion, where: Mapping[str, BodyPath]) -> Iterator[Band]:
    """Bands of all belts that pieces hold, as far as their pulleys leave room for a path."""
    for name, joint in motion.joints.items():
        own, held = _holding(parts, name)
        if joint.look != "band" or held is None or joint.shape is None:
            continue
        shape = joint.shape
        if not shape.radius_first or not shape.radius_second:
            continue
        path, distance = _path(joint, where)
        way = BeltPath(mm(shape.radius_first), mm(shape.radius_second), distance, shape.crossed)
        if not way.has_room:
            continue
        chain = bool(shape.teeth)
        wide, high = (
            mm(held.radius) * size for size in (half_width(1.0, chain), half_height(1.0, chain, shape.crossed))
        )
        triangles = band(way, wide, high) + np.array([0.0, 0.0, mm(held.z)])
        ends = [np.zeros(2), np.array([distance, 0.0])]
        axes = {
            body: (end, np.array([mm(marker[0]), mm(marker[1])]))
            for body, marker, end in zip(shape.bodies, shape.markers, ends, strict=True)
        }
        yield Band(MeshPiece(f"belt {name}", name, triangles), path, axes, own)


def band(way: BeltPath, wide: float, high: float) -> np.ndarray:
    """(n, 3, 3): facets round all places within ``wide`` of the belt in the plane, and ``high`` over and under it."""
    import manifold3d

    starts = np.concatenate([[0.0], np.cumsum(way.parts)])
    along = [starts[1], starts[3]]  # where strands begin
    for begins, ends, radius in ((0, 1, way.first), (2, 3, way.second)):
        steps = math.ceil((starts[ends] - starts[begins]) / (2 * math.sqrt(2 * SAG * radius)))
        along.extend(np.linspace(starts[begins], starts[ends], max(steps, 8), endpoint=False))
    points, _ = way.places(np.unique(along))
    loop = manifold3d.CrossSection([points], manifold3d.FillRule.NonZero)
    outer, inner = (loop.offset(side * (wide + SAG), manifold3d.JoinType.Miter, 2.0) for side in (1.0, -1.0))
    solid = (outer - inner).extrude(2 * high).translate((0.0, 0.0, -high))
    mesh = solid.to_mesh64()
    return np.asarray(mesh.vert_properties)[:, :3][np.asarray(mesh.tri_verts).astype(np.int64)]


def _holding(parts: Parts, name: str) -> tuple[frozenset[tuple[str, str]], Held | None]:
    held = {
        (body, piece_name): piece.holds[name]
        for body, solids in parts.bodies.items()
        for piece_name, piece in solids.pieces.items()
        if name in piece.holds
    }
    return frozenset(held), next(iter(held.values()), None)


def _path(joint: JointMotion, where: Mapping[str, BodyPath]) -> tuple[BodyPath, float]:
    """The motion of the first centre and of the line of centres, and the distance of the centres at the start (mm)."""
    assert joint.shape is not None
    ends = [
        _centre(where[body], mm(x), mm(y))
        for body, (x, y, _) in zip(joint.shape.bodies, joint.shape.markers, strict=True)
    ]
    (place, rate, acceleration), (d, dv, da) = ends[0], (b - a for a, b in zip(*ends, strict=True))
    square = (d**2).sum(axis=1)
    turn = np.unwrap(np.arctan2(d[:, 1], d[:, 0]))
    spin = _cross(d, dv) / square
    more = _cross(d, da) / square - 2 * (d * dv).sum(axis=1) * spin / square
    columns = [np.column_stack([xy, angle]) for xy, angle in ((place, turn), (rate, spin), (acceleration, more))]
    return BodyPath(where["ground"].time, *columns), float(np.sqrt(square[0]))


def _centre(path: BodyPath, x: float, y: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """(n, 2) each: place, velocity and acceleration of a point of a body."""
    c, s = np.cos(path.pose[:, 2]), np.sin(path.pose[:, 2])
    arm = np.column_stack([c * x - s * y, s * x + c * y])
    across = np.column_stack([-arm[:, 1], arm[:, 0]])
    omega, alpha = path.rate[:, 2:], path.acceleration[:, 2:]
    return (
        path.pose[:, :2] + arm,
        path.rate[:, :2] + omega * across,
        path.acceleration[:, :2] + alpha * across - omega**2 * arm,
    )


def _cross(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    return a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]
