"""Planar mechanisms of mbsd-core as JSON (``mechanism_to_json``, schema 1), in SI units.

Read are bodies, pins, slides, motors and gravity.

Such a file holds no pose. One that closes all joints is looked for as that program does by itself: by Newton's method
from all bodies at the origin, else from random poses.

    pin      R_i + A_i r_i = R_j + A_j r_j
    slide    theta_i = theta_j,   (A_i n) . (R_i + A_i r_i - R_j - A_j r_j) = 0
    motor    theta = phase + omega t
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from shared.stage.errors import UserError
from studio.imports.limits import check_count, parsed_json
from studio.imports.sketch import GROUND, Motor, Pin, Place, Sketch, Slide

SCHEMA, VERSION = "mbsd.planar.mechanism", 1
TRIES, PASSES = 40, 60
LARGE, MOST_BODIES = 20, 100
"""Bodies above which an eighth of the tries must do, and above which none is made: a try takes their third power."""
CLOSED = 1e-11
"""Residual (m, rad) by the size of the places in the file at which a pose closes."""


def is_mbsd_core(text: str) -> bool:
    """True if a text is such a file, or a spatial mechanism or a result of the same program."""
    return text.lstrip().startswith("{") and ('"mbsd.planar.' in text or '"mbsd.spatial.' in text)


def read(text: str, name: str) -> Sketch:
    """Return the mechanism of such a file.

    Raises UserError if it is damaged, spatial, or closes in no pose.
    """
    data = parsed_json(text)
    _refuse_others(data)
    return _read(data, name)


def _refuse_others(data: dict[str, Any]) -> None:
    schema = str(data.get("schema"))
    if schema.startswith("mbsd.spatial."):
        raise UserError(f"it is a spatial mechanism ({schema}); planar ones can be imported")
    if schema != SCHEMA:
        raise UserError(f"it is {schema}, not a mechanism; write one with mechanism.to_json(...)")
    if data.get("schema_version") != VERSION:
        raise UserError(f"its schema_version is {data.get('schema_version')}; {VERSION} can be read")


def _read(data: dict[str, Any], name: str) -> Sketch:
    bodies = data["bodies"]
    if not 1 < len(bodies) <= MOST_BODIES:
        raise UserError(f"it has {len(bodies)} bodies; a mechanism has 2 to {MOST_BODIES}, the ground among them")
    words = [GROUND, *(str(body["name"]) or f"body_{k}" for k, body in enumerate(bodies[1:], 1))]
    if len(set(words)) < len(words):
        raise UserError("two of its bodies have the same name")
    sketch = Sketch(name.rsplit(".", 1)[0], "mbsd-core", gravity=(float(data["gravity"][0]), float(data["gravity"][1])))
    motors = []
    for given in data.get("user_constraints", []):
        if given.get("kind") == "motor":
            motors.append((_body(given["body"], words), float(given["omega"]), float(given["phase"])))
        else:
            driven = ""
            if "coordinate" in given:
                driven = f" of {words[_body(given['body'], words)] or 'the ground'} ({given['coordinate']})"
            sketch.left_out.append(
                f"constraint {given.get('index', '?')}{driven}: its function is Python, which is missing in the file"
            )
    pins, slides = data["joints"]["revolute"], data["joints"]["prismatic"]
    check_count([*pins, *slides, *motors], "joints and motors")
    counts = {"bodies": len(bodies), "revolute_joints": len(pins), "prismatic_joints": len(slides)}
    for key, number in counts.items():
        if data.get("counts", {}).get(key, number) != number:
            raise UserError(f"its counts say {data['counts'][key]} {key.replace('_', ' ')}, and there are {number}")
    sketch.freedom = 3 * (len(bodies) - 1) - 2 * (len(pins) + len(slides))
    for joint in (*pins, *slides):
        for key in ("body_i", "body_j") if "body_i" in joint else ("rail_body", "slider_body"):
            joint[key] = _body(joint[key], words)
    poses = _closed(len(bodies), pins, slides, [(body, phase) for body, _, phase in motors])

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
        first, second = sorted((pin["body_i"], pin["body_j"]))
        place = world(int(pin["body_i"]), pin["point_i"])
        sketch.joints.append(Pin(f"pin_{k}", words[first], words[second], place))
    for k, slide in enumerate(slides, 1):
        rail, slider = slide["rail_body"], slide["slider_body"]
        angle = math.atan2(slide["axis"][1], slide["axis"][0]) + float(poses[rail][2])
        along, place = world(rail, slide["point_rail"]), world(slider, slide["point_slider"])
        sketch.joints.append(Slide(f"slide_{k}", words[rail], words[slider], place, angle, along=along))
    for body, omega, phase in motors:
        sketch.motors.append(Motor(f"motor_{words[body]}", GROUND, words[body], omega, start=phase))
    return sketch


def _body(number: Any, words: list[str]) -> int:
    """Return the number of a body. Raises UserError if there is none."""
    if not isinstance(number, int) or not 0 <= number < len(words):
        raise UserError(f"there is no body {number}; they are numbered 0 to {len(words) - 1}")
    return number


def _closed(count: int, pins: Any, slides: Any, turned: list[tuple[int, float]]) -> np.ndarray:
    """Return (count, 3) poses in which everything closes. Raises UserError if none is found."""
    size = max([1e-9, *(abs(float(c)) for joint in (*pins, *slides) for key in joint if key.startswith("point")
                        for c in joint[key])])  # fmt: skip

    def gaps(q: np.ndarray) -> np.ndarray:
        """Return residuals (rows, k) of the coordinates (3 n, k)."""
        poses = np.concatenate([np.zeros((1, 3, q.shape[1])), q.reshape(-1, 3, q.shape[1])])
        out: list[Any] = []
        for pin in pins:
            out += list(
                _in_world(poses[pin["body_i"]], pin["point_i"]) - _in_world(poses[pin["body_j"]], pin["point_j"])
            )
        for slide in slides:
            i, j = poses[slide["rail_body"]], poses[slide["slider_body"]]
            apart = _in_world(i, slide["point_rail"]) - _in_world(j, slide["point_slider"])
            across = _in_world(np.array([0.0 * i[2], 0.0 * i[2], i[2]]), [-slide["axis"][1], slide["axis"][0]])
            out += [size * (i[2] - j[2]), (across * apart).sum(axis=0)]
        out += [size * (poses[body][2] - phase) for body, phase in turned]
        return np.array(out).reshape(-1, q.shape[1])

    random = np.random.default_rng(1)
    start = np.zeros(3 * (count - 1))
    tries = TRIES if count <= LARGE else TRIES // 8
    for _ in range(tries):
        q = _newton(gaps, start, size)
        if q is not None:
            return np.concatenate([np.zeros((1, 3)), q.reshape(-1, 3)])
        start = random.standard_normal(len(start)) * np.tile([size, size, math.pi], count - 1)
    raise UserError(
        f"no pose was found in {tries} tries in which its joints close; are the lengths those of the program?"
    )


def _newton(gaps: Any, q: np.ndarray, size: float) -> np.ndarray | None:
    """Return a closed pose near q (3 n,), by steps of least length; None without one.

    Derivatives are taken by complex steps.
    """
    for _ in range(PASSES):
        here = gaps(q[:, None])[:, 0]
        if np.abs(here).max(initial=0.0) < CLOSED * size:
            q[2::3] = np.remainder(q[2::3] + math.pi, math.tau) - math.pi
            return q
        jacobian = gaps(q[:, None] + 1e-30j * np.eye(len(q))).imag / 1e-30
        step = np.linalg.lstsq(jacobian, here, rcond=1e-10)[0]
        turn = np.abs(step[2::3]).max(initial=0.0)
        q = q - step * min(1.0, 0.5 / turn if turn > 0.0 else 1.0)
    return None


def _in_world(pose: np.ndarray, point: Any) -> np.ndarray:
    c, s = np.cos(pose[2]), np.sin(pose[2])
    return np.array([pose[0] + c * point[0] - s * point[1], pose[1] + s * point[0] + c * point[1]])
