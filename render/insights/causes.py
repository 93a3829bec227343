"""Causes of a joint's reaction at one moment: its parts from gas, springs, loads, muscles, contact, weight and inertia.

Reactions follow linearly from what loads the bodies. With each load alone the bodies would accelerate as the joints
and drivers let them:

    M a - A u = w      A' a = 0      u: sizes of reactions and driver efforts      w: forces and moments on all bodies

What is left of the reaction of data.json is the part of inertia: of speeds, and of what drivers demand. The parts are
known only where A and all loads together give back that reaction, which fails where joints are redundant.
"""

from __future__ import annotations

import math
from collections.abc import Iterable

import numpy as np

from render.insights.seen import Array, Seen
from shared.contract import DriverMotion, ForceMotion, JointMotion

GOOD = 1e-5
"""Part of a reaction by which the sum of its parts may miss it."""
Wrench = tuple[float, float, float]


def parts_of(seen: Seen, name: str, row: int) -> dict[str, float]:
    """Return the parts of a joint's reaction along it, by cause; they add up to 1. Empty where they are not known."""
    index = {body: 3 * k for k, body in enumerate(seen.motion.bodies)}
    columns: list[Array] = []
    own: list[tuple[int, Array]] = []
    for joint_name, joint in seen.motion.joints.items():
        place = joint.acts or joint
        x, y = place.x[row], place.y[row]
        if _is_rigid(seen, joint):
            return {}
        for fx, fy, torque in _ways(seen, joint, row):
            if joint_name == name:
                own.append((len(columns), np.array([fx, fy])))
            columns.append(_on_pair(index, joint.bodies, (fx, fy, torque + x * fy - y * fx)))
    for driver in seen.motion.drivers.values():
        bodies = driver.bodies or (("ground", seen.input.body) if seen.input else ("ground", "ground"))
        columns += [_on_pair(index, bodies, way) for way in _effort(driver, row)]
    recorded = np.array([seen.motion.joints[name].fx[row], seen.motion.joints[name].fy[row]])
    size = float(np.hypot(*recorded))
    if not columns or not own or not size:
        return {}
    loads, matrix = loads_of(seen, index, row), np.array(columns).T
    everything = np.linalg.lstsq(matrix, -np.sum(list(loads.values()), axis=0), rcond=None)[0]
    if np.abs(_reaction(own, everything) - recorded).max() > GOOD * size:
        return {}
    masses = _masses(seen, index, row)
    count = len(matrix)
    system = np.block([[masses, -matrix], [matrix.T, np.zeros((matrix.shape[1],) * 2)]])
    given = {cause: values for cause, values in loads.items() if cause != "inertia"}
    parts = {}
    for cause, values in given.items():
        right = np.concatenate([values, np.zeros(matrix.shape[1])])
        answer = np.linalg.lstsq(system, right, rcond=None)[0]
        if np.abs(system @ answer - right).max() > GOOD * np.abs(values).max():
            return {}
        parts[cause] = float(_reaction(own, answer[count:]) @ recorded) / size**2
    return parts | {"inertia": 1.0 - sum(parts.values())}


def _reaction(own: list[tuple[int, Array]], sizes: Array) -> Array:
    """Return the force (2,) of a joint with these columns (N)."""
    return np.sum([sizes[k] * way for k, way in own], axis=0)


def _masses(seen: Seen, index: dict[str, int], row: int) -> Array:
    """Return the masses of all bodies, for velocities of the points of the bodies that are at the origin."""
    out = np.zeros((3 * len(index), 3 * len(index)))
    for name, k in index.items():
        body, centre = seen.motion.bodies[name], seen.centres[name]
        x, y, m = float(centre.x[row]), float(centre.y[row]), body.mass
        out[k : k + 3, k : k + 3] = [[m, 0, -m * y], [0, m, m * x], [-m * y, m * x, body.inertia + m * (x * x + y * y)]]
    return out


