"""Outlines of toothed parts as they move: whether they overlap, and how far apart they are."""

from __future__ import annotations

import math

import numpy as np

from mechanisms.stages.automatic.automatic import Automatic
from mechanisms.stages.automatic.layout.planar import core_gaps
from mechanisms.stages.automatic.wheels.racks import Rack
from mechanisms.stages.automatic.wheels.wheels import Wheel
from shared.shapes.involute import rack_outline, toothed


def outline(wheel: Wheel | Rack) -> np.ndarray:
    """(n, 2) in its body's frame (mm)."""
    phase = wheel.phase or 0.0
    if isinstance(wheel, Rack):
        first, last = wheel.teeth
        points = rack_outline(
            last - first + 1, wheel.module, wheel.tip, wheel.root, 3.0, wheel.play / 2, phase + first * wheel.pitch
        )
        return np.array([wheel.place(float(x), float(y)) for x, y in points])
    if wheel.ring:
        space = phase + math.pi / wheel.teeth
        points = toothed(wheel.teeth, wheel.module, wheel.root, wheel.tip, -wheel.play / 2, space)
    else:
        points = toothed(wheel.teeth, wheel.module, wheel.tip, wheel.root, wheel.play / 2, phase)
    return points + np.array([wheel.x, wheel.y])


def inside(points: np.ndarray, polygon: np.ndarray) -> np.ndarray:
    """Even-odd rule."""
    (x, y), (x0, y0) = points.T[:, :, None], polygon.T[:, None]
    x1, y1 = np.roll(polygon, -1, axis=0).T[:, None]
    with np.errstate(divide="ignore", invalid="ignore"):
        crosses = ((y0 > y) != (y1 > y)) & (x < (x1 - x0) * (y - y0) / (y1 - y0) + x0)
    return crosses.sum(axis=1) % 2 == 1


def gap(made: Automatic, first: Wheel | Rack, second: Wheel, at: int) -> float:
    """Distance (mm) of two outlines at a pose; negative where one lies in the other's material."""
    placed = []
    for wheel in (first, second):
        x, y, turn = made.layout.poses[wheel.body][at]
        c, s = math.cos(turn), math.sin(turn)
        placed.append(outline(wheel) @ np.array([[c, s], [-s, c]]) + [x, y])
    a, b = placed
    ring = isinstance(first, Wheel) and first.ring
    hit = ~inside(b, a) if ring else inside(b, a)
    if hit.any() or inside(a, b).any():
        return -1.0
    return min(_to_sides(a, b), _to_sides(b, a)) * made.sizes.scale


def _to_sides(corners: np.ndarray, polygon: np.ndarray) -> float:
    """From corners near a polygon to its sides."""
    middle = polygon.mean(axis=0)
    reach = np.linalg.norm(polygon - middle, axis=1).max() + 1.0
    near = corners[np.linalg.norm(corners - middle, axis=1) < reach]
    sides = np.stack([polygon, np.roll(polygon, -1, axis=0)], axis=1)
    gaps = [float(core_gaps(np.repeat(p[None, None], len(sides), axis=0), sides).min()) for p in near]
    return min(gaps, default=math.inf)
