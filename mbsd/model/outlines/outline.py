"""Outlines of bodies: closed curves of lines and arcs, along which bodies touch and solids are cut.

An outline is a row of corners (x, y, bulge) in the axes of its body. The bulge of a corner is that of the piece to the
next one, as in DXF:

    b = tan(sweep / 4)      0: a line;  b > 0: an arc that bends to the left;  |b| = 1: half a circle

Corners run counter-clockwise, so that matter is on the left; those of a hole run clockwise. Splines become arcs once,
within a tolerance (geometry.py), so that contact, solid and drawing have one and the same curve.
"""

from __future__ import annotations

import math
import os
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from mbsd.base.arguments import number_array, number_pair
from mbsd.base.errors import ModelError
from mbsd.base.names import shown
from mbsd.model.body import Body
from mbsd.model.mechanism import Model, length_given, new_name, own_body
from mbsd.model.outlines.geometry import (
    CHORD,
    STRAIGHT,
    Corner,
    flattened,
    reversed_corners,
    signed_area,
    size_of,
    spline_corners,
)

SAME = 1e-9
"""Corners nearer than this part of the size are one."""
FLAT = 1e-9
"""An outline with less than this part of the square of its size inside has no area."""
SPIKE = 1e-7
"""Turn (rad) short of half a round by which an outline comes back on itself."""


@dataclass(frozen=True)
class Outline:
    """A closed outline of a body, or of a hole in it; see :meth:`mbsd.mechanism.Mechanism.outline`."""

    name: str
    body: Body
    corners: tuple[Corner, ...]
    """(x, y, bulge) in the axes of the body (m), counter-clockwise; clockwise of a hole."""

    @property
    def is_hole(self) -> bool:
        """True if matter is outside."""
        return signed_area(self.corners) < 0.0

    @property
    def area(self) -> float:
        """Area inside (m^2)."""
        return abs(signed_area(self.corners))

    def path(self, chord: float = CHORD) -> np.ndarray:
        """Return (k, 2) points along it (m), on arcs a chord (rad) apart; the first comes last too."""
        return np.array(flattened(self.corners, chord)[0])


@dataclass(frozen=True)
class ArcThrough:
    """A piece of an outline, as :func:`arc_through` returns it."""

    middle: tuple[float, float]
    end: tuple[float, float]


@dataclass(frozen=True)
class SplineThrough:
    """A piece of an outline, as :func:`spline_through` returns it."""

    points: tuple[tuple[float, float], ...]


def arc_through(middle: Sequence[float], end: Sequence[float]) -> ArcThrough:
    """Return the arc of an outline from the point before through ``middle`` to ``end`` (x, y in m)."""
    return ArcThrough(number_pair("arc_through: middle", middle), number_pair("arc_through: end", end))


def spline_through(points: Sequence[Sequence[float]]) -> SplineThrough:
    """Return a piece of an outline: a smooth curve from the point before through ``points`` (k, 2) in m.

    Alone in an outline it is closed and smooth all round. It becomes arcs within the outline's ``tolerance``.
    """
    array = number_array("spline_through: points", points)
    if array.ndim != 2 or array.shape[1] != 2 or len(array) < 2:
        raise ModelError(f"spline_through: points of shape {array.shape} must be two or more rows of x, y (m)")
    return SplineThrough(tuple((float(x), float(y)) for x, y in array))


def circle(radius: float, centre: Sequence[float] = (0.0, 0.0)) -> list[Corner]:
    """Return the path of a circle of ``radius`` (m), for an outline."""
    x, y = number_pair("circle: centre", centre)
    if not (isinstance(radius, int | float | np.number) and 0.0 < float(radius) < math.inf):
        raise ModelError(f"circle: radius is {shown(radius)}; it must be a positive number (m)")
    return [(x + float(radius), y, 1.0), (x - float(radius), y, 1.0)]


Path = Sequence[Sequence[float] | ArcThrough | SplineThrough] | str | os.PathLike[str]


