"""A pose and the paths of traced points as drawings in millimetres: SVG and DXF, one to one."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any
from xml.etree.ElementTree import Element, SubElement, indent, tostring

import numpy as np

from mechanisms.stages.dxf_file import Layers, text_of, without_times

MM = 1000.0
MARGIN = 0.05
"""Margin around the drawing, as a part of its size."""


def pose_of(solution: Any, time: float) -> tuple[list[Any], dict[str, np.ndarray]]:
    """Return the skeleton's strokes at the output nearest to a time (s), and paths of traced points.

    The path of each point is (k, 2) in m.
    """
    from mbsd.drawing.strokes import strokes_of

    step = int(np.abs(solution.t - time).argmin())
    paths = {
        name: np.column_stack([view.x, view.y]) for name in solution.mechanism.traces for view in [solution.point(name)]
    }
    return strokes_of(solution, [step])[0].strokes, paths


def svg(solution: Any, time: float) -> str:
    """Return the drawing as SVG."""
    strokes, paths = pose_of(solution, time)
    points = np.concatenate([*(stroke.points for stroke in strokes), *paths.values()]) * MM
    low, high = points.min(axis=0), points.max(axis=0)
    margin = MARGIN * max(high - low)
    width, height = high - low + 2 * margin
    root = Element("svg", xmlns="http://www.w3.org/2000/svg", width=f"{width:.3f}mm", height=f"{height:.3f}mm",
                   viewBox=f"0 0 {width:.3f} {height:.3f}")  # fmt: skip
    SubElement(root, "title").text = solution.mechanism.name
    thin = max(width, height) / 500

    def flat(line: np.ndarray) -> str:
        return " ".join(f"{x - low[0] + margin:.3f},{high[1] - y + margin:.3f}" for x, y in line * MM)

    for name, path in paths.items():
        line = SubElement(root, "polyline", points=flat(path), fill="none", stroke="#b5651d")
        line.set("stroke-width", f"{thin:.3f}")
        SubElement(line, "title").text = name
    colours = _colours(solution)
    for stroke in sorted(strokes, key=lambda drawn: drawn.order):
        fill = "none" if stroke.fill is None else colours[stroke.fill]
        words = {"points": flat(stroke.points), "fill": fill, "stroke": colours[stroke.ink]}
        line = SubElement(root, "polygon" if stroke.closed else "polyline", words)
        if stroke.alpha < 1.0:
            line.set("stroke-opacity" if stroke.fill is None else "fill-opacity", f"{stroke.alpha:.3g}")
        line.set("stroke-width", f"{thin * stroke.width / 1.4:.3f}")
        if stroke.dash:
            line.set("stroke-dasharray", " ".join(f"{part * thin:.3f}" for part in stroke.dash))
    indent(root)
    return tostring(root, encoding="unicode") + "\n"


def _colours(solution: Any) -> dict[str, str]:
    """Return the colour of each role in a drawing; bodies have that of all pictures."""
    from mbsd.drawing.look import body_inks
    from mbsd.drawing.strokes import ROLES

    bodies = {f"body:{name}": ink for name, ink in body_inks(solution.mechanism).items()}
    return {role: colour for colour, role in ROLES.items()} | bodies


def dxf(solution: Any, time: float) -> str:
    """Return the drawing as DXF (R2010): each body, ground and the paths on a layer of its own."""
    from ezdxf.filemanagement import new

    strokes, paths = pose_of(solution, time)
    with without_times():
        document = new("R2010", units=4)
    space, layers = document.modelspace(), Layers(document)

    def line(layer: str, points: Iterable[Any], closed: bool) -> None:
        space.add_lwpolyline([(float(x), float(y)) for x, y in points], close=closed, dxfattribs={"layer": layer})

    for stroke in strokes:
        carrier = stroke.carrier
        if carrier is not None and carrier.kind == "ground":
            layer = layers.named("ground")
        elif stroke.ink.startswith("body:"):
            layer = layers.named(stroke.ink.removeprefix("body:"), "body")
        else:
            layer = layers.named("signs")
        line(layer, stroke.points * MM, stroke.closed)
    for name, path in paths.items():
        line(layers.named(f"path {name}", "path"), path * MM, False)
    return text_of(document)
