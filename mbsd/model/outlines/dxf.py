"""Outlines from DXF drawings: one closed curve of lines, arcs, circles, polylines and splines.

Read are LINE, ARC, CIRCLE, LWPOLYLINE, POLYLINE with VERTEX, and SPLINE without weights, from the ENTITIES of an ASCII
file, in the unit of $INSUNITS. Pieces may stand in any order and direction; ends that are nearer than JOINED of
the size meet.
"""

from __future__ import annotations

import math
import os
from collections.abc import Iterator
from pathlib import Path

import numpy as np

from mbsd.base.errors import ModelError
from mbsd.model.outlines.geometry import Corner, spline_corners

UNITS = {0: 1e-3, 1: 0.0254, 2: 0.3048, 4: 1e-3, 5: 1e-2, 6: 1.0}
"""Metres by the number of $INSUNITS; a drawing without one is in millimetres."""
JOINED = 1e-4
"""Ends nearer than this part of the size meet."""
PLACES = 8
"""Points along a spline for each of its control points."""
Piece = list[Corner]
"""An open row of corners; the last bulge says nothing."""


def read_dxf(what: str, file: str | os.PathLike[str]) -> list[Corner]:
    """Return the path of the one closed curve of a drawing (m). Raises ModelError for a file without one."""
    try:
        text = Path(file).read_text(encoding="utf-8", errors="replace")
    except OSError as error:
        raise ModelError(f"{what}: the drawing {file} cannot be read: {error.strerror}") from error
    pairs = list(_pairs(text))
    if not any(pair == (0, "SECTION") for pair in pairs):
        raise ModelError(f"{what}: {file} is no ASCII DXF drawing; export it as DXF R12 or R2000")
    unit = UNITS.get(_units(pairs), 1e-3)
    pieces: list[Piece] = []
    for kind, groups in _entities(pairs):
        try:
            piece = _piece(kind, groups)
        except (ValueError, KeyError, IndexError, StopIteration) as error:
            raise ModelError(f"{what}: {file}: a {kind} of the drawing is damaged; export it again") from error
        if piece:
            pieces.append([(x * unit, y * unit, bulge) for x, y, bulge in piece])
    if not pieces:
        raise ModelError(f"{what}: {file} has no lines, arcs or polylines; draw one closed curve of these")
    return _chained(what, file, pieces)


def _pairs(text: str) -> Iterator[tuple[int, str]]:
    lines = text.splitlines()
    for code, value in zip(lines[::2], lines[1::2], strict=False):
        try:
            yield int(code), value.strip()
        except ValueError:
            return


def _units(pairs: list[tuple[int, str]]) -> int:
    for k, pair in enumerate(pairs[:-1]):
        if pair == (9, "$INSUNITS"):
            return int(pairs[k + 1][1]) if pairs[k + 1][1].isdigit() else 0
    return 0


def _entities(pairs: list[tuple[int, str]]) -> Iterator[tuple[str, list[tuple[int, str]]]]:
    """Yield kind and groups of each entity; the vertices of a POLYLINE belong to it."""
    inside, kind, groups = False, "", []
    for k, (code, value) in enumerate(pairs):
        if code == 2 and value == "ENTITIES" and k and pairs[k - 1] == (0, "SECTION"):
            inside = True
        elif inside and code == 0:
            if kind == "POLYLINE" and value == "VERTEX":
                groups.append((0, value))
                continue
            if kind:
                yield kind, groups
            if value == "ENDSEC":
                return
            kind, groups = ("" if value == "SEQEND" else value), []
        elif inside and kind:
            groups.append((code, value))