def outline(
    m: Model,
    body: Body | str,
    path: Path,
    name: str | None = None,
    hole: bool = False,
    tolerance: float | None = None,
) -> Outline:
    """Give a body a closed outline, along which it touches others and its solid is cut.

    ``path``: points (x, y) in the axes of the body (m), between which it is straight; ``arc_through`` and
    ``spline_through`` pieces; corners (x, y, bulge) as of DXF; ``circle(radius)``; or the file of a DXF drawing with
    one closed curve, which is read in the unit that it states, millimetres if none. It closes from the last point to
    the first, and may run either way round. A body may have several. ``hole``: matter is outside, as of a ring's bore.

    ``tolerance`` (m): how far arcs may be from a spline, 1e-5 of the outline's size if not given. Raises ModelError for
    what is no closed curve, crosses itself, or has no area.
    """
    owner = own_body(m, body, "outline")
    name = _free_name(m, owner) if name is None else name
    new_name(m, name, "outline", m.outlines)
    what = f"{m.name}: outline '{name}'"
    within = None if tolerance is None else length_given(m, f"outline '{name}' has tolerance", tolerance)
    if isinstance(path, str | os.PathLike):
        from mbsd.model.outlines.dxf import read_dxf

        path = read_dxf(what, path)
    made = m.outlines[name] = Outline(name, owner, checked_corners(what, path, bool(hole), within))
    return made


def _free_name(m: Model, body: Body) -> str:
    names = (body.name if k == 1 else f"{body.name} {k}" for k in range(1, len(m.outlines) + 2))
    return next(name for name in names if name not in m.outlines)


def checked_corners(what: str, path: object, hole: bool, tolerance: float | None) -> tuple[Corner, ...]:
    """Return the corners of a path, the right way round. Raises ModelError for no simple curve."""
    corners = _without_repeats(what, _corners_of(what, path, tolerance))
    if len(corners) == 1:
        raise ModelError(f"{what} has one point; give points all round it, or circle(radius)")
    if len(corners) < 3 and not any(abs(bulge) > STRAIGHT for _, _, bulge in corners):
        raise ModelError(
            f"{what} has {len(corners)} different points; it needs three, or two with an arc between. Give points all "
            "round it, the last not the first again"
        )
    size = size_of(corners)
    _check_crossing(what, corners, size)
    area = signed_area(corners)
    if not abs(area) > FLAT * size * size:
        raise ModelError(
            f"{what} encloses {abs(area):.3g} m^2: its points are in a row and no body is that thin; give points all "
            "round it"
        )
    return reversed_corners(corners) if (area < 0.0) != hole else tuple(corners)


def _corners_of(what: str, path: object, tolerance: float | None) -> list[Corner]:
    """Return the corners of all pieces of a path in order."""
    if isinstance(path, str | bytes) or not isinstance(path, Sequence | np.ndarray):
        raise ModelError(f"{what} needs a path: a list of points (x, y) and arcs, or a DXF file; got {shown(path)}")
    pieces = list(path)
    if len(pieces) == 1 and isinstance(pieces[0], SplineThrough):
        points = np.array(pieces[0].points)
        if len(points) < 3:
            raise ModelError(f"{what}: a closed spline needs three points or more, got {len(points)}")
        return spline_corners(points, True, tolerance)
    corners: list[Corner] = []
    for k, piece in enumerate(pieces):
        if isinstance(piece, ArcThrough | SplineThrough) and not corners:
            raise ModelError(f"{what} begins with a piece that needs a point before it; give (x, y) first")
        if isinstance(piece, ArcThrough):
            x, y, _ = corners[-1]
            corners[-1] = (x, y, _bulge_through(what, (x, y), piece))
            corners.append((*piece.end, 0.0))
        elif isinstance(piece, SplineThrough):
            made = spline_corners(np.array([corners[-1][:2], *piece.points]), False, tolerance)
            corners[-1:] = made
        else:
            corners.append(_corner(f"{what}: point {k + 1}", piece))
    if len(corners) > 1 and math.dist(corners[0][:2], corners[-1][:2]) <= SAME * size_of(corners):
        corners.pop()
    return corners


