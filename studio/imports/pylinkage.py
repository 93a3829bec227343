"""Mechanisms of pylinkage as JSON (``mechanism_to_json``): joints with places, links with joints.

Coordinates have no unit there; a number is taken for a metre. A driver turns by ``angular_velocity`` in radians at each
step (``DriverLink.step``; tau / 360 if not given), and its films show 24 steps a second (``fps=24`` of its visualizer),
so the rate in rad/s is 24 times that.
"""

from __future__ import annotations

import math
from typing import Any

from shared.stage.errors import UserError
from studio.imports.limits import check_count, parsed_json
from studio.imports.sketch import GROUND, Motor, Place, Sketch, Slide

STEPS = 24.0
"""Steps a second."""
USUAL = math.tau / 360.0
"""rad a step, where the file gives no rate."""


def is_pylinkage(text: str) -> bool:
    """True if a text is such a file."""
    return text.lstrip().startswith("{") and '"joints"' in text and '"links"' in text and '"position"' in text


def read(text: str, name: str) -> Sketch:
    """Return the mechanism of such a file. Raises UserError if it cannot be read."""
    data = parsed_json(text)
    sketch = Sketch(str(data.get("name") or name), "pylinkage", unit="a metre")
    for key in ("joints", "links"):
        check_count(data[key], key)
    joints = {str(joint["id"]): joint for joint in data["joints"]}
    places: dict[str, Place] = {
        key: (float(given["position"][0]), float(given["position"][1])) for key, given in joints.items()
    }
    bodies = _bodies(data)
    on = _carriers(data, joints, bodies)
    for link, body in zip(data["links"], bodies, strict=True):
        for joint in link["joints"] if body != GROUND else ():
            sketch.link(body).points.setdefault(str(joint), places[str(joint)])
    taken = 0
    for key, joint in joints.items():
        if joint.get("type") == "prismatic":
            taken += _slide(sketch, key, joint, places[key], on[key])
        elif joint.get("type") == "tracker" or len(on[key]) == 1:
            _trace(sketch, key, joint, places, on)
        else:
            sketch.pin_all(key, on[key], places[key])
            taken += 2 * max(len(on[key]) - 1, 0)
    sketch.freedom = 3 * len({body for body in bodies if body != GROUND}) - taken
    for link, body in zip(data["links"], bodies, strict=True):
        if link.get("type") in ("driver", "arc_driver"):
            rate = STEPS * float(USUAL if link.get("angular_velocity") is None else link["angular_velocity"])
            sketch.motors.append(Motor(f"motor_{body}", GROUND, body, rate))
            if link["type"] == "arc_driver":
                sketch.left_out.append(f"driver {body} swings between two angles there, and turns on here")
    return sketch


def _bodies(data: dict[str, Any]) -> list[str]:
    """Return the names of all links in their order; the ground's is that of the frame."""
    ground = data.get("ground", "ground")
    names: list[str] = []
    for k, link in enumerate(data["links"], 1):
        fixed = link["id"] == ground or link.get("type") == "ground"
        name = GROUND if fixed else str(link["id"]) or f"link_{k}"
        if name != GROUND and name in names:
            raise UserError(f"there are two links '{name}'")
        if name != GROUND and not link["joints"]:
            raise UserError(f"link '{name}' has no joints")
        names.append(name)
    return names


def _carriers(data: dict[str, Any], joints: dict[str, Any], bodies: list[str]) -> dict[str, list[str]]:
    """Return the links on each joint, the ground first if the joint is fixed."""
    on = {key: [GROUND] if joint.get("type") == "ground" else [] for key, joint in joints.items()}
    for link, body in zip(data["links"], bodies, strict=True):
        for joint in link["joints"]:
            if str(joint) not in on:
                raise UserError(f"link '{body}' has a joint '{joint}', which is missing in the file")
            on[str(joint)] += [GROUND, body] if joint == link.get("motor_joint") else [body]
    return {key: list(dict.fromkeys(links)) for key, links in on.items()}


def _trace(sketch: Sketch, key: str, joint: dict[str, Any], places: dict[str, Place], on: dict[str, list[str]]) -> None:
    """Follow a point of a link; a free tracker rides with the link of its two references."""
    first, second = str(joint.get("ref_joint1_id", "")), str(joint.get("ref_joint2_id", ""))
    links = on[key] or [link for link in on.get(first, []) if link in on.get(second, [])]
    if not links:
        sketch.left_out.append(f"point {key}: no link carries it")
    elif links[0] != GROUND:
        sketch.traces[key] = (links[0], places[key])


def _slide(sketch: Sketch, key: str, joint: dict[str, Any], place: Place, links: list[str]) -> int:
    """Add a joint that slides on the frame with all its links; return the freedoms it removes."""
    axis = joint.get("axis") or (1.0, 0.0)
    angle = math.atan2(float(axis[1]), float(axis[0]))
    line = joint.get("line_point") or place
    riders = [link for link in links if link != GROUND]
    if not riders:
        sketch.left_out.append(f"prismatic joint {key}: no link rides on it")
        return 0
    sketch.joints.append(Slide(key, GROUND, riders[0], place, angle, True, (float(line[0]), float(line[1]))))
    if len(riders) > 1:
        sketch.pin_all(f"{key}_pin", riders, place)
    return 1 + 2 * (len(riders) - 1)
