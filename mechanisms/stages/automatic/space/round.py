"""Round solids along any axis, of which parts in space are composed (mm).

Places and directions are (3,) arrays in the frame of the body; axes are unit vectors.
"""

from __future__ import annotations

import math

import cadquery as cq
import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


def unit(vector: Array) -> Array:
    """Return a vector at length 1; raises ValueError for one without a length, of which a kernel would make no end."""
    length = float(np.linalg.norm(vector))
    if not length > 0.0:
        raise ValueError("a direction has no length")
    return vector / length


def across(axis: Array, near: Array | None = None) -> Array:
    """Return a unit vector normal to a unit ``axis``, as near to ``near`` as can be."""
    for start in ([] if near is None else [near]) + list(
        np.eye(3)[np.argsort(np.abs(np.round(axis, 9)), kind="stable")]
    ):
        normal = start - (start @ axis) * axis
        if np.linalg.norm(normal) > 1e-6 * max(1.0, float(np.linalg.norm(start))):
            return unit(normal)
    raise ValueError("an axis has no length")


def rod(start: Array, end: Array, radius: float) -> cq.Shape:
    """Return a cylinder from one place to another."""
    way = end - start
    return cq.Solid.makeCylinder(radius, float(np.linalg.norm(way)), cq.Vector(*start), cq.Vector(*way))


def disc(middle: Array, axis: Array, radius: float, half: float) -> cq.Shape:
    """Return a cylinder about an axis, ``half`` to both sides of its middle."""
    return rod(middle - half * axis, middle + half * axis, radius)


def ball(middle: Array, radius: float, pole: Array | None = None) -> cq.Shape:
    """Return a sphere; its poles, where facets are narrow, lie along ``pole``."""
    way = np.array([0.0, 0.0, 1.0]) if pole is None else pole
    return cq.Solid.makeSphere(radius, cq.Vector(*middle), cq.Vector(*way), -90, 90, 360)


def box(middle: Array, x: Array, y: Array, halves: tuple[float, float, float]) -> cq.Shape:
    """Return a box about its middle, with ``halves`` of its sides along x, y and the normal of both."""
    z = np.cross(x, y)
    corner = middle - halves[2] * z
    plane = cq.Plane(origin=tuple(corner), xDir=tuple(x), normal=tuple(z))
    made = cq.Workplane(plane).rect(2 * halves[0], 2 * halves[1]).extrude(2 * halves[2])
    return made.val()  # pyright: ignore[reportReturnType]


def yoke(
    middle: Array, axis: Array, back: Array, inner: float, wall: float, width: float, depth: float, bridge: float
) -> list[cq.Shape]:
    """Return the solids of a fork: two cheeks on ``axis`` about ``middle``, and the bridge ``back`` from there.

    ``inner`` is half of the room between cheeks, ``wall`` their thickness, ``width`` half of their height, ``depth``
    the distance of the bridge, whose thickness is ``bridge``.
    """
    side = np.cross(axis, back)
    out = []
    for way in (1.0, -1.0):
        cheek = middle + way * (inner + wall / 2) * axis
        reach = (depth + bridge) / 2
        out.append(box(cheek + reach * back, back, side, (reach, width, wall / 2)))
        out.append(disc(cheek, axis, width, wall / 2))
    out.append(box(middle + (depth + bridge / 2) * back, back, side, (bridge / 2, width, inner + wall)))
    return out


def rays(axis: Array) -> Array:
    """Return eight unit vectors (8, 3) round an axis."""
    x = across(axis)
    turn = np.linspace(0.0, 2.0 * math.pi, 9)[:-1]
    return np.outer(np.cos(turn), x) + np.outer(np.sin(turn), np.cross(axis, x))


def tube_lines(middle: Array, axis: Array, radius: float, half: float) -> list[tuple[Array, Array, float]]:
    """Return thin lines (two places and a radius each) on a cylinder, which end where it ends."""
    thin = 0.25 * radius
    rim = middle + (radius - thin) * rays(axis)
    return [(place - (half - thin) * axis, place + (half - thin) * axis, thin) for place in rim]


def extent(line: tuple[Array, Array, float], axis: Array) -> float:
    """Return how far a cylinder (two places and a radius), or a ball where they are one, reaches along a unit axis."""
    a, b, radius = line
    length = float(np.linalg.norm(b - a))
    lean = float((b - a) @ axis) / length if length > 0.0 else 0.0
    return max(float(a @ axis), float(b @ axis)) + radius * math.sqrt(max(1.0 - lean**2, 0.0))


def fused(solids: list[cq.Shape], cuts: list[cq.Shape]) -> cq.Workplane:
    """Return one solid of several that overlap, less others."""
    made = solids[0]
    if len(solids) > 1:
        joined = made.fuse(*solids[1:])
        cleaned = joined.clean()
        made = cleaned if cleaned.isValid() else joined  # cleaning breaks some where spheres meet planes
    if cuts:
        made = made.cut(*cuts)
    return cq.Workplane(obj=made)
