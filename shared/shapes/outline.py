"""Closed outlines of lines and tangent arcs in the plane z = 0 (mm), counter-clockwise.

All corners are tangent, so edges of what is extruded from them take fillets and chamfers reliably.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import cadquery as cq
import numpy as np

Point = tuple[float, float]
Circle = tuple[float, float, float]
"""x, y, radius."""


def circle(x: float, y: float, radius: float) -> cq.Wire:
    """Return a full circle."""
    return cq.Wire.makeCircle(radius, cq.Vector(x, y, 0), cq.Vector(0, 0, 1))


def rounded_rectangle(x0: float, y0: float, x1: float, y1: float, radius: float) -> cq.Wire:
    """Return a rectangle with rounded corners. Raises ValueError if they do not fit."""
    if 2 * radius >= min(x1 - x0, y1 - y0):
        raise ValueError(f"corner radius {radius:g} mm is too large for a plate of {x1 - x0:g} x {y1 - y0:g} mm")
    r = radius
    return hull([(x0 + r, y0 + r, r), (x1 - r, y0 + r, r), (x1 - r, y1 - r, r), (x0 + r, y1 - r, r)])


def bar(length: float, radii: Point, widths: Point, fillet: float) -> cq.Wire:
    """Return two round ends at (0, 0) and (length, 0), joined by a tapering web.

    It tapers from widths[0] to widths[1].

    ``widths`` hold on the axes of the ends; the web runs into them with radius ``fillet``.
    Raises ValueError if the ends are not wider than the web or the web has no room.
    """
    for radius, width in zip(radii, widths, strict=True):
        if radius <= width / 2:
            raise ValueError(f"end radius {radius:g} mm must exceed half of the web's width {width:g} mm")
    start, end = np.array([0.0, widths[0] / 2]), np.array([length, widths[1] / 2])
    along = (end - start) / np.linalg.norm(end - start)
    out = np.array([-along[1], along[0]])
    origin = start + fillet * out
    corners = []
    for centre, radius, side in ((np.zeros(2), radii[0], 1.0), (np.array([length, 0.0]), radii[1], -1.0)):
        to = origin - centre
        b = to @ along
        root = math.sqrt(b * b - to @ to + (radius + fillet) ** 2)
        knuckle = origin + (side * root - b) * along  # centre of the fillet
        on_end = centre + (knuckle - centre) * radius / (radius + fillet)
        on_web = knuckle - fillet * out
        middle = knuckle + fillet * _unit(on_end + on_web - 2 * knuckle)
        corners.append((on_end, middle, on_web))
    (end0, mid0, web0), (end1, mid1, web1) = corners
    if (web1 - web0) @ along <= 0:
        raise ValueError(
            f"a link of {length:g} mm has no room for ends of {radii[0]:g} and {radii[1]:g} mm with {fillet:g} mm "
            "fillets; make the ends or the fillet smaller, or the link longer"
        )

    def low(p: np.ndarray) -> np.ndarray:
        return p * (1, -1)

    return cq.Wire.assembleEdges(
        [
            _arc(end0, np.array([-radii[0], 0.0]), low(end0)),
            _arc(low(end0), low(mid0), low(web0)),
            _line(low(web0), low(web1)),
            _arc(low(web1), low(mid1), low(end1)),
            _arc(low(end1), np.array([length + radii[1], 0.0]), end1),
            _arc(end1, mid1, web1),
            _line(web1, web0),
            _arc(web0, mid0, end0),
        ]
    )


def hull(circles: Sequence[Circle], waist: float = math.inf) -> cq.Wire:
    """Return the outline round two or more circles, in counter-clockwise order.

    With ``waist`` infinite the sides are straight; else they curve inwards with that radius.
    """
    count = len(circles)
    sides = [_side(circles[i], circles[(i + 1) % count], waist) for i in range(count)]
    edges = []
    for i in range(count):
        leave, middle, arrive = sides[i]
        edges.append(_line(leave, arrive) if middle is None else _arc(leave, middle, arrive))
        x, y, radius = circles[(i + 1) % count]
        centre = np.array([x, y])
        first = math.atan2(*(arrive - centre)[::-1])
        last = math.atan2(*(sides[(i + 1) % count][0] - centre)[::-1])
        half = first + ((last - first) % (2 * math.pi)) / 2
        edges.append(
            _arc(arrive, centre + radius * np.array([math.cos(half), math.sin(half)]), sides[(i + 1) % count][0])
        )
    return cq.Wire.assembleEdges(edges)


def hull_holds(circles: Sequence[Circle], inner: Circle, tolerance: float = 1e-6) -> bool:
    """Return True if the straight-sided hull round ``circles`` holds another circle.

    No circle of them holds another.
    """
    x, y, radius = inner
    if any(math.hypot(x - u, y - v) + radius <= r + tolerance for u, v, r in circles):
        return True
    if len(circles) == 1:
        return False
    for i in range(len(circles)):
        leave, _, arrive = _side(circles[i], circles[(i + 1) % len(circles)], math.inf)
        along = _unit(arrive - leave)
        to = np.array([x, y]) - leave
        if along[0] * to[1] - along[1] * to[0] < radius - tolerance:
            return False
        if len(circles) == 2 and not -tolerance <= to @ along <= np.linalg.norm(arrive - leave) + tolerance:
            return False
    return True


def window(points: Sequence[Point], rims: Sequence[float], corner: float) -> cq.Wire:
    """Return a convex polygon shrunk by rims[i] at its side from point i to i + 1.

    It is counter-clockwise, and its corners are round.

    Raises ValueError if nothing is left of it.
    """
    corners = inset_corners(points, [rim + corner for rim in rims])
    if corners is None:
        raise ValueError("the rims leave no window; make them or the corner radius smaller")
    return hull([(float(x), float(y), corner) for x, y in corners])


def inset_corners(points: Sequence[Point], insets: Sequence[float]) -> np.ndarray | None:
    """Return corners (n, 2) of a convex polygon with its sides moved inwards; None if nothing is left.

    The polygon is counter-clockwise.
    """
    count = len(points)
    lines = []
    for i, inset in enumerate(insets):
        a, b = np.array(points[i]), np.array(points[(i + 1) % count])
        along = _unit(b - a)
        lines.append((a + inset * np.array([-along[1], along[0]]), along))
    corners = []
    for i in range(count):
        (p, u), (q, v) = lines[i - 1], lines[i]
        s = np.linalg.solve(np.column_stack([u, -v]), q - p)[0]
        corners.append(p + s * u)
    for i in range(count):
        if (corners[(i + 1) % count] - corners[i]) @ lines[i][1] <= 0:
            return None
    return np.array(corners)


def _side(a: Circle, b: Circle, waist: float) -> tuple[np.ndarray, np.ndarray | None, np.ndarray]:
    """Return the end of the side from circle a to b, its middle if curved, and its other end.

    Outside is right.
    """
    p, q, ra, rb = np.array(a[:2]), np.array(b[:2]), a[2], b[2]
    distance = float(np.linalg.norm(q - p))
    along = (q - p) / distance
    right = np.array([along[1], -along[0]])
    if math.isinf(waist):
        lean = (ra - rb) / distance
        normal = lean * along + math.sqrt(1 - lean * lean) * right
        return p + ra * normal, None, q + rb * normal
    forward = ((ra + waist) ** 2 - (rb + waist) ** 2 + distance**2) / (2 * distance)
    aside = (ra + waist) ** 2 - forward**2
    if aside <= 0:
        raise ValueError(f"waist radius {waist:g} mm is too small to span {distance:g} mm; make it larger")
    centre = p + forward * along + math.sqrt(aside) * right
    leave, arrive = p + ra * _unit(centre - p), q + rb * _unit(centre - q)
    return leave, centre + waist * _unit((leave + arrive) / 2 - centre), arrive


def _unit(v: np.ndarray) -> np.ndarray:
    return v / np.linalg.norm(v)


def _line(a: np.ndarray, b: np.ndarray) -> cq.Edge:
    return cq.Edge.makeLine(cq.Vector(*a, 0), cq.Vector(*b, 0))


def _arc(a: np.ndarray, middle: np.ndarray, b: np.ndarray) -> cq.Edge:
    return cq.Edge.makeThreePointArc(cq.Vector(*a, 0), cq.Vector(*middle, 0), cq.Vector(*b, 0))


# Polylines in the plane: distances of places from one, and one of fewer places.


def distances(places: np.ndarray, path: np.ndarray) -> np.ndarray:
    """Return distances (T,) from places (T, 2) to the nearest place of a path (n, 2)."""
    start, way = path[:-1], np.diff(path, axis=0)
    square = np.maximum((way**2).sum(axis=1), 1e-300)
    part = np.clip(((places[:, None] - start) * way).sum(axis=2) / square, 0.0, 1.0)
    return np.sqrt(((places[:, None] - start - part[..., None] * way) ** 2).sum(axis=2).min(axis=1))


def simplified(path: np.ndarray, tolerance: float) -> np.ndarray:
    """Return places of a path (n, 2) whose polygon strays from it by ``tolerance`` at most.

    The method is that of Ramer, Douglas and Peucker.
    """
    kept, waiting = {0, len(path) - 1}, [(0, len(path) - 1)]
    while waiting:
        first, last = waiting.pop()
        if last - first < 2:
            continue
        away = distances(path[first + 1 : last], path[[first, last]])
        if away.max() > tolerance:
            middle = first + 1 + int(away.argmax())
            kept.add(middle)
            waiting += [(first, middle), (middle, last)]
    return path[sorted(kept)]


# A band of even width round a smooth curve, with round ends: the outline of a curved slot (mm).


def band(path: np.ndarray, half: float) -> cq.Wire:
    """Return all points within ``half`` of a smooth open curve.

    The curve goes through ``path`` (n, 2), n > 2, at even steps.

    Raises ValueError if the curve bends so sharply that the band meets itself.
    """
    normal = normals(path)
    left, right = path + half * normal, path - half * normal
    for side in (left, right):
        if ((np.diff(side, axis=0) * np.diff(path, axis=0)).sum(axis=1) <= 0).any():
            raise ValueError(f"a band {2 * half:.3g} mm wide does not follow a curve that bends as sharply")
    ends = []
    for at, way in ((-1, 1.0), (0, -1.0)):
        along = np.array([normal[at, 1], -normal[at, 0]])
        ends.append(path[at] + way * half * along)
    sides = [cq.Edge.makeSpline([_vector(p) for p in side]) for side in (right, left[::-1])]
    caps = [
        cq.Edge.makeThreePointArc(_vector(right[-1]), _vector(ends[0]), _vector(left[-1])),
        cq.Edge.makeThreePointArc(_vector(left[0]), _vector(ends[1]), _vector(right[0])),
    ]
    return cq.Wire.assembleEdges([sides[0], caps[0], sides[1], caps[1]])


def loop(path: np.ndarray, beyond: float) -> cq.Wire:
    """Return the closed curve at a distance outside of a smooth closed curve.

    That one goes through ``path`` (n, 2), whose last place is its first; a negative distance is inside. Raises
    ValueError if the curve bends too sharply for that.
    """
    area = float((path[:-1, 0] * path[1:, 1] - path[1:, 0] * path[:-1, 1]).sum())
    around = np.vstack([path[-2], path, path[1]])
    outward = -math.copysign(1.0, area) * normals(around)[1:-1]
    moved = path + beyond * outward
    if ((np.diff(moved, axis=0) * np.diff(path, axis=0)).sum(axis=1) <= 0).any():
        raise ValueError(f"a groove does not follow a curve at {abs(beyond):.3g} mm that bends as sharply")
    edge = cq.Edge.makeSpline([_vector(p) for p in moved[:-1]], periodic=True)
    return cq.Wire.assembleEdges([edge])


def normals(path: np.ndarray) -> np.ndarray:
    """Return unit vectors (n, 2) to the left of a curve through ``path``."""
    way = np.gradient(path, axis=0, edge_order=2)
    way /= np.maximum(np.linalg.norm(way, axis=1, keepdims=True), 1e-12)
    return np.stack([-way[:, 1], way[:, 0]], axis=1)


def sharpest(path: np.ndarray) -> float:
    """Return the least radius of curvature of a curve through ``path``; infinite if it is straight.

    The path has even steps.
    """
    first, second = np.gradient(path, axis=0, edge_order=2), np.gradient(np.gradient(path, axis=0), axis=0)
    bend = np.abs(first[:, 0] * second[:, 1] - first[:, 1] * second[:, 0])[2:-2].max(initial=0.0)
    speed = float(np.linalg.norm(first, axis=1).max())
    return speed**3 / float(bend) if bend > 1e-12 else math.inf


def _vector(point: np.ndarray) -> cq.Vector:
    return cq.Vector(float(point[0]), float(point[1]), 0.0)