def loads_of(seen: Seen, index: dict[str, int], row: int) -> dict[str, Array]:
    """Return forces (N) and moments about the origin (N m) on all bodies, by cause, those that act at all."""
    motion, out = seen.motion, {}

    def add(cause: str, body: str, at: tuple[float, float], force: Wrench) -> None:
        if body in index:
            values = out.setdefault(cause, np.zeros(3 * len(index)))
            k = index[body]
            values[k : k + 3] += [force[0], force[1], force[2] + at[0] * force[1] - at[1] * force[0]]

    for force in motion.forces.values():
        for action in force.actions:
            wrench = (action.fx[row], action.fy[row], action.torque[row])
            add(_cause(force), action.body, (action.x[row], action.y[row]), wrench)
    for contact in motion.contacts.values():
        at = contact.acts or contact
        place, torque = (at.x[row], at.y[row]), at.torque[row]
        fx, fy = contact.fx[row], contact.fy[row]
        add("contact", contact.bodies[1], place, (fx, fy, torque))
        add("contact", contact.bodies[0], place, (-fx, -fy, -torque))
    for name, body in motion.bodies.items():
        centre = seen.centres[name]
        at = float(centre.x[row]), float(centre.y[row])
        add("weight", name, at, (body.mass * motion.gravity[0], body.mass * motion.gravity[1], 0.0))
        inertia = (-body.mass * float(centre.ax[row]), -body.mass * float(centre.ay[row]))
        add("inertia", name, at, (*inertia, -body.inertia * body.alpha[row]))
    return {cause: values for cause, values in out.items() if values.any()}


def _cause(force: ForceMotion) -> str:
    if force.gas is not None:
        return "gas"
    if force.hydraulics is not None:
        return "oil"
    if force.measures == "gap":
        return "contact"
    if np.any(force.potential):
        return "spring"
    if force.drives and len(force.actions) == 2:
        return "drive"
    return "load"


def _on_pair(index: dict[str, int], bodies: tuple[str, str], wrench: Wrench) -> Array:
    """Return a column: a force on the second body and its opposite on the first."""
    column = np.zeros(3 * len(index))
    for body, sign in zip(bodies, (-1.0, 1.0), strict=True):
        if body in index:
            column[index[body] : index[body] + 3] += sign * np.array(wrench)
    return column


def _ways(seen: Seen, joint: JointMotion, row: int) -> Iterable[Wrench]:
    """Return unit forces and torques that a joint can give its second body where it acts."""
    if joint.pair == "pin":
        return (1.0, 0.0, 0.0), (0.0, 1.0, 0.0)
    if joint.pair is not None and joint.shape is not None:
        first = joint.shape.bodies[0]
        angle = joint.shape.markers[0][2] + (seen.theta[first][row] if first in seen.theta else 0.0)
        across = (-math.sin(angle), math.cos(angle), 0.0)
        return (across, (0.0, 0.0, 1.0)) if joint.pair == "guide" else (across,)
    wrench = np.array([joint.fx[row], joint.fy[row], (joint.acts or joint).torque[row]])
    size = float(np.abs(wrench).max())
    return (tuple((wrench / size).tolist()),) if size else ((0.0, 0.0, 1.0),)


def _is_rigid(seen: Seen, joint: JointMotion) -> bool:
    """Return True if a joint holds both bodies together in more ways than its recorded force tells."""
    first, second = (seen.theta.get(body, np.zeros(1)) for body in joint.bodies)
    return joint.pair is None and float(np.ptp(second - first)) < 1e-9 and (any(joint.fx) or any(joint.fy))


def _effort(driver: DriverMotion, row: int) -> list[Wrench]:
    """Return the unit effort of a driver on its second body about the origin."""
    if driver.effort_unit == "N m":
        return [(0.0, 0.0, 1.0)]
    second = driver.bodies[1] if driver.bodies else ""
    for action in driver.actions:
        if action.body == second:
            fx, fy = action.fx[row], action.fy[row]
            size = math.hypot(fx, fy)
            if size:
                x, y = action.x[row], action.y[row]
                return [(fx / size, fy / size, (x * fy - y * fx + action.torque[row]) / size)]
    return []
