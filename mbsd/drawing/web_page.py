"""The skeleton in motion as one small HTML page, from a solution alone: for notebooks, or as a file."""

from __future__ import annotations

import html
import json
import os
from dataclasses import asdict
from importlib import resources
from typing import Any

import numpy as np

from mbsd.base.arguments import finite_number
from mbsd.base.errors import ModelError
from mbsd.base.files import write_whole
from mbsd.drawing.carriers import Carrier
from mbsd.drawing.look import body_inks, on_dark
from mbsd.drawing.moving_skeleton import moving
from mbsd.pictures import View
from mbsd.results.solution import Solution

MOST = 361
"""Times of the motion that a page has, at most."""
FIGURES = 6
HEIGHT = 380
"""Pixels in a notebook."""
PAGE = """<!doctype html>
<html lang="en"><head><meta charset="utf-8"><meta name="viewport" content="width=device-width">
<title>{title}</title>
<style>
:root {{ color-scheme: light dark; }}
html, body {{ margin: 0; height: 100%; font: 13px system-ui, sans-serif; }}
body {{ display: grid; grid-template-rows: minmax(0, 1fr) auto; background: #fff; color: #20252b; }}
canvas {{ width: 100%; height: 100%; display: block; }}
div {{ display: flex; gap: 10px; align-items: center; padding: 6px 12px; border-top: 1px solid #dfe3e8; }}
button {{ width: 34px; height: 28px; border: 1px solid #9aa5b3; border-radius: 7px; background: none; color: inherit;
  cursor: pointer; }}
input {{ flex: 1; accent-color: #c2410c; }}
output {{ min-width: 62px; text-align: right; font-variant-numeric: tabular-nums; }}
@media (prefers-color-scheme: dark) {{
  body {{ background: #10141b; color: #e6e9ee; }} div {{ border-color: #252c37; }}
}}
</style></head>
<body><canvas aria-label="{title}"></canvas>
<div><button type="button"></button>
<input type="range" min="0" max="1000" step="1" aria-label="Time"><output></output></div>
<script>
{carriers}
{player}(document.body, {data});
</script></body></html>
"""


def view(sol: Solution, path: str | os.PathLike[str] | None, height: float) -> View:
    """See :meth:`mbsd.results.solution.Solution.view`."""
    height = finite_number(f"{sol.mechanism.name}: view: height (pixels)", height)
    if height < 120:
        raise ModelError(f"{sol.mechanism.name}: view: height is {height:g} pixels; give 120 or more")
    if len(sol.t) < 2:
        raise ModelError(f"{sol.mechanism.name}: the solution has one time; view() shows a motion, draw() a pose")
    carriers, player = (_script(name) for name in ("carriers.js", "player.js"))
    data = json.dumps(_data(sol), separators=(",", ":"), ensure_ascii=False).replace("</", "<\\/")
    title = html.escape(sol.mechanism.name.replace("_", " "))
    page = PAGE.format(title=title, carriers=carriers.replace("export ", ""), player=player, data=data)
    if path is not None:
        write_whole(path, page.encode())
    return View(page, round(height))


def _script(name: str) -> str:
    """Return a script of this package, as it may stand in a page."""
    return resources.files("mbsd.drawing").joinpath(name).read_text("utf-8").strip().replace("</", "<\\/")


def _data(sol: Solution) -> dict[str, Any]:
    skeleton = moving(sol)
    kept = np.unique(np.linspace(0, len(sol.t) - 1, MOST).round().astype(int))
    views = {name: sol.body(name) for name in sol.mechanism.bodies if name != "ground"}
    traces = [sol.point(name) for name in sol.mechanism.traces]
    return {
        "name": sol.mechanism.name,
        "unit": _short(skeleton.steady.unit),
        "low": _short(skeleton.steady.low),
        "high": _short(skeleton.steady.high),
        "t": _short(sol.t[kept], 10),
        "loops": sol.period is not None,
        "bodies": {
            name: [_short(values[kept], 8) for values in (view.x, view.y, view.theta)] for name, view in views.items()
        },
        "inks": {name: [ink, on_dark(ink)] for name, ink in body_inks(sol.mechanism).items()},
        "times": _short(skeleton.times, 10),
        "paths": [_short(np.stack([trace.x[kept], trace.y[kept]], axis=1).ravel()) for trace in traces],
        "strokes": [
            {
                "points": _short(carried.stroke.points.ravel()),
                "closed": carried.stroke.closed,
                "ink": carried.stroke.ink,
                "fill": carried.stroke.fill,
                "alpha": carried.stroke.alpha,
                "width": carried.stroke.width,
                "dash": list(carried.stroke.dash),
                "carrier": _carrier(carried.carrier),
                "shapes": _short(np.ravel(carried.shapes)),
            }
            for carried in sorted(skeleton.strokes, key=lambda carried: carried.stroke.order)
        ],
        "names": [
            {
                "text": label.text.replace("_", " "),
                "points": _short(label.anchor),
                "off": _short(label.clearance * skeleton.steady.unit),
                "ink": label.colour,
                "carrier": _carrier(carrier),
            }
            for label, carrier in skeleton.names
        ],
    }


def _carrier(carrier: Carrier) -> dict[str, Any]:
    return {"kind": carrier.kind, "ends": [asdict(end) for end in carrier.ends]}


def _short(values: Any, figures: int = FIGURES) -> Any:
    """Return numbers with so many figures."""
    if np.ndim(values) == 0:
        return float(f"{float(values):.{figures}g}")
    return [float(f"{value:.{figures}g}") for value in np.asarray(values, float).tolist()]
