"""The plate of a body: a bar between two eyes, a plate round more of them, by what outline its eyes have (rmm)."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from mechanisms.stages.automatic.layout.planar import convex_hull
from shared.shapes.kernel import first_sound
from shared.shapes.link import Eye, link, plate_link
from shared.shapes.outline import hull_holds, inset_corners
from shared.shapes.solid import placed

if TYPE_CHECKING:
    import cadquery as cq

type PlacedEye = tuple[float, float, Eye]

EDGES = (0.8, 0.3, 0.0)
"""Radii of a plate's rounded edges; the largest that the CAD kernel manages is taken."""
SLIM = 2.0
"""A plate lower than this many radii of its eyes gets straight sides and no window."""
BANDS = (0.6, 0.7, 0.85, 1.0)
"""Widths of the band round a window, in radii of the largest eye; the first that leaves the eyes their wall is taken.
"""
WIDENINGS = 24
"""How often the sides at an eye may get wider for its wall."""
EYE_WALL = 0.85
"""What stays of a plate round an eye, in its radii."""
LEAST_WINDOW = 6.0
CORNER = 2.5


def body_shape(eyes: list[PlacedEye], thickness: float) -> tuple[cq.Workplane, int]:
    """The plate from z = 0 up, in the body's frame, and its number of through holes."""
    points = np.array([[x, y] for x, y, _ in eyes])
    if len(eyes) == 1:
        return _round(eyes[0], [], thickness), int(eyes[0][2].bore > 0)
    bores = sum(eye.bore > 0 for _, _, eye in eyes)
    hull = convex_hull(points, 1e-4)
    corners = _outermost([int(np.argmin(np.linalg.norm(points - corner, axis=1))) for corner in hull], eyes)
    inner = [eye for k, eye in enumerate(eyes) if k not in corners]
    if len(corners) == 1:
        return _round(eyes[corners[0]], inner, thickness), bores
    if len(corners) == 2:
        return _bar([eyes[k] for k in corners], inner, thickness), bores
    shape, windows = _plate([eyes[k] for k in corners], inner, thickness)
    return shape, bores + windows


def _outermost(corners: list[int], eyes: list[PlacedEye]) -> list[int]:
    """Those corners whose eyes neither another eye nor the hull round the others holds already, in their order."""
    circles = {k: (eyes[k][0], eyes[k][1], eyes[k][2].radius) for k in corners}
    for k in corners:
        if any(hull_holds([circle], circles[k]) for other, circle in circles.items() if other != k):
            del circles[k]
    for k in list(circles):  # a hull is one of circles of which none holds another
        others = [circle for other, circle in circles.items() if other != k]
        if len(others) > 1 and hull_holds(others, circles[k]):
            del circles[k]
    return list(circles)


def _round(eye: PlacedEye, inner: list[PlacedEye], thickness: float) -> cq.Workplane:
    """A plate that one eye fills."""
    x, y, own = eye
    return plate_link([eye, (x, y + 0.5 * own.radius, Eye(own.radius, 0.0))], thickness, inner=inner)


def _bar(ends: list[PlacedEye], inner: list[PlacedEye], thickness: float) -> cq.Workplane:
    """A waisted bar with I section where it is long enough, else one with straight sides."""
    (x0, y0, start), (x1, y1, end) = ends
    length, turn = math.hypot(x1 - x0, y1 - y0), math.atan2(y1 - y0, x1 - x0)
    c, s = math.cos(turn), math.sin(turn)
    beside = [((x - x0) * c + (y - y0) * s, (y - y0) * c - (x - x0) * s, eye) for x, y, eye in inner]
    widths = 1.28 * start.radius, 1.28 * end.radius
    straight = [(0.0, 0.0, start), (length, 0.0, end)]
    ways: list[Callable[[], cq.Workplane]] = []
    if all(eye.bore > 0 for _, _, eye in beside):
        pockets = (2.2, 0.0) if length - start.radius - end.radius > 22.0 and not inner else (0.0,)
        for fillet, pocket in [(12.0, pocket) for pocket in pockets] + [(7.0, 0.0), (3.0, 0.0)]:
            ways.append(partial(link, length, thickness, start, end, widths, fillet, pocket=pocket, inner=beside))
    ways += [partial(plate_link, straight, thickness, inner=beside, edge=edge) for edge in EDGES]
    return placed(first_made(ways), x0, y0, turn=math.degrees(turn))


def first_made(ways: Sequence[Callable[[], cq.Workplane]]) -> cq.Workplane:
    """The first shape that has room and that the CAD kernel can make; the last one must."""
    made = first_sound(ways[:-1])
    return ways[-1]() if made is None else made


def _plate(corners: list[PlacedEye], inner: list[PlacedEye], thickness: float) -> tuple[cq.Workplane, int]:
    """A plate with curved sides and a window where it is wide, else one with straight sides; its number of windows."""
    points = np.array([[x, y] for x, y, _ in corners])
    sides = np.roll(points, -1, axis=0) - points
    lengths = np.linalg.norm(sides, axis=1)
    away = points[None] - points[:, None]
    heights = np.abs(sides[:, None, 0] * away[:, :, 1] - sides[:, None, 1] * away[:, :, 0]).max(axis=1) / lengths
    if inner or heights.min() < SLIM * max(eye.radius for _, _, eye in corners):
        return first_made([partial(plate_link, corners, thickness, inner=inner, edge=edge) for edge in EDGES]), 0
    waist = 2.0 * float(lengths.max())
    rims = _rims(corners, points, lengths, waist)
    curved = [partial(plate_link, corners, thickness, waist=waist, rims=rims, edge=edge) for edge in EDGES]
    straight = [partial(plate_link, corners, thickness, edge=edge) for edge in EDGES]
    made = first_sound(curved)
    if made is None:  # sides that curve inwards may cross each other
        return first_made(straight), 0
    return made, int(rims is not None)


def _rims(corners: list[PlacedEye], points: np.ndarray, lengths: np.ndarray, waist: float) -> list[float] | None:
    """Insets of the window's sides that leave an even band round it and enough round each eye; None if it is too
    small.
    """
    radii = np.array([eye.radius for _, _, eye in corners])
    edge = (radii + np.roll(radii, -1)) / 2 - lengths**2 / (8 * waist)  # of the plate, from the line of two joints
    for band in BANDS:
        rims = np.maximum(band * radii.max() - edge, 0.15 * radii.max())
        for _ in range(WIDENINGS):
            tips = inset_corners([(float(x), float(y)) for x, y in points], (rims + CORNER).tolist())
            if tips is None or np.linalg.norm(np.roll(tips, -1, axis=0) - tips, axis=1).min() < LEAST_WINDOW:
                break
            apart = np.linalg.norm(tips[:, None] - points[None], axis=2) - CORNER - EYE_WALL * radii
            near = apart.min(axis=0) < 0
            if not near.any():
                return rims.tolist()
            rims = rims + 0.5 * (near | np.roll(near, -1))  # the two sides that meet at an eye
    return None
