"""Files of PMKS: its text (``link,link,R,x,y,angle,flags``) and .pmks, which is the same as JSON.

Coordinates have no unit; a number is taken for a millimetre. The first joint that is marked as input turns at 10 rad/s
where the file says nothing. R is a pin, P a slider along its angle (degrees), RP a pin in a slot, G gears.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import pairwise

from shared.contract.quantity import counted
from shared.stage.errors import UserError
from studio.imports.limits import check_count, check_length, parsed_json
from studio.imports.sketch import GROUND, Motor, Place, Push, Sketch, Slide

UNIT = 0.001
"""m"""
SPEED = 10.0
"""rad/s"""
LETTERS = "ABCDEFGHIJKLMNOPQRSTUVWXYZ"
FRAME = "ground"
"""The link that does not move; no other can have that name there."""
TAKEN = {"R": 2, "P": 2, "RP": 1, "G": 1}
"""Freedoms that a joint of two links takes, by its kind."""


@dataclass
class _Joint:
    links: list[str]
    kind: str
    place: Place
    angle: float


def is_pmks(text: str) -> bool:
    """True if a text is such a file."""
    if text.lstrip().startswith("{"):
        return '"TypeOfJoint"' in text
    lines = [line for line in text[:4000].splitlines() if line.strip()]
    return bool(lines) and (lines[0].startswith("mech=") or _joint_of(lines[0]) is not None)


def read(text: str, name: str) -> Sketch:
    """Return the mechanism of such a file. Raises UserError for a line that is no joint."""
    sketch = Sketch(name, "PMKS", unit="a millimetre")
    check_length(text)
    if text.lstrip().startswith("{"):
        joints, driven, speed = _of_json(text)
    else:
        joints, driven, speed = _of_lines(text), 0, SPEED
    check_count(joints, "joints")
    taken = 0
    for k, joint in enumerate(joints):
        label = LETTERS[k] if k < len(LETTERS) else f"J{k}"
        links = list(dict.fromkeys(GROUND if link.lower() == FRAME else link for link in joint.links))
        for link in links:
            if link != GROUND:
                sketch.link(link).points.setdefault(label, joint.place)
        _add(sketch, label, joint, links)
        taken += TAKEN[joint.kind] + 2 * (len(links) - 2) if len(links) > 1 else 0
        if k == driven:
            _drive(sketch, label, joint, links, speed)
    sketch.freedom = 3 * len(sketch.links) - taken
    return sketch


def _add(sketch: Sketch, label: str, joint: _Joint, links: list[str]) -> None:
    """Add a joint: with one link a traced point; links beyond two are pinned to the second."""
    if len(links) == 1:
        if links[0] != GROUND:
            sketch.traces[label] = (links[0], joint.place)
    elif joint.kind == "R":
        sketch.pin_all(label, links, joint.place)
    elif joint.kind == "G":
        sketch.left_out.append(f"joint {label} of kind G: m.gear_pair says gears, with their radii")
    else:
        guide, *riders = sorted(links, key=lambda link: link != GROUND)
        sketch.joints.append(Slide(label, guide, riders[0], joint.place, joint.angle, turns=joint.kind == "RP"))
        if len(riders) > 1:
            sketch.pin_all(f"{label}_pin", riders, joint.place)


def _drive(sketch: Sketch, label: str, joint: _Joint, links: list[str], speed: float) -> None:
    if len(links) == 2 and joint.kind == "R":
        first, second = sorted(links, key=lambda link: link != GROUND)
        sketch.motors.append(Motor("motor", first, second, speed))
    elif joint.kind == "R":
        sketch.left_out.append(
            f"input {label}: {counted(len(links), 'link')} meet there, so it does not say which of them turns"
        )
    else:
        guide, *riders = sorted(links, key=lambda link: link != GROUND)
        sketch.pushes.append(Push("motor", guide, riders[0], joint.place, joint.angle, speed * UNIT))
        sketch.left_out.append(f"input {label}: it slides on at {speed * UNIT:g} m/s beyond any end; change its law")


def _joint_of(line: str) -> _Joint | None:
    """Return the joint of a line ``link,link,R,x,y,angle,flags``; None if it is none."""
    cells = [cell.strip() for cell in line.split(",")]
    for k, (cell, following) in enumerate(pairwise(cells)):
        numbers = _leading_numbers(" ".join([following, *cells[k + 2 : k + 4]])) if cell.upper() in TAKEN else []
        if k and len(numbers) > 1 and all(cells[:k]):
            angle = math.radians(numbers[2]) if len(numbers) > 2 else 0.0
            return _Joint(cells[:k], cell.upper(), (numbers[0] * UNIT, numbers[1] * UNIT), angle)
    return None


def _leading_numbers(text: str) -> list[float]:
    """Return up to three numbers at the beginning of a text."""
    numbers: list[float] = []
    for word in text.split()[:3]:
        try:
            numbers.append(float(word))
        except ValueError:
            break
    return numbers


def _of_lines(text: str) -> list[_Joint]:
    joints: list[_Joint] = []
    for number, line in enumerate(text.splitlines(), 1):
        if not line.strip() or line.startswith("mech="):
            continue
        joint = _joint_of(line)
        if joint is None:
            raise UserError(f"line {number} is not a joint of PMKS ({line.strip()[:60]!r}); link,link,R,x,y is one")
        joints.append(joint)
    return joints


def _of_json(text: str) -> tuple[list[_Joint], int, float]:
    data = parsed_json(text)
    joints = [
        _Joint(
            [str(link).strip() for link in joint["Links"]],
            str(joint["TypeOfJoint"]).upper(),
            (float(joint["X"]) * UNIT, float(joint["Y"]) * UNIT),
            math.radians(float(joint.get("Angle") or 0.0)),
        )
        for joint in data["Joints"]
    ]
    for number, joint in enumerate(joints, 1):
        if joint.kind not in TAKEN or not joint.links:
            raise UserError(
                f"joint {number} is of kind {joint.kind[:20]!r} with {counted(len(joint.links), 'link')}; "
                "kinds are R, P, RP, G"
            )
    return joints, int(data.get("DrivingIndex") or 0), float(data.get("InputSpeed") or SPEED)
