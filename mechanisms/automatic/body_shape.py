"""The plate of a body: a bar between two eyes, a plate round more of them, by what outline its eyes have (rmm)."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from mechanisms.automatic.planar import convex_hull
from shared.shapes.link import Eye, link, plate_link
from shared.shapes.solid import placed

if TYPE_CHECKING:
    import cadquery as cq

type PlacedEye = tuple[float, float, Eye]

SLIM = 3.2
"""A triangle lower than this many radii of its eyes gets straight sides and no window."""


def body_shape(eyes: list[PlacedEye], thickness: float) -> tuple[cq.Workplane, int]:
    """The plate from z = 0 up, in the body's frame, and its number of through holes."""
    points = np.array([[x, y] for x, y, _ in eyes])
    if len(eyes) == 1:
        x, y, eye = eyes[0]
        return plate_link([(x, y, eye), (x, y + 0.5 * eye.radius, Eye(eye.radius, 0.0))], thickness), 1
    hull = convex_hull(points, 1e-4)
    corners = [int(np.argmin(np.linalg.norm(points - corner, axis=1))) for corner in hull]
    inner = [eye for k, eye in enumerate(eyes) if k not in corners]
    if len(corners) == 2:
        return _bar([eyes[k] for k in corners], inner, thickness), len(eyes)
    return _plate([eyes[k] for k in corners], inner, thickness)


def _bar(ends: list[PlacedEye], inner: list[PlacedEye], thickness: float) -> cq.Workplane:
    """A waisted bar with I section where it is long enough, else one with straight sides."""
    (x0, y0, start), (x1, y1, end) = ends
    length, turn = math.hypot(x1 - x0, y1 - y0), math.atan2(y1 - y0, x1 - x0)
    c, s = math.cos(turn), math.sin(turn)
    beside = [((x - x0) * c + (y - y0) * s, (y - y0) * c - (x - x0) * s, eye) for x, y, eye in inner]
    widths = tuple(1.28 * eye.radius for eye in (start, end))
    room = length - start.radius - end.radius
    pocket = 2.2 if room > 22.0 and not inner else 0.0
    for fillet, depth in ((12.0, pocket), (12.0, 0.0), (7.0, 0.0), (3.0, 0.0)):
        try:
            shape = link(length, thickness, start, end, (widths[0], widths[1]), fillet, pocket=depth, inner=beside)
            break
        except ValueError:
            continue
    else:
        shape = plate_link([(0.0, 0.0, start), (length, 0.0, end)], thickness, inner=beside)
    return placed(shape, x0, y0, turn=math.degrees(turn))


def _plate(corners: list[PlacedEye], inner: list[PlacedEye], thickness: float) -> tuple[cq.Workplane, int]:
    """A plate with curved sides and a window where it is wide, else one with straight sides."""
    count = len(corners)
    points = np.array([[x, y] for x, y, _ in corners])
    sides = np.roll(points, -1, axis=0) - points
    lengths = np.linalg.norm(sides, axis=1)
    away = points[None] - points[:, None]
    heights = np.abs(sides[:, None, 0] * away[:, :, 1] - sides[:, None, 1] * away[:, :, 0]).max(axis=1) / lengths
    radius = max(eye.radius for _, _, eye in corners)
    holes = len(corners) + len(inner)
    if heights.min() < SLIM * radius:
        return plate_link(corners, thickness, inner=inner), holes
    waist = 2.0 * float(lengths.max())
    if not inner:
        sag = lengths**2 / (8 * waist)
        rims = [
            0.35 * radius + float(sag[i]) * 0.85 - 0.45 * (radius - _least(corners, i, count)) for i in range(count)
        ]
        try:
            return plate_link(corners, thickness, waist=waist, rims=rims), holes + 1
        except ValueError:
            pass
    return plate_link(corners, thickness, waist=waist if not inner else math.inf, inner=inner), holes


def _least(corners: list[PlacedEye], i: int, count: int) -> float:
    return min(corners[i][2].radius, corners[(i + 1) % count][2].radius)
