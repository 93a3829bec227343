"""Planar mechanisms of mbsd-core as JSON (``mechanism_to_json``, schema 1): bodies, pins, slides, motors, gravity; SI.

Such a file holds no pose. One that closes all joints is looked for as that program does by itself: by Newton's method
from all bodies at the origin, else from random poses.

    pin      R_i + A_i r_i = R_j + A_j r_j
    slide    theta_i = theta_j,   (A_i n) . (R_i + A_i r_i - R_j - A_j r_j) = 0
    motor    theta = phase + omega t
"""

from __future__ import annotations

import json
import math
from typing import Any

import numpy as np

from shared.stage.errors import UserError
from studio.imports.sketch import GROUND, Motor, Pin, Place, Sketch, Slide

SCHEMA, VERSION = "mbsd.planar.mechanism", 1
TRIES, PASSES = 40, 60
CLOSED = 1e-11
"""Residual (m, rad) by the size of the places in the file at which a pose closes."""


def is_mbsd_core(text: str) -> bool:
    """Whether a text is such a file, or a spatial mechanism or a result of the same program."""
    return text.lstrip().startswith("{") and ('"mbsd.planar.' in text or '"mbsd.spatial.' in text)


def read(text: str, name: str) -> Sketch:
    """The mechanism of such a file. Raises UserError where it cannot be read, is spatial, or closes in no pose."""
    try:
        data = json.loads(text)
        _refuse_others(data, name)
        return _read(data, name)
    except (ValueError, KeyError, TypeError, AttributeError, IndexError) as error:
        raise UserError(
            f"{name}: this is no mechanism of mbsd-core that can be read ({type(error).__name__}: {error})"
        ) from error


def _refuse_others(data: dict[str, Any], name: str) -> None:
    schema = str(data.get("schema"))
    if schema.startswith("mbsd.spatial."):
        raise UserError(f"{name}: it is a spatial mechanism ({schema}); planar ones can be imported")
    if schema != SCHEMA:
        raise UserError(f"{name}: it is {schema}, not a mechanism; write one with mechanism.to_json(...)")
    if data.get("schema_version") != VERSION:
        raise UserError(f"{name}: its schema_version is {data.get('schema_version')}; {VERSION} can be read")


def _read(data: dict[str, Any], name: str) -> Sketch:
    bodies = data["bodies"]
    words = [GROUND, *(_unlike_ground(body["name"], k) for k, body in enumerate(bodies[1:], 1))]
    sketch = Sketch(name.rsplit(".", 1)[0], "mbsd-core", gravity=(float(data["gravity"][0]), float(data["gravity"][1])))
    motors = []
    for given in data.get("user_constraints", []):
        if given.get("kind") == "motor":
            motors.append((int(given["body"]), float(given["omega"]), float(given["phase"])))
        else:
            of = f" of {words[int(given['body'])]} ({given['coordinate']})" if "coordinate" in given else ""
            sketch.left_out.append(
                f"constraint {given.get('index', '?')}{of}: its function is Python, which the file has not"
            )
    pins, slides = data["joints"]["revolute"], data["joints"]["prismatic"]
    poses = _closed(name, len(bodies), pins, slides, [(body, phase) for body, _, phase in motors])

    def world(body: int, point: Any) -> Place:
        x, y, angle = poses[body]
        c, s = math.cos(angle), math.sin(angle)
        return float(x + c * point[0] - s * point[1]), float(y + s * point[0] + c * point[1])

    for k, body in enumerate(bodies[1:], 1):
        link = sketch.link(words[k])
        link.angle, link.points["origin"] = float(poses[k][2]), world(k, (0.0, 0.0))
        link.mass, link.inertia = float(body["mass"]), float(body["inertia"])
        link.centre = world(k, body["center_of_mass"])
    for k, pin in enumerate(pins, 1):
        first, second = sorted((int(pin["body_i"]), int(pin["body_j"])))
        place = world(int(pin["body_i"]), pin["point_i"])
        sketch.joints.append(Pin(f"pin_{k}", words[first], words[second], place))
    for k, slide in enumerate(slides, 1):
        rail, slider = int(slide["rail_body"]), int(slide["slider_body"])
        angle = math.atan2(slide["axis"][1], slide["axis"][0]) + float(poses[rail][2])
        along, place = world(rail, slide["point_rail"]), world(slider, slide["point_slider"])
        sketch.joints.append(Slide(f"slide_{k}", words[rail], words[slider], place, angle, along=along))
    for body, omega, phase in motors:
        sketch.motors.append(Motor(f"motor_{words[body]}", GROUND, words[body], omega, start=phase))
    return sketch


def _unlike_ground(name: str, number: int) -> str:
    return name if name and name != GROUND else f"body_{number}"


def _closed(name: str, count: int, pins: Any, slides: Any, turned: list[tuple[int, float]]) -> np.ndarray:
    """(count, 3) poses in which everything closes. Raises UserError where none comes out."""
    size = max([1e-9, *(abs(float(c)) for joint in (*pins, *slides) for key in joint if key.startswith("point")
                        for c in joint[key])])  # fmt: skip

    def gaps(q: np.ndarray) -> np.ndarray:
        poses = np.concatenate([np.zeros((1, 3)), q.reshape(-1, 3)])
        out: list[Any] = []
        for pin in pins:
            out += list(_at(poses[pin["body_i"]], pin["point_i"]) - _at(poses[pin["body_j"]], pin["point_j"]))
        for slide in slides:
            i, j = poses[slide["rail_body"]], poses[slide["slider_body"]]
            apart = _at(i, slide["point_rail"]) - _at(j, slide["point_slider"])
            across = _at(np.array([0.0, 0.0, i[2]]), [-slide["axis"][1], slide["axis"][0]])
            out += [size * (i[2] - j[2]), across @ apart]
        return np.array(out + [size * (poses[body][2] - phase) for body, phase in turned])

    random = np.random.default_rng(1)
    start = np.zeros(3 * (count - 1))
    for _ in range(TRIES):
        q = _newton(gaps, start, size)
        if q is not None:
            return np.concatenate([np.zeros((1, 3)), q.reshape(-1, 3)])
        start = random.standard_normal(len(start)) * np.tile([size, size, math.pi], count - 1)
    raise UserError(
        f"{name}: no pose was seen in {TRIES} tries in which its joints close; are the lengths those of the program?"
    )


def _newton(gaps: Any, q: np.ndarray, size: float) -> np.ndarray | None:
    """A closed pose near q (3 n,) by steps of least length; derivatives by complex steps."""
    for _ in range(PASSES):
        here = gaps(q)
        if np.abs(here).max(initial=0.0) < CLOSED * size:
            q[2::3] = np.remainder(q[2::3] + math.pi, math.tau) - math.pi
            return q
        columns = [gaps(q + 1e-30j * unit).imag / 1e-30 for unit in np.eye(len(q))]
        step = np.linalg.lstsq(np.array(columns).T, here, rcond=1e-10)[0]
        turn = np.abs(step[2::3]).max(initial=0.0)
        q = q - step * min(1.0, 0.5 / turn if turn > 0.0 else 1.0)
    return None


def _at(pose: np.ndarray, point: Any) -> np.ndarray:
    c, s = np.cos(pose[2]), np.sin(pose[2])
    return np.array([pose[0] + c * point[0] - s * point[1], pose[1] + s * point[0] + c * point[1]])
