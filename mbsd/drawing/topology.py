"""Topology as SVG: bodies as boxes, joints, drivers and forces between them, redundant ones in red.

A kind without a sign of its own gets a diamond; drivers a turning or a straight arrow, forces a zigzag. Numbers in SVG
are given to a tenth of a pixel, so that equal diagrams are equal bytes.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from html import escape

import numpy as np

from mbsd.base.errors import AssemblyError, ModelError
from mbsd.base.quantity import counted, written
from mbsd.drawing import look
from mbsd.drawing.graph_layout import layout
from mbsd.drawing.look import PAPER
from mbsd.model.force import Force, ForceKind
from mbsd.model.joint import Joint
from mbsd.model.mechanism import Model
from mbsd.pictures import Svg
from mbsd.results.views import Mobility

MOST_NODES = 600
"""Bodies, joints and drivers that one diagram can show."""
EDGE = 74.0
"""Distance from a body to a joint (px)."""
BODY_HEIGHT, JOINT = 40.0, 15.0
MARGIN, HEADING = 26.0, 58.0
FONT = "DejaVu Sans, Verdana, sans-serif"


@dataclass(frozen=True)
class Node:
    """A body, or a joint or driver, with the room its symbol and words take (px)."""

    name: str
    below: str
    """Second line: mass or kind."""
    kind: str
    """Kind of the joint; "body" or "ground"."""
    colour: str
    size: tuple[float, float]


def topology(m: Model) -> Svg:
    """See :meth:`mbsd.mechanism.Mechanism.topology`."""
    joints = [*m.joints.values(), *m.drivers.values(), *m.forces.values()]
    if len(m.bodies) + len(joints) > MOST_NODES:
        raise ModelError(
            f"{m.name}: {len(m.bodies) + len(joints)} bodies, joints and drivers are too many for one diagram "
            f"(at most {MOST_NODES}); print(m.mobility()) has the counts"
        )
    mobility, said = _mobility(m)
    redundant = set(mobility.redundant) if mobility else set()
    nodes = [_body(m, name, k) for k, name in enumerate(m.bodies)]
    nodes += [_joint(j, j.name in redundant) for j in joints]
    number = {name: k for k, name in enumerate(m.bodies)}
    edges = [(number[name], len(number) + k) for k, joint in enumerate(joints) for name in dict.fromkeys(joint.bodies)]
    places = layout(edges, np.array([node.size for node in nodes]), EDGE) * np.array([1.0, -1.0])
    return Svg(_svg(m.name, said, nodes, edges, places, redundant))


def _mobility(m: Model) -> tuple[Mobility | None, str]:
    if len(m.bodies) < 2 or not m.joints:
        return None, f"{3 * (len(m.bodies) - 1)} degrees of freedom, no joints"
    try:
        mobility = m.mobility()
    except AssemblyError:
        return None, "the links do not close, so freedoms and redundant joints are unknown"
    count = len(m.drivers)
    return mobility, f"{mobility}; {counted(count, 'driver')}"


def _body(m: Model, name: str, k: int) -> Node:
    if name == "ground":
        return Node(name, "", "ground", look.INK, (max(84.0, _width(name, 13) + 30), BODY_HEIGHT + 16))
    mass = m.bodies[name].mass
    below = f"{written(mass, 'kg')}" if mass else "no mass"
    width = max(_width(name, 13), _width(below, 10)) + 30
    return Node(name, below, "body", look.colour(k - 1), (width, BODY_HEIGHT + 12))


def _joint(joint: Joint | Force, redundant: bool) -> Node:
    name = joint.name
    words = joint.kind.name.replace("_", " ")
    below = f"{words}, redundant" if redundant else words
    colour = look.LOAD if isinstance(joint, Force) else look.MOVED if joint.kind.driven else look.INK
    colour = look.WRONG if redundant else colour
    width = max(2 * JOINT, _width(name, 12), _width(below, 9.5))
    return Node(name, below, sign_of(joint), colour, (width + 12, 2 * JOINT + 34))


def _width(text: str, size: float) -> float:
    """Return about the width of a text in a wide sans serif (px)."""
    return 0.62 * size * len(text)


def _svg(
    name: str, said: str, nodes: list[Node], edges: list[tuple[int, int]], places: np.ndarray, redundant: set[str]
) -> str:
    sizes = np.array([node.size for node in nodes])
    low = (places - sizes / 2).min(axis=0) - MARGIN
    high = (places + sizes / 2).max(axis=0) + MARGIN
    width = max(high[0] - low[0], _width(said, 11) + 2 * MARGIN, _width(name, 17) + 2 * MARGIN)
    places = places - low + np.array([(width - (high[0] - low[0])) / 2, HEADING])
    height = high[1] - low[1] + HEADING
    out = [
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{width:.0f}" height="{height:.0f}" '
        f'viewBox="0 0 {width:.0f} {height:.0f}" font-family="{FONT}">',
        tag("rect", width="100%", height="100%", fill=look.PAPER, stroke="none"),
        _text(MARGIN, 32, name.replace("_", " "), 17, look.INK, "start", bold=True),
        _text(MARGIN, 51, said, 11, look.QUIET, "start"),
    ]
    for a, b in edges:
        (x1, y1), (x2, y2) = places[a], _middle(nodes[b], places[b])
        ink = look.WRONG if nodes[b].name in redundant else look.QUIET
        loose = {"stroke_dasharray": "1.5 3.5", "stroke_linecap": "round"} if nodes[b].colour == look.LOAD else {}
        dashes = {"stroke_dasharray": "5 4"} if nodes[b].name in redundant else loose
        out.append(tag("line", x1=x1, y1=y1, x2=x2, y2=y2, stroke=ink, stroke_width=1.6, **dashes))
    for node, place in zip(nodes, places, strict=True):
        out += _drawn_body(node, place) if node.kind in ("body", "ground") else _drawn_joint(node, place)
    return "\n".join([*out, "</svg>"]) + "\n"


def _middle(node: Node, place: np.ndarray) -> np.ndarray:
    """Return the middle of a joint's symbol; its words are below."""
    return place - np.array([0.0, node.size[1] / 2 - JOINT - 2])


