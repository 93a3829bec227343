"""Addresses of PMKS+, whose query holds the whole mechanism in digits of base 64.

``[switches].[decimals,].[whole numbers,].[choices].joints..links..forces...check``; digits are 0-9A-Za-z-_, a leading 0
is a minus, decimals are thousandths. A joint is ``[flags]id,name,x,y`` and for a slider its angle; flags are one digit,
lowest bit first: slider, input, ground, weld, curve. A link is ``[root][R|P]id,name,mass,inertia,x,y,colour,joints,,``.
"""

from __future__ import annotations

import math
import re
from urllib.parse import unquote, urlparse

from shared.stage.errors import UserError
from studio.imports.sketch import GROUND, Motor, Place, Sketch, Slide

DIGITS = "0123456789ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz-_"
SLIDER, INPUT, FIXED, WELDED = 1, 2, 4, 8
UNIT = 0.01
"""m: PMKS+ draws in centimetres unless its user chooses others."""
SPEED = 1.0
"""rad/s"""


def is_pmks_url(text: str) -> bool:
    """Whether a text is such an address, if only the beginning of one, or its query alone."""
    first = text.strip()
    if "\n" not in first and (urlparse(first).hostname or "").endswith("pmksplus.com"):
        return True
    return "\n" not in first and first.count("..") >= 2 and re.search(r"\.Y?[RP]\w", first) is not None


def read(text: str, name: str) -> Sketch:
    """The mechanism of such an address. Raises UserError where it cannot be read."""
    query = urlparse(text.strip()).query or text.strip()
    query = unquote(query.removeprefix("mech=").removeprefix("?"))
    try:
        return _read(query, name)
    except (ValueError, IndexError, KeyError) as error:
        raise UserError(
            f"{name}: this is no address of PMKS+ that can be read ({error}); copy all of it, in quotes"
        ) from error


def _read(query: str, name: str) -> Sketch:
    head, _, rest = query.partition("..")
    links_text, _, forces = rest.partition("..")
    # Switches, decimals, whole numbers and choices end at points; what follows the last of them are joints.
    fields = head.split(".")
    joints: dict[str, tuple[int, Place, float]] = {}
    for text in fields:
        cells = text.split(",")
        if len(cells) >= 4 and cells[0] and cells[0][0] in DIGITS and len(cells[0]) > 1:
            flags = DIGITS.index(cells[0][0])
            angle = _decimal(cells[4]) if len(cells) > 4 and cells[4] else 0.0
            joints[cells[0][1:]] = (flags, (_decimal(cells[2]) * UNIT, _decimal(cells[3]) * UNIT), angle)
    if not joints:
        raise ValueError("it has no joints")
    sketch = Sketch(name, "PMKS+", unit="a centimetre")
    on: dict[str, list[str]] = {joint: [] for joint in joints}
    for text in links_text.split("."):
        head_of, *cells = text.split(",")
        matched = re.match(r"^Y?([RP])(.+)$", head_of)
        if matched is None:
            continue
        members = [cell for cell in cells[6:] if cell in joints]
        if matched[1] == "P":
            for joint in members:  # the piston of a slider, which is its joint here
                on[joint].insert(0, f"piston {joint}")
            continue
        link = sketch.link(cells[0] or matched[2])
        for joint in members:
            link.points[joint] = joints[joint][1]
            on[joint].append(link.name)
    for joint, (flags, place, angle) in joints.items():
        _join(sketch, joint, flags, place, angle, on[joint])
    if forces.strip("."):
        count = len([cell for cell in forces.split("..")[0].split(".") if "," in cell])
        if count:
            sketch.left_out.append(f"{count} forces; m.force(...) and m.load(...) say them")
    return sketch


def _join(sketch: Sketch, joint: str, flags: int, place: Place, angle: float, bodies: list[str]) -> None:
    links = [body for body in bodies if not body.startswith("piston ")]
    if flags & SLIDER:
        for link in links[:1]:
            sketch.joints.append(Slide(joint, GROUND, link, place, angle, turns=True))
        if len(links) > 1:
            sketch.pin_all(f"{joint}_pin", links, place)
        if flags & INPUT:
            sketch.left_out.append(f"input {joint}: it drives a slider; m.drive_coordinate says that")
        return
    if flags & WELDED:
        sketch.left_out.append(f"joint {joint} is welded; it is a pin here, m.weld says the other")
    carriers = [*([GROUND] if flags & FIXED else []), *links]
    if len(carriers) > 1:
        sketch.pin_all(joint, carriers, place)
    elif links:
        sketch.traces[joint] = (links[0], place)
    if flags & INPUT and flags & FIXED and links:
        sketch.motors.append(Motor("motor", GROUND, links[0], SPEED))


def _decimal(text: str) -> float:
    sign, digits = (-1.0, text[1:]) if len(text) > 1 and text[0] == "0" else (1.0, text)
    value = 0
    for digit in digits:
        value = value * len(DIGITS) + DIGITS.index(digit)
    number = sign * value / 1000.0
    if not math.isfinite(number):
        raise ValueError(f"{text!r} is no number")
    return number
