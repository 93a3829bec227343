"""Chooses the few numbers of a mechanism that fit into a line."""

from __future__ import annotations

import numpy as np

from render.report.transmission import loops
from render.report.written import Amounts, counted, degrees, moment, speed, written
from shared.contract import BodyMotion, Motion, Parts
from shared.contract.clearance import Clearance


def facts(motion: Motion, parts: Parts | None, clearance: Clearance | None) -> list[str]:
    """Freedoms, time, fastest place, largest effort and reaction, transmission angle, mass, clearance."""
    span, amount = motion.time[-1] - motion.time[0], Amounts(motion)
    out = [f"{counted(motion.diagnostics.dof, 'degree')} of freedom"]
    out.append(f"repeats after {moment(motion.period)}" if motion.period else f"{moment(span)} of motion")
    name, most = fastest(motion)
    if amount.without_noise(most, "m/s"):
        out.append(f"{name} reaches {speed(most)}")
    forces = {name: float(np.hypot(joint.fx, joint.fy).max()) for name, joint in motion.joints.items()}
    largest = max(forces.values(), default=0.0)
    for name, driver in motion.drivers.items():
        effort = float(np.abs(driver.effort).max())
        if amount.without_noise(effort, driver.effort_unit):
            out.append(f"{name} up to {written(effort, driver.effort_unit)}")
    if not any(np.any(driver.effort) for driver in motion.drivers.values()):
        out += [f"{name} up to {size}" for name, size in _efforts(motion)[:2]]
    if amount.without_noise(largest, "N"):
        most = max(forces, key=lambda name: forces[name])
        out.append(f"largest reaction {written(largest, 'N')} at {most}")
    out += [f"transmission angle from {degrees(float(loop.transmission.min()))}" for loop in loops(motion)[:1]]
    moving = sum(body.mass for body in motion.bodies.values())
    if parts is not None:
        pieces = sum(len(body.pieces) for body in parts.bodies.values())
        out.append(f"{written(moving, 'kg')} moving, {counted(pieces, 'piece')}")
    if clearance is not None and clearance.pairs:
        out.append(f"parts stay {written(min(pair.gap for pair in clearance.pairs), 'm')} apart")
    return out


def fastest(motion: Motion) -> tuple[str, float]:
    """The traced point, joint or body (by its centre of mass) that is the fastest at any time, and its speed (m/s)."""
    speeds = {name: _speed_of(body) for name, body in motion.bodies.items()}
    speeds |= {name: float(np.hypot(point.vx, point.vy).max()) for name, point in motion.points.items()}
    speeds |= {name: v for name, v in _joint_speeds(motion).items() if name not in speeds}
    name = max(speeds, key=lambda entry: speeds[entry])
    return name, speeds[name]


def _speed_of(body: BodyMotion) -> float:
    """Speed of its centre of mass (m/s)."""
    (x, y), omega, theta = body.com, np.array(body.omega), np.array(body.theta)
    vx = np.array(body.vx) - omega * (np.sin(theta) * x + np.cos(theta) * y)
    vy = np.array(body.vy) + omega * (np.cos(theta) * x - np.sin(theta) * y)
    return float(np.hypot(vx, vy).max())


def _efforts(motion: Motion) -> list[tuple[str, str]]:
    """Peak efforts of what moves the mechanism where no driver does, those that give most power first."""
    efforts = []
    for name, force in motion.forces.items():
        if force.drives and force.effort is not None and np.any(force.effort) and max(force.power) > 0:
            efforts.append((max(force.power), name, written(float(np.abs(force.effort).max()), force.effort_unit)))
    return [(name, size) for _, name, size in sorted(efforts, key=lambda entry: -entry[0])]


def _joint_speeds(motion: Motion) -> dict[str, float]:
    """Speeds of the second markers of joints, from their bodies' frames (m/s)."""
    out = {}
    for name, joint in motion.joints.items():
        body = motion.bodies.get(joint.bodies[1])
        if body is None:
            continue
        omega = np.array(body.omega)
        vx = np.array(body.vx) - omega * (np.array(joint.y) - np.array(body.y))
        vy = np.array(body.vy) + omega * (np.array(joint.x) - np.array(body.x))
        out[name] = float(np.hypot(vx, vy).max())
    return out
