"""The skeleton at its start as SVG in the HTML file: seen before script, payload and WebGL are ready."""

from __future__ import annotations

from itertools import batched
from typing import Any

ACROSS = 1000.0
"""Length of the longer side of the picture; places are rounded to a tenth."""
ROOM, PAD = 0.09, 2.4
"""Part left free on each side, and beyond the machine in sizes of its symbols, as the 2D view has them
(page/src/view2d)."""
WIDTH = 1.25
"""Pixels of a line that is one point wide."""
TOLD = {"ink": "ink", "paper": "paper"}
"""Classes of style/sketch.css; all else has the ink of a body."""


def sketch(skeleton: dict[str, Any]) -> str:
    """An ``<svg>`` of what payload.skeleton says; marks that are shown on demand are left out."""
    pad = PAD * skeleton["unit"]
    low = [value - pad for value in skeleton["low"]]
    size = [high + pad - least for high, least in zip(skeleton["high"], low, strict=True)]
    scale = ACROSS * (1 - 2 * ROOM) / max(*size)
    width, height = (value * scale / (1 - 2 * ROOM) for value in size)
    left, top = ROOM * width, ROOM * height + size[1] * scale

    def path(stroke: dict[str, Any]) -> str:
        corners = (
            f"{left + scale * (float(x) - low[0]):.1f} {top - scale * (float(y) - low[1]):.1f}"
            for x, y in batched(stroke["points"], 2, strict=True)
        )
        end = "z" if stroke["closed"] else ""
        fill = f"fill-{TOLD.get(stroke['fill'], 'body')}" if stroke["fill"] else "fill-none"
        looks = [f'class="{fill} line-{TOLD.get(stroke["ink"], "body")}"']
        if stroke["fill"] and stroke["alpha"] < 1:
            looks.append(f'fill-opacity="{stroke["alpha"]:g}"')
        looks.append(f'stroke-width="{WIDTH * stroke["width"]:g}"')
        if stroke["dash"]:
            looks.append(f'stroke-dasharray="{" ".join(f"{WIDTH * dash:g}" for dash in stroke["dash"])}"')
        return f'<path {" ".join(looks)} d="M{"L".join(corners)}{end}"/>'

    paths = "".join(path(stroke) for stroke in skeleton["strokes"] if not stroke["sign"] and len(stroke["points"]))
    box = f'viewBox="0 0 {width:.1f} {height:.1f}"'
    return f'<svg class="mbsd-sketch" {box} role="img" aria-label="Skeleton">{paths}</svg>'
