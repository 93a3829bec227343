"""Engraving as a milling cutter does it: strokes of one width, one depth, round ends.

The letters are drawn here and not taken from a font, so that the same bytes come out on every machine.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import cadquery as cq

from shared.shapes import outline

Stroke = list[tuple[float, ...]]

LETTERS: dict[str, list[Stroke]] = {
    # strokes in a box 1 high, none touching itself unless it is a closed ring; an entry of four numbers is an arc,
    # through a point to its end
    "A": [[(0.0, 0.0), (0.36, 1.0), (0.72, 0.0)], [(0.14, 0.36), (0.58, 0.36)]],
    "B": [
        [(0.0, 0.0), (0.0, 1.0)],
        [(0.0, 1.0), (0.32, 1.0), (0.55, 0.77, 0.32, 0.54), (0.0, 0.54)],
        [(0.32, 0.54), (0.59, 0.27, 0.32, 0.0), (0.0, 0.0)],
    ],
    "C": [[(0.66, 0.86), (0.0, 0.5, 0.66, 0.14)]],
    "D": [[(0.0, 0.0), (0.0, 1.0)], [(0.0, 1.0), (0.2, 1.0), (0.68, 0.5, 0.2, 0.0), (0.0, 0.0)]],
    "E": [[(0.52, 1.0), (0.0, 1.0), (0.0, 0.0), (0.52, 0.0)], [(0.0, 0.52), (0.42, 0.52)]],
    "F": [[(0.52, 1.0), (0.0, 1.0), (0.0, 0.0)], [(0.0, 0.52), (0.42, 0.52)]],
    "G": [[(0.66, 0.86), (0.0, 0.5, 0.66, 0.14), (0.66, 0.48), (0.40, 0.48)]],
    "O": [[(0.36, 0.0), (0.72, 0.5, 0.36, 1.0), (0.0, 0.5, 0.36, 0.0)]],
    "P": [[(0.0, 0.0), (0.0, 1.0)], [(0.0, 1.0), (0.32, 1.0), (0.59, 0.735, 0.32, 0.47), (0.0, 0.47)]],
    "0": [[(0.28, 0.0), (0.56, 0.5, 0.28, 1.0), (0.0, 0.5, 0.28, 0.0)]],
    "1": [[(0.0, 0.78), (0.22, 1.0), (0.22, 0.0)]],
    "2": [[(0.03, 0.76), (0.29, 1.0, 0.50, 0.62), (0.0, 0.0), (0.56, 0.0)]],
    "3": [[(0.02, 0.82), (0.52, 0.76, 0.22, 0.54)], [(0.22, 0.54), (0.56, 0.24, 0.0, 0.16)]],
    "4": [[(0.40, 0.0), (0.40, 1.0)], [(0.40, 1.0), (0.0, 0.3), (0.58, 0.3)]],
    "5": [[(0.50, 1.0), (0.09, 1.0), (0.04, 0.56), (0.56, 0.31, 0.0, 0.1)]],
    "6": [[(0.28, 0.0), (0.54, 0.27, 0.28, 0.54), (0.02, 0.27, 0.28, 0.0)], [(0.06, 0.36), (0.15, 0.72, 0.44, 1.0)]],
    "7": [[(0.0, 1.0), (0.54, 1.0), (0.16, 0.0)]],
    "8": [[(0.28, 0.0), (0.56, 0.27, 0.28, 0.54), (0.0, 0.27, 0.28, 0.0)], [(0.15, 0.55), (0.28, 1.0, 0.41, 0.55)]],
    "9": [[(0.28, 0.46), (0.54, 0.73, 0.28, 1.0), (0.02, 0.73, 0.28, 0.46)], [(0.50, 0.64), (0.41, 0.28, 0.12, 0.0)]],
}


def text(
    word: str, height: float, x: float, y: float, turn: float = 0.0, width: float = 0.0, spacing: float = 0.4
) -> list[cq.Face]:
    """Return the strokes of ``word``, its middle at (x, y), turned by ``turn`` degrees.

    ``height`` of the letters and ``width`` of the cutter in mm (by default a sixth of the height).
    Raises ValueError for a letter that is not in :data:`LETTERS`.
    """
    width = width or height / 6
    faces, cursor = [], 0.0
    for letter in word:
        if letter not in LETTERS:
            raise ValueError(f"cannot engrave {letter!r}; there are strokes for {''.join(LETTERS)}")
        strokes = LETTERS[letter]
        faces += [_stroke(stroke, height, cursor * height, width) for stroke in strokes]
        cursor += max(max(entry[0::2]) for stroke in strokes for entry in stroke) + spacing
    middle = (cursor - spacing) * height / 2
    shift = cq.Location(cq.Vector(x, y, 0), cq.Vector(0, 0, 1), turn) * cq.Location(cq.Vector(-middle, -height / 2, 0))
    return [face.moved(shift) for face in faces]


def rule(
    length: float, x: float, y: float, marks: tuple[float, float] = (2.0, 3.6), width: float = 0.5, step: float = 5.0
) -> list[cq.Face]:
    """Return strokes of a scale along +x from (x, y), one every ``step`` mm.

    Strokes point towards +y; every other one is long.
    """
    faces = []
    for i in range(math.floor(length / step + 1e-9) + 1):
        reach = marks[1] if i % 2 == 0 else marks[0]
        faces.append(groove((x + step * i, y), (x + step * i, y + reach), width))
    return faces


def dial(x: float, y: float, radius: float, step: float, marks: tuple[float, float] = (1.8, 3.6)) -> list[cq.Face]:
    """Return strokes outwards from ``radius`` round (x, y), one every ``step`` degrees.

    One every 30 degrees is long.
    """
    faces = []
    for i in range(round(360 / step)):
        angle = math.radians(i * step)
        reach = radius + (marks[1] if (i * step) % 30 == 0 else marks[0])
        c, s = math.cos(angle), math.sin(angle)
        faces.append(groove((x + radius * c, y + radius * s), (x + reach * c, y + reach * s), 0.5))
    return faces


def groove(start: tuple[float, float], end: tuple[float, float], width: float) -> cq.Face:
    """Return one straight stroke with round ends."""
    return cq.Face.makeFromWires(outline.hull([(*start, width / 2), (*end, width / 2)]))


def engraved(shape: cq.Workplane, strokes: Sequence[cq.Face], z: float, depth: float = 0.4) -> cq.Workplane:
    """Cut the strokes ``depth`` mm into the face at height ``z``, without any through hole."""
    up = cq.Vector(0, 0, depth + 0.5)
    for group in _apart(strokes):
        tools = [cq.Solid.extrudeLinear(s.translate(cq.Vector(0, 0, z - depth)), up) for s in group]
        shape = shape.newObject([shape.val().cut(*tools)])  # type: ignore[union-attr]
    return shape


def _apart(strokes: Sequence[cq.Face]) -> list[list[cq.Face]]:
    """Return few groups of strokes that do not overlap.

    One cut with tools that overlap each other may tear the face.
    """
    groups: list[list[tuple[cq.Face, cq.BoundBox]]] = []
    for stroke in strokes:
        box = stroke.BoundingBox()
        for group in groups:
            if not any(_overlap(box, other) for _, other in group):
                group.append((stroke, box))
                break
        else:
            groups.append([(stroke, box)])
    return [[stroke for stroke, _ in group] for group in groups]


def _overlap(a: cq.BoundBox, b: cq.BoundBox) -> bool:
    return a.xmin < b.xmax and b.xmin < a.xmax and a.ymin < b.ymax and b.ymin < a.ymax


def _stroke(stroke: Stroke, height: float, shift: float, width: float) -> cq.Face:
    def place(u: float, v: float) -> cq.Vector:
        return cq.Vector(u * height + shift, v * height, 0)

    points = [place(*entry[-2:]) for entry in stroke]
    if len(stroke) == 2 and len(stroke[1]) == 2:
        return groove((points[0].x, points[0].y), (points[1].x, points[1].y), width)
    edges = []
    for before, entry, after in zip(points, stroke[1:], points[1:], strict=False):
        if len(entry) == 2:
            edges.append(cq.Edge.makeLine(before, after))
        else:
            edges.append(cq.Edge.makeThreePointArc(before, place(*entry[:2]), after))
    line = cq.Wire.assembleEdges(edges)
    outer = line.offset2D(width / 2, "arc")[0]
    return cq.Face.makeFromWires(outer, line.offset2D(-width / 2, "arc") if line.IsClosed() else [])