def _corner(what: str, piece: object) -> Corner:
    row = number_array(what, piece)
    if row.shape not in ((2,), (3,)):
        raise ModelError(
            f"{what} is {shown(piece)}; give (x, y), (x, y, bulge), arc_through(...) or spline_through(...)"
        )
    return float(row[0]), float(row[1]), float(row[2]) if len(row) == 3 else 0.0


def _bulge_through(what: str, start: tuple[float, float], arc: ArcThrough) -> float:
    """Return the bulge of the arc from ``start`` through its middle to its end."""
    (ax, ay), (bx, by) = arc.middle, arc.end
    ux, uy, vx, vy = ax - start[0], ay - start[1], bx - ax, by - ay
    if not math.hypot(ux, uy) * math.hypot(vx, vy) > 0.0:
        raise ModelError(f"{what}: the middle of arc_through({arc.middle}, {arc.end}) is one of its ends; move it")
    turn = math.atan2(ux * vy - uy * vx, ux * vx + uy * vy)
    if abs(abs(turn) - math.pi) < SPIKE:
        raise ModelError(
            f"{what}: arc_through({arc.middle}, {arc.end}): its three points are on a line and its middle is not "
            "between its ends; move the middle"
        )
    return math.tan(turn / 2)


def _without_repeats(what: str, corners: list[Corner]) -> list[Corner]:
    """Return corners without those that repeat the one before them."""
    if not corners:
        raise ModelError(f"{what} has no points; give points all round it, or circle(radius)")
    size = size_of(corners)
    return [
        corner for k, corner in enumerate(corners) if k == 0 or math.dist(corner[:2], corners[k - 1][:2]) > SAME * size
    ]


def _check_crossing(what: str, corners: list[Corner], size: float) -> None:
    """Raise ModelError where an outline crosses or touches itself, or comes back on itself."""
    points, pieces = flattened(corners, CHORD)
    p = np.array(points)
    a, b = p[:-1], p[1:]
    along = b - a
    before = np.roll(along, 1, axis=0)
    turn = np.arctan2(before[:, 0] * along[:, 1] - before[:, 1] * along[:, 0], (before * along).sum(axis=1))
    back = np.flatnonzero(np.pi - np.abs(turn) < SPIKE)
    if len(back):
        x, y = p[back[0]]
        raise ModelError(
            f"{what} comes back on itself at ({x:.4g}, {y:.4g}) m, where it is no body; leave out that spike"
        )
    n = len(a)
    for k in range(n - 2):
        others = np.arange(k + 2, n - (k == 0))
        if not len(others):
            continue
        c, d = a[others], b[others]
        s1, s2 = _side(a[k], b[k], c), _side(a[k], b[k], d)
        s3, s4 = _side(c, d, a[k]), _side(c, d, b[k])
        near = SAME * size * float(np.hypot(*along[k]))
        meets = (np.minimum(s1, s2) <= near) & (np.maximum(s1, s2) >= -near) & (s3 * s4 <= 0.0)
        inside = ((c - a[k]) @ along[k], (d - a[k]) @ along[k])
        meets &= (np.maximum(*inside) >= 0.0) & (np.minimum(*inside) <= along[k] @ along[k])
        if meets.any():
            x, y = 0.5 * (a[k] + b[k])
            other = int(others[np.flatnonzero(meets)[0]])
            raise ModelError(
                f"{what} crosses itself near ({x:.4g}, {y:.4g}) m, between its pieces {pieces[k] + 1} and "
                f"{pieces[other] + 1}, so that no side of it is free; give its points in their order round the body"
            )


def _side(p: np.ndarray, q: np.ndarray, r: np.ndarray) -> np.ndarray:
    return (q[..., 0] - p[..., 0]) * (r[..., 1] - p[..., 1]) - (q[..., 1] - p[..., 1]) * (r[..., 0] - p[..., 0])