def _drawn_body(node: Node, place: np.ndarray) -> list[str]:
    x, y = place
    half, foot = node.size[0] / 2 - 4, y + BODY_HEIGHT / 2
    fill = look.FAINT if node.kind == "ground" else look.PAPER
    box = {"x": x - half, "y": y - BODY_HEIGHT / 2, "width": 2 * half, "height": BODY_HEIGHT, "rx": 7.0}
    out = [tag("rect", **box, fill=fill, stroke=node.colour, stroke_width=1.8)]
    if node.kind == "ground":
        strokes = [d("M", left, foot + 1, "l -6 8") for left in np.arange(x - half + 12, x + half - 2, 9)]
        out.append(tag("path", d=" ".join(strokes), stroke=look.INK, stroke_width=1.2, fill="none"))
    if node.below:
        out.append(_text(x, y + 13, node.below, 10, look.QUIET))
    return [*out, _text(x, y - 2 if node.below else y + 5, node.name, 13, node.colour, bold=True)]


def _drawn_joint(node: Node, place: np.ndarray) -> list[str]:
    x, y = _middle(node, place)
    half = node.size[0] / 2 - 3
    paper = {"fill": look.PAPER, "fill_opacity": "0.85", "stroke": "none"}
    return [
        tag("rect", x=x - half, y=y + JOINT + 1, width=2 * half, height=29.0, rx=4.0, **paper),
        *icon(node.kind, float(x), float(y), JOINT, node.colour),
        _text(x, y + JOINT + 13, node.name, 12, node.colour, bold=True),
        _text(x, y + JOINT + 26, node.below, 9.5, look.QUIET),
    ]


def _text(x: float, y: float, text: str, size: float, colour: str, anchor: str = "middle", bold: bool = False) -> str:
    weight = {"font_weight": "bold"} if bold else {}
    return tag("text", text, x=x, y=y, font_size=size, fill=colour, stroke="none", text_anchor=anchor, **weight)


STROKE = 1.8


def tag(name: str, content: str | None = None, **attributes: str | float) -> str:
    """Return an element; underscores in the names of attributes stand for hyphens."""
    parts = [f'{key.replace("_", "-")}="{_value(value)}"' for key, value in attributes.items()]
    opening = f"<{' '.join([name, *parts])}"
    return f"{opening}/>" if content is None else f"{opening}>{escape(content)}</{name}>"


def d(*parts: str | float) -> str:
    """Return the data of a path: commands and numbers."""
    return " ".join(part if isinstance(part, str) else _value(part) for part in parts)


def _value(value: str | float) -> str:
    if isinstance(value, str):
        return escape(value)
    text = f"{float(value):.1f}".removesuffix(".0")
    return "0" if text == "-0" else text


def icon(sign: str, x: float, y: float, radius: float, colour: str) -> list[str]:
    """Return the sign of a kind within ``radius`` (px) of (x, y); see :func:`sign_of`."""
    return [_disc(x, y, radius - 1, colour), *ICONS.get(sign, _diamond)(x, y, radius, colour)]


