"""Copies of a mechanism that differ in start, drivers or forces; bodies and joints are shared."""

from __future__ import annotations

import copy
import math
from dataclasses import replace
from typing import TypeVar

import numpy as np

from mbsd.arrays.force_phases import placed_params
from mbsd.arrays.packing import Packed
from mbsd.arrays.states import own_states, states_of, without_states
from mbsd.base.users_function import law_of
from mbsd.model.laws import polynomial
from mbsd.model.mechanism import Model, Start, StartVelocity

AnyModel = TypeVar("AnyModel", bound=Model)


def copied(m: AnyModel) -> AnyModel:
    """A mechanism of its own with the same bodies: what is added to the copy is not in the original."""
    out = copy.copy(m)
    for name in ("bodies", "joints", "drivers", "forces", "contacts", "events", "traces", "starts", "velocities"):
        setattr(out, name, dict(getattr(m, name)))
    return out


def held(m: AnyModel, time: float) -> AnyModel:
    """The same mechanism with its drivers holding still where their laws are at ``time`` (s).

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
