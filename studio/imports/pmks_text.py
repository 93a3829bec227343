"""Files of PMKS: its text (``link,link,R,x,y,angle,flags``) and its .pmks, which is the same as JSON.

Coordinates have no unit; a number is taken for a millimetre. The first joint that is marked as input turns at 10 rad/s
where the file says nothing. R is a pin, P a slider along its angle (degrees), RP a pin in a slot, G gears.
"""

from __future__ import annotations

import json
import math
import re
from dataclasses import dataclass

from shared.stage.errors import UserError
from studio.imports.sketch import GROUND, Motor, Place, Sketch, Slide

UNIT = 0.001
"""m"""
SPEED = 10.0
"""rad/s"""
LETTERS = "ABCDEFGHIJKLMNOPQRSTUVWXYZ"
LINE = re.compile(r"^\s*([^,\n]+(?:,[^,\n]+)*?),\s*(R|P|RP|G)\s*,\s*([-+\d.][^\n]*)$", re.IGNORECASE)


@dataclass
class _Joint:
    links: list[str]
    kind: str
    place: Place
    angle: float


def is_pmks(text: str) -> bool:
    """Whether a text is such a file."""
    if text.lstrip().startswith("{"):
        return '"TypeOfJoint"' in text
    lines = [line for line in text.splitlines() if line.strip()]
    return bool(lines) and (lines[0].startswith("mech=") or LINE.match(lines[0]) is not None)


def read(text: str, name: str) -> Sketch:
    """The mechanism of such a file. Raises UserError for lines that are none."""
    sketch = Sketch(name, "PMKS", unit="a millimetre")
    if text.lstrip().startswith("{"):
        joints, driven, speed = _of_json(text, name)
    else:
        joints, driven, speed = _of_lines(text, name)
    for k, joint in enumerate(joints):
        label = LETTERS[k] if k < len(LETTERS) else f"J{k}"
        links = [GROUND if link.lower() == GROUND else link for link in joint.links]
        for link in links:
            if link != GROUND:
                sketch.link(link).points.setdefault(label, joint.place)
        if len(links) == 1:
            if links[0] != GROUND:
                sketch.traces[label] = (links[0], joint.place)
        elif joint.kind == "R":
            sketch.pin_all(label, links, joint.place)
        elif joint.kind in ("P", "RP"):
            guide, rider = sorted(links[:2], key=lambda link: link != GROUND)
            sketch.joints.append(Slide(label, guide, rider, joint.place, joint.angle, turns=joint.kind == "RP"))
        else:
            sketch.left_out.append(f"joint {label} of kind {joint.kind}: m.gear_pair says gears, with their radii")
        if k == driven and len(links) > 1 and joint.kind == "R":
            first, second = sorted(links[:2], key=lambda link: link != GROUND)
            sketch.motors.append(Motor("motor", first, second, speed))
        elif k == driven:
            sketch.left_out.append(f"input {label}: only pins are driven here; m.drive_coordinate drives a slider")
    return sketch


def _of_lines(text: str, name: str) -> tuple[list[_Joint], int, float]:
    joints: list[_Joint] = []
    for number, line in enumerate(text.splitlines(), 1):
        if not line.strip() or line.startswith("mech="):
            continue
        matched = LINE.match(line)
        numbers = re.findall(r"[-+]?\d+\.?\d*(?:[eE][-+]?\d+)?", matched[3]) if matched else []
        if matched is None or len(numbers) < 2:
            raise UserError(
                f"{name}: line {number} is no joint of PMKS ({line.strip()[:60]!r}); link,link,R,x,y is one"
            )
        angle = math.radians(float(numbers[2])) if len(numbers) > 2 else 0.0
        place = (float(numbers[0]) * UNIT, float(numbers[1]) * UNIT)
        joints.append(_Joint([link.strip() for link in matched[1].split(",")], matched[2].upper(), place, angle))
    return joints, 0, SPEED


def _of_json(text: str, name: str) -> tuple[list[_Joint], int, float]:
    try:
        data = json.loads(text)
        joints = [
            _Joint(
                [str(link) for link in joint["Links"]],
                str(joint["TypeOfJoint"]).upper(),
                (float(joint["X"]) * UNIT, float(joint["Y"]) * UNIT),
                math.radians(float(joint.get("Angle") or 0.0)),
            )
            for joint in data["Joints"]
        ]
        return joints, int(data.get("DrivingIndex") or 0), float(data.get("InputSpeed") or SPEED)
    except (ValueError, KeyError, TypeError, AttributeError) as error:
        raise UserError(f"{name}: this is no .pmks file that can be read ({type(error).__name__}: {error})") from error
