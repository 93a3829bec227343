"""Starts: copies of a mechanism that begin elsewhere, and phases of gears with play.

Copies differ in start, drivers or forces; bodies and joints are shared. The phase of a mesh with play is the constant
of its equation. It belongs to the packed mechanism, as the phases of gears without play do
(mbsd/kinematics/pose/phases.py).
"""

from __future__ import annotations

import copy
import math
from dataclasses import replace
from typing import Any, TypeVar

import numpy as np

from mbsd.arrays.packing import Packed
from mbsd.arrays.reactions import marker_axes, marker_places
from mbsd.arrays.states import own_states, states_of, without_states
from mbsd.base.arguments import law_of
from mbsd.model.force import Force
from mbsd.model.laws import polynomial
from mbsd.model.mechanism import Model, Start, StartVelocity

AnyModel = TypeVar("AnyModel", bound=Model)


def copied(m: AnyModel) -> AnyModel:
    """Return a mechanism with the same bodies; what is added to the copy is not in the original."""
    out = copy.copy(m)
    for name in ("bodies", "joints", "drivers", "forces", "contacts", "events", "traces", "starts", "velocities"):
        setattr(out, name, dict(getattr(m, name)))
    return out


def held(m: AnyModel, time: float) -> AnyModel:
    """Return the mechanism with its drivers held still where their laws are at ``time`` (s).

    Raises ModelError for a law whose derivatives are not its own, as a motion does; what it does later does not matter.
    """
    out = copied(m)
    for name, driver in m.drivers.items():
        assert driver.motion is not None
        with law_of(f"{m.name}: driver '{name}'"):
            law = driver.motion.over(time, time)
            value = float(law(np.array([time]))[0, 0])
            if law.given_derivatives:
                law.check_derivatives_at(time)
        out.drivers[name] = type(driver)(driver.kind, name, driver.i, driver.j, driver.params, polynomial(value))
    return out


def started_at(m: AnyModel, packed: Packed, q: np.ndarray, v: np.ndarray, states: np.ndarray | None = None) -> AnyModel:
    """Return the mechanism started exactly at q, v (3 nb,), with ``states`` (n,) of its forces if known.

    States are in SI units.

    Those of a mechanism that is packed with its states are in v.
    """
    if packed.states:
        states, packed = states_of(packed, v), without_states(packed)
    out = copied(m)
    for force in packed.forces:
        if states is not None and force.kind.states is not None:
            own = states[own_states(packed.forces, force.name)].tolist()
            params = {**force.params, **dict(zip(force.kind.states.names, own, strict=True))}
            out.forces[force.name] = replace(force, params=params)
        if force.kind.restarted is not None:
            _, first, second = world_angles(packed, force, q)
            params = force.kind.restarted(force, second - first - packed.phases.get(force.name, second - first))
            out.forces[force.name] = replace(force, params={**force.params, **params})
        if force.kind.ideal is not None:
            out.forces[force.name] = replace(force, params=placed_params(packed, force, q))
    out.starts, out.velocities = {}, {}
    for b, name in enumerate(packed.body_names[1:], start=1):
        x, y, theta = q[3 * b : 3 * b + 3]
        vx, vy, omega = v[3 * b : 3 * b + 3]
        c, s = math.cos(theta), math.sin(theta)
        arm_x = c * packed.com[b, 0] - s * packed.com[b, 1]
        arm_y = s * packed.com[b, 0] + c * packed.com[b, 1]
        out.starts[name] = Start(float(theta), (float(x - arm_x), float(y - arm_y)))
        out.velocities[name] = StartVelocity(float(omega), (float(vx + omega * arm_y), float(vy - omega * arm_x)))
    return out


def take_force_phases(packed: Packed, q: np.ndarray) -> None:
    """Take the constants of all meshes from the start pose q (3 nb,)."""
    for force in packed.forces:
        if force.kind.counts_turn:
            _, first, second = world_angles(packed, force, q)
            packed.phases[force.name] = second - first
        if force.kind.mesh is not None:
            line, first, second = world_angles(packed, force, q)
            phase = force.params["phase"]
            if phase is not None:
                first, second = phase[0] + force.i.angle, phase[1] + force.j.angle
            packed.phases[force.name] = force.kind.mesh.rolled(force, line, first, second)


def world_angles(packed: Packed, force: Force, q: np.ndarray) -> tuple[float, float, float]:
    """Return angles (rad) of the line from marker i to j, and of both markers, in the pose q (3 nb,)."""
    i, j = packed.markers_of(force)
    bi, bj = (int(packed.system.marker_body[marker]) for marker in (i, j))
    away = marker_places(packed, q[None], j)[0] - marker_places(packed, q[None], i)[0]
    line = math.atan2(away[1], away[0])
    return line, float(q[3 * bi + 2]) + force.i.angle, float(q[3 * bj + 2]) + force.j.angle


def relative_poses(packed: Packed, force: Force, q: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return (T,) x, y (m) and angle (rad) of marker j in the axes of marker i along q (T, 3 nb)."""
    i, j = packed.markers_of(force)
    bi, bj = (int(packed.system.marker_body[marker]) for marker in (i, j))
    away = marker_places(packed, q, j) - marker_places(packed, q, i)
    x, y = ((marker_axes(packed, q, i, turned) * away).sum(axis=1) for turned in (False, True))
    return x, y, q[:, 3 * bj + 2] + force.j.angle - q[:, 3 * bi + 2] - force.i.angle


def placed_params(packed: Packed, force: Force, q: np.ndarray) -> dict[str, Any]:
    """Return params with which a force in place of a joint starts as it stands in q (3 nb,)."""
    out = {**force.params, "start": None}
    if force.kind.mesh is None:
        return out
    line, first, second = world_angles(packed, force, q)
    rolled = force.kind.mesh.rolled
    now, ahead = rolled(force, line, first, second), rolled(force, line, first, second + 1.0)
    own = force.kind.interactions(force, packed.masses)[0].numbers[0]
    middle = packed.phases.get(force.name, now) + own - now
    return {**out, "phase": (first - force.i.angle, second - force.j.angle + middle / (ahead - now))}
