"""Journals that start pressed into the walls of their bearings: no harder than by what they carry there.

A pin with play that starts ``start`` away from its bearing's middle (model/forces/clearance_joint.py) may stand in its
wall as deep as its load presses it, N = K d^n. What it carries is the reaction of the pin without play, at the same
start; a journal that is pressed in many times harder was put there by mistake, and would be shot out of its bearing.
"""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from mbsd.base.errors import MechanismError, SimulationError
from mbsd.dynamics.formulation import derivative
from mbsd.dynamics.prepare.prepared import PreparedDynamics
from mbsd.dynamics.reference.arrays import scratch_for
from mbsd.kinematics.pose.ideal_joints import with_ideal_joints
from mbsd.model.force import Press
from mbsd.model.mechanism import Model

SLIGHT = 0.01
"""Part of the clearance by which any journal may start in its wall."""
HARDER = 10.0
"""Times its load by which it may start pressed in: a load may grow right after the start."""


def presses(m: Model) -> dict[str, Press]:
    """By name, those journals of a mechanism that start in their walls by more than slightly."""
    own = {name: force.kind.press(force) for name, force in m.forces.items() if force.kind.press is not None}
    return {name: press for name, press in own.items() if press is not None and press.depth > SLIGHT * press.room}


def refuse_pressed(m: Model, start: float, end: float, prepared: Callable[..., PreparedDynamics]) -> None:
    """Raise SimulationError for a journal that starts pressed into its bearing, from ``start`` to ``end`` (s).

    ``prepared`` makes a mechanism ready for its dynamics.
    """
    deep = presses(m)
    if not deep:
        return
    joined = with_ideal_joints(m)
    assert joined is not None, "what starts as a pin does is one then"
    try:
        ideal = prepared(joined, start, end)
    except MechanismError:
        return  # without play it cannot move: what it carries is not known
    for name, press in deep.items():
        load = _reaction(ideal, name)
        if press.force > HARDER * load:
            raise SimulationError(
                f"{m.name}: force '{name}' starts with its journal {press.depth:.3g} m deep in the bearing's wall, "
                f"pressed in by {press.force:.3g} N, where a pin without play carries {load:.3g} N. Give start= within "
                f"its clearance of {press.room:g} m, or as deep as its load presses it; start=None leaves it where "
                "start_near puts it"
            )


def _reaction(ready: PreparedDynamics, name: str) -> float:
    """The force (N) that the pin ``name`` carries at the start."""
    packed, dynamics = ready.packed, ready.dynamics
    state = np.stack([ready.initial.q, ready.initial.v])
    out, lam = np.zeros_like(state), np.zeros(len(packed.ws.phi))
    derivative(dynamics, scratch_for(dynamics, packed.ws, len(packed.motions), 1), ready.start, state, out, lam)
    packed.specials.check()
    number = [joint.name for joint in packed.joints].index(name)
    return math.hypot(*lam[packed.first_row[number] : packed.first_row[number + 1]].tolist())
