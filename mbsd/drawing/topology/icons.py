"""Small signs of the joint kinds for the topology diagram, as SVG elements about a centre.

A kind without a sign of its own gets a diamond; drivers a turning or a straight arrow, forces a zigzag. Numbers in SVG
are given to a tenth of a pixel, so that equal diagrams are equal bytes.
"""

from __future__ import annotations

from collections.abc import Callable
from html import escape

from mbsd.drawing.look import PAPER
from mbsd.model.force import Force, ForceKind
from mbsd.model.joint import Joint

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
    """The sign of a kind within ``radius`` (px) of (x, y); see :func:`sign_of`."""
    return [_disc(x, y, radius - 1, colour), *ICONS.get(sign, _diamond)(x, y, radius, colour)]


def sign_of(connection: Joint | Force) -> str:
    """The sign of a joint, driver or force in ICONS."""
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
    """Icon of a kind without a sign."""
    half = 0.5 * r
    return [_stroke(d("M", x - half, y, "l", half, -half, "l", half, half, "l", -half, half, "z"), colour)]


def _zigzag(r: float) -> list[str | float]:
    up, step = 0.36 * r, 0.26 * r
    return ["l", step / 2, -up, "l", step, 2 * up, "l", step, -2 * up, "l", step, 2 * up, "l", step / 2, -up]


def _turning(x: float, y: float, r: float, colour: str) -> list[str]:
    """Three quarters of a turn, counter-clockwise, with its head."""
    q = 0.5 * r
    arc = d("M", x, y + q, "A", q, q, "0 1 0", x - q, y)
    head = d("M", x - q, y + 0.3 * r, "l", -0.26 * r, -0.4 * r, "h", 0.52 * r, "z")
    return [_stroke(arc, colour), _filled(head, colour)]


def _pushing(x: float, y: float, r: float, colour: str) -> list[str]:
    """A straight arrow."""
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
