"""Mechanisms of pylinkage as JSON (``mechanism_to_json``): joints with places, links with the joints on them.

Coordinates have no unit there; a number is taken for a metre.
"""

from __future__ import annotations

import json
import math
from typing import Any

from shared.stage.errors import UserError
from studio.imports.sketch import GROUND, Motor, Place, Sketch, Slide


def is_pylinkage(text: str) -> bool:
    """Whether a text is such a file."""
    return text.lstrip().startswith("{") and '"joints"' in text and '"links"' in text and '"position"' in text


def read(text: str, name: str) -> Sketch:
    """The mechanism of such a file. Raises UserError where it cannot be read."""
    try:
        return _read(json.loads(text), name)
    except (ValueError, KeyError, TypeError, AttributeError) as error:
        raise UserError(
            f"{name}: this is no JSON of pylinkage that can be read ({type(error).__name__}: {error})"
        ) from error


def _read(data: dict[str, Any], name: str) -> Sketch:
    sketch = Sketch(str(data.get("name") or name), "pylinkage", unit="a metre")
    joints = {joint["id"]: joint for joint in data["joints"]}
    places: dict[str, Place] = {
        key: (float(given["position"][0]), float(given["position"][1])) for key, given in joints.items()
    }
    ground = data.get("ground", GROUND)
    on: dict[str, list[str]] = {str(key): [] for key in joints}
    for link in data["links"]:
        fixed = link["id"] == ground or link.get("type") == GROUND
        for joint in link["joints"]:
            on[joint].append(GROUND if fixed else link["id"])
            if not fixed:
                sketch.link(link["id"]).points.setdefault(joint, places[joint])
    for key, joint in joints.items():
        fixed = [GROUND] if joint.get("type") == "ground" else []
        links: list[str] = list(dict.fromkeys([*fixed, *on[key]]))
        if joint.get("type") == "prismatic":
            _slide(sketch, key, joint, places[key], links)
        elif joint.get("type") == "tracker" or len(links) == 1:
            if links and links[0] != GROUND:
                sketch.traces[key] = (links[0], places[key])
        else:
            sketch.pin_all(key, links, places[key])
    for link in data["links"]:
        if link.get("type") in ("driver", "arc_driver"):
            rate = float(link.get("angular_velocity") or 1.0)
            sketch.motors.append(Motor(f"motor_{link['id']}", GROUND, link["id"], rate))
            if link["type"] == "arc_driver":
                sketch.left_out.append(f"driver {link['id']} swings between two angles there, and turns on here")
    return sketch


def _slide(sketch: Sketch, key: str, joint: dict[str, Any], place: Place, links: list[str]) -> None:
    axis = joint.get("axis") or (1.0, 0.0)
    angle = math.atan2(float(axis[1]), float(axis[0]))
    order = sorted(links, key=lambda link: link != GROUND)
    if len(order) < 2:
        order = [GROUND, *order]
    sketch.joints.append(Slide(key, order[0], order[1], place, angle, turns=True))
    if len(order) > 2:
        sketch.pin_all(f"{key}_pin", order[1:], place)