def _piece(kind: str, groups: list[tuple[int, str]]) -> Piece:
    """Return the corners of an entity; none of one that is no curve."""
    numbers = {code: float(value) for code, value in groups if 10 <= code < 60}
    if kind == "LINE":
        return [(numbers[10], numbers[20], 0.0), (numbers[11], numbers[21], 0.0)]
    if kind == "CIRCLE":
        x, y, radius = numbers[10], numbers[20], numbers[40]
        return [(x + radius, y, 1.0), (x - radius, y, 1.0), (x + radius, y, 0.0)]
    if kind == "ARC":
        first, last = math.radians(numbers[50]), math.radians(numbers[51])
        sweep = (last - first) % (2 * math.pi) or 2 * math.pi
        x, y, radius = numbers[10], numbers[20], numbers[40]
        half = math.tan(sweep / 8)
        angles = (first, first + sweep / 2, first + sweep)
        return [(x + radius * math.cos(a), y + radius * math.sin(a), half) for a in angles]
    if kind in ("LWPOLYLINE", "POLYLINE"):
        return _polyline(kind, groups)
    if kind == "SPLINE":
        return spline_corners(_spline_points(groups), False, None)
    return []


def _spline_points(groups: list[tuple[int, str]]) -> np.ndarray:
    """Return (k, 2) the fit points of a spline, or points along it where it has control points alone."""
    fit, control = (
        np.array([float(value) for code, value in groups if code in codes]).reshape(-1, 2)
        for codes in ((11, 21), (10, 20))
    )
    if len(fit):
        return fit
    from scipy.interpolate import BSpline

    degree = next(int(value) for code, value in groups if code == 71)
    knots = [float(value) for code, value in groups if code == 40]
    ends = knots[degree], knots[-degree - 1]
    return BSpline(knots, control, degree)(np.linspace(*ends, PLACES * len(control) + 1))


def _polyline(kind: str, groups: list[tuple[int, str]]) -> Piece:
    flags = next((int(value) for code, value in groups if code == 70), 0)
    corners: list[list[float]] = []
    heads = kind == "LWPOLYLINE"
    for code, value in groups:
        if code == 0:
            heads = True
        elif heads and code == 10:
            corners.append([float(value), 0.0, 0.0])
        elif heads and corners and code == 20:
            corners[-1][1] = float(value)
        elif heads and corners and code == 42:
            corners[-1][2] = float(value)
    if flags & 1 and corners:
        corners.append([corners[0][0], corners[0][1], 0.0])
    return [(x, y, bulge) for x, y, bulge in corners]


def _chained(what: str, file: str | os.PathLike[str], pieces: list[Piece]) -> list[Corner]:
    """Return one closed row of all pieces. Raises ModelError for open ends or several curves."""
    xs = [x for piece in pieces for x, _, _ in piece]
    ys = [y for piece in pieces for _, y, _ in piece]
    near = JOINED * math.hypot(max(xs) - min(xs), max(ys) - min(ys))
    row, left = list(pieces[0]), pieces[1:]
    while left and math.dist(row[0][:2], row[-1][:2]) > near:
        end = row[-1][:2]
        reach = [min(math.dist(end, piece[0][:2]), math.dist(end, piece[-1][:2])) for piece in left]
        nearest = reach.index(min(reach))
        if reach[nearest] > near:
            raise ModelError(
                f"{what}: {file}: the curve is open at ({end[0]:.6g}, {end[1]:.6g}) m, where the next end is "
                f"{min(reach[nearest], math.dist(end, row[0][:2])):.3g} m away; join the ends in the drawing"
            )
        piece = left.pop(nearest)
        if math.dist(end, piece[0][:2]) > math.dist(end, piece[-1][:2]):
            piece = _reversed(piece)
        row[-1:] = piece
    gap = math.dist(row[0][:2], row[-1][:2])
    if gap > near:
        raise ModelError(
            f"{what}: {file}: the curve is open: its ends ({row[0][0]:.6g}, {row[0][1]:.6g}) m and "
            f"({row[-1][0]:.6g}, {row[-1][1]:.6g}) m are {gap:.3g} m apart; join them in the drawing"
        )
    if left:
        raise ModelError(
            f"{what}: {file} has {len(left)} pieces beside its first closed curve; an outline is one curve: save each "
            "in a drawing of its own, holes too"
        )
    return list(row[:-1])


def _reversed(piece: Piece) -> Piece:
    points = list(reversed(piece))
    bulges = [-bulge for _, _, bulge in reversed(piece[:-1])]
    return [(x, y, bulge) for (x, y, _), bulge in zip(points, [*bulges, 0.0], strict=True)]