def sign_of(connection: Joint | Force) -> str:
    """Return the sign of a joint, driver or force in ICONS."""
    if isinstance(connection.kind, ForceKind):
        return "force"
    if connection.kind.driven:
        return "turning" if connection.kind.angular else "pushing"
    return connection.kind.drawn_as


def _revolute(x: float, y: float, r: float, colour: str) -> list[str]:
    return [_disc(x, y, 0.34 * r, colour)]


def _prismatic(x: float, y: float, r: float, colour: str) -> list[str]:
    block = _box(x, y - 0.02 * r, 0.42 * r, 0.3 * r, colour)
    return [_stroke(d("M", x - 0.7 * r, y + 0.36 * r, "h", 1.4 * r), colour), block]


def _pin_in_slot(x: float, y: float, r: float, colour: str) -> list[str]:
    slot = _box(x, y, 0.66 * r, 0.32 * r, colour, rx=0.32 * r)
    return [slot, _disc(x, y, 0.13 * r, colour, fill=colour)]


def _weld(x: float, y: float, r: float, colour: str) -> list[str]:
    return [_box(x, y, 0.34 * r, 0.34 * r, colour, fill=colour)]


def _distance(x: float, y: float, r: float, colour: str) -> list[str]:
    ends = [_disc(x + side * 0.48 * r, y, 0.16 * r, colour) for side in (-1, 1)]
    return [_stroke(d("M", x - 0.48 * r, y, "h", 0.96 * r), colour), *ends]


def _wheels(x: float, y: float, r: float, colour: str) -> list[str]:
    return [_disc(x - 0.26 * r, y, 0.3 * r, colour), _disc(x + 0.3 * r, y, 0.22 * r, colour)]


def _force(x: float, y: float, r: float, colour: str) -> list[str]:
    return [_stroke(d("M", x - 0.72 * r, y, "h", 0.2 * r, *_zigzag(r), "h", 0.2 * r), colour)]


def _diamond(x: float, y: float, r: float, colour: str) -> list[str]:
    """Return the icon of a kind without a sign."""
    half = 0.5 * r
    return [_stroke(d("M", x - half, y, "l", half, -half, "l", half, half, "l", -half, half, "z"), colour)]


def _zigzag(r: float) -> list[str | float]:
    up, step = 0.36 * r, 0.26 * r
    return ["l", step / 2, -up, "l", step, 2 * up, "l", step, -2 * up, "l", step, 2 * up, "l", step / 2, -up]


def _turning(x: float, y: float, r: float, colour: str) -> list[str]:
    """Return three quarters of a turn, counter-clockwise, with its head."""
    q = 0.5 * r
    arc = d("M", x, y + q, "A", q, q, "0 1 0", x - q, y)
    head = d("M", x - q, y + 0.3 * r, "l", -0.26 * r, -0.4 * r, "h", 0.52 * r, "z")
    return [_stroke(arc, colour), _filled(head, colour)]


def _pushing(x: float, y: float, r: float, colour: str) -> list[str]:
    """Return a straight arrow."""
    head = d("M", x + 0.64 * r, y, "l", -0.46 * r, -0.3 * r, "v", 0.6 * r, "z")
    return [_stroke(d("M", x - 0.6 * r, y, "h", 0.8 * r), colour), _filled(head, colour)]


def _disc(x: float, y: float, radius: float, colour: str, fill: str = PAPER) -> str:
    return tag("circle", cx=x, cy=y, r=radius, fill=fill, stroke=colour, stroke_width=STROKE)


def _box(
    x: float, y: float, half_width: float, half_height: float, colour: str, fill: str = PAPER, rx: float = 0.0
) -> str:
    return tag(
        "rect", x=x - half_width, y=y - half_height, width=2 * half_width, height=2 * half_height, rx=rx,
        fill=fill, stroke=colour, stroke_width=STROKE,
    )  # fmt: skip


def _stroke(path: str, colour: str) -> str:
    return tag("path", d=path, fill="none", stroke=colour, stroke_width=STROKE, stroke_linecap="round")


def _filled(path: str, colour: str) -> str:
    return tag("path", d=path, fill=colour, stroke="none")


ICONS: dict[str, Callable[[float, float, float, str], list[str]]] = {
    "revolute": _revolute,
    "prismatic": _prismatic,
    "pin_in_slot": _pin_in_slot,
    "weld": _weld,
    "distance": _distance,
    "gear_pair": _wheels,
    "belt": _wheels,
    "turning": _turning,
    "pushing": _pushing,
    "force": _force,
}
