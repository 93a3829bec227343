"""Sketches in DXF: circles are pins, lines from pin to pin are links.

A pin is of the ground where its circle is on a layer ``ground``, or where two circles share a centre; on a layer
``motor`` it turns the first link on it. A polyline is one link with a pin at each of its corners that has one; so are
lines that share pins on one layer other than 0. A line ends at a pin if it ends within its circle.
"""

from __future__ import annotations

import io
import math
from dataclasses import dataclass, field
from itertools import pairwise
from typing import Any

from shared.contract.quantity import counted
from shared.stage.errors import UserError
from studio.imports.limits import check_count, check_length
from studio.imports.sketch import GROUND, Motor, Place, Sketch

FRAME, MOTOR = "ground", "motor"
"""Layers that say what a circle or a line is of."""
UNITS = {0: 0.001, 1: 0.0254, 2: 0.3048, 4: 0.001, 5: 0.01, 6: 1.0, 14: 0.1}
"""m, by the number of $INSUNITS: none (taken for millimetres), inch, foot, mm, cm, m, dm."""
SPEED = math.tau
"""rad/s"""
LETTERS = "ABCDEFGHIJKLMNOPQRSTUVWXYZ"
SAME = 1e-6
"""Circles whose centres are closer than this part of their radius are of one pin."""
MOST_CORNERS = 20_000


@dataclass
class _Circle:
    place: Place
    radius: float
    layer: str


@dataclass
class _Line:
    corners: list[Place]
    layer: str


@dataclass
class _Drawing:
    """Entities of a file (m); ``unit`` is the number of its unit, ``kinds`` the types of all entities."""

    unit: int
    circles: list[_Circle] = field(default_factory=list)
    lines: list[_Line] = field(default_factory=list)
    kinds: list[str] = field(default_factory=list)


@dataclass
class _Pin:
    place: Place
    radius: float
    layers: set[str]
    rings: int = 1
    name: str = ""

    @property
    def grounded(self) -> bool:
        return self.rings > 1 or FRAME in self.layers or MOTOR in self.layers


@dataclass
class _Link:
    layer: str
    pins: list[_Pin] = field(default_factory=list)


def is_dxf(text: str) -> bool:
    """True if a text is such a file."""
    lines = [line.strip() for line in text[:2000].splitlines()[:400]]
    return any(a == "0" and b == "SECTION" for a, b in pairwise(lines))


def read(text: str, name: str) -> Sketch:
    """Return the mechanism of such a file.

    Raises UserError if it cannot be read or has no pins or links.
    """
    drawn = _drawn(text)
    check_count(drawn.circles, "circles")
    if sum(len(line.corners) for line in drawn.lines) > MOST_CORNERS:
        raise UserError(f"its lines have more than {MOST_CORNERS} corners; no sketch of a mechanism has so many")
    sketch = Sketch(name, "a DXF sketch")
    if drawn.unit not in UNITS or drawn.unit == 0:
        sketch.unit = "a millimetre"
    pins = _pins(drawn.circles)
    links = _links(drawn.lines, pins, sketch)
    if not pins or not links:
        there = ", ".join(f"{drawn.kinds.count(kind)} {kind}" for kind in sorted(set(drawn.kinds)))
        raise UserError(
            f"a sketch has circles as pins, and lines from circle to circle as links; this one has {there or 'nothing'}"
        )
    _join(sketch, pins, links)
    return sketch


def _drawn(text: str) -> _Drawing:
    """Return the entities of the model space (m). Raises UserError if ezdxf cannot read it."""
    from ezdxf.filemanagement import read as parsed

    check_length(text)
    try:
        document = parsed(io.StringIO(text.replace("\r\n", "\n")))
        number = int(document.header.get("$INSUNITS", 0))
        unit, drawn = UNITS.get(number, 0.001), _Drawing(number)
        for entity in document.modelspace():
            drawn.kinds.append(entity.dxftype())
            layer, corners = str(entity.dxf.get("layer", "0")).lower(), _corners(entity, unit)
            if entity.dxftype() == "CIRCLE":
                drawn.circles.append(_Circle(_flat(entity.dxf.center, unit), float(entity.dxf.radius) * unit, layer))
            elif corners:
                drawn.lines.append(_Line(corners, layer))
    except Exception as error:  # a parser of others, which raises whatever a broken file brings about
        raise UserError(f"this is not a readable DXF ({type(error).__name__}: {error})") from error
    return drawn


def _corners(entity: Any, unit: float) -> list[Place]:
    match entity.dxftype():
        case "LINE":
            return [_flat(entity.dxf.start, unit), _flat(entity.dxf.end, unit)]
        case "LWPOLYLINE":
            return [(float(x) * unit, float(y) * unit) for x, y in entity.get_points("xy")]
        case "POLYLINE":
            return [_flat(vertex.dxf.location, unit) for vertex in entity.vertices]
    return []


def _flat(point: Any, unit: float) -> Place:
    return float(point.x) * unit, float(point.y) * unit


def _pins(circles: list[_Circle]) -> list[_Pin]:
    pins: list[_Pin] = []
    for circle in circles:
        known = next(
            (pin for pin in pins if math.dist(pin.place, circle.place) <= SAME * max(circle.radius, pin.radius)), None
        )
        if known is None:
            pins.append(_Pin(circle.place, circle.radius, {circle.layer}))
        else:
            known.rings += 1
            known.radius = max(known.radius, circle.radius)
            known.layers.add(circle.layer)
    for k, pin in enumerate(pins):
        pin.name = LETTERS[k] if k < len(LETTERS) else f"P{k}"
    return pins


def _links(lines: list[_Line], pins: list[_Pin], sketch: Sketch) -> list[_Link]:
    links: list[_Link] = []
    astray = 0
    for line in lines:
        hit = list({pin.name: pin for corner in line.corners if (pin := _pin_at(corner, pins)) is not None}.values())
        if len(hit) < 2:
            astray += 1
            continue
        shared = [
            link
            for link in links
            if line.layer != "0" and link.layer == line.layer and any(pin in link.pins for pin in hit)
        ]
        merged = _Link(line.layer, [])
        for link in shared:
            links.remove(link)
            merged.pins += [pin for pin in link.pins if pin not in merged.pins]
        merged.pins += [pin for pin in hit if pin not in merged.pins]
        links.append(merged)
        check_count(links, "links")
    if astray:
        sketch.left_out.append(f"{counted(astray, 'line')} not from pin to pin")
    return links


def _pin_at(place: Place, pins: list[_Pin]) -> _Pin | None:
    near = [pin for pin in pins if math.dist(pin.place, place) <= pin.radius * (1 + SAME)]
    return min(near, key=lambda pin: math.dist(pin.place, place)) if near else None


def _join(sketch: Sketch, pins: list[_Pin], links: list[_Link]) -> None:
    names: dict[int, str] = {}
    for k, link in enumerate(links):
        fixed = link.layer == FRAME or all(pin.grounded for pin in link.pins)
        names[k] = GROUND if fixed else "".join(pin.name for pin in link.pins)
        if not fixed:
            body = sketch.link(names[k])
            for pin in link.pins:
                body.points.setdefault(pin.name, pin.place)
    for pin in pins:
        on = [names[k] for k, link in enumerate(links) if pin in link.pins]
        ground = [GROUND] if pin.grounded else []
        carriers: list[str] = list(dict.fromkeys([*ground, *on]))
        moving = [carrier for carrier in carriers if carrier != GROUND]
        if len(carriers) > 1:
            sketch.pin_all(pin.name, carriers, pin.place)
        elif moving:
            sketch.traces[pin.name] = (moving[0], pin.place)
        if MOTOR in pin.layers and moving:
            sketch.motors.append(Motor("motor" if not sketch.motors else f"motor_{pin.name}", GROUND, moving[0], SPEED))
