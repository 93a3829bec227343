"""States of forces through a motion, such as a cylinder's pressures, as bodies of a packed mechanism.

    s' = f(t, q, v, s)        as   P'' = f,  P' = s:   a body of mass 1 that slides along the x axis of ground

So every integrator, both formulations, events, restarts and tolerances know states without a word of their own: they
are velocities. Where a body is, P, is the integral of its state and means nothing. A state of ``States.one`` is a speed
of one size of the mechanism a second, and is kept to the same tolerance. These bodies stand behind all others of the
packed mechanism and are none of its solution, which has their velocities as states.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from mbsd.equations.system import Workspace

if TYPE_CHECKING:
    from mbsd.arrays.packing import Packed
    from mbsd.model.force import Force


SPACE = "\u00a0"
"""It does not break, and stands in the name of no body that an author adds."""


def holding_names(force: Force) -> list[str]:
    """Return names of the bodies that hold the states of a force."""
    return [] if force.kind.states is None else [f"{force.name}{SPACE}({name})" for name in force.kind.states.names]


def first_holding(force: Force, number: Mapping[str, int]) -> tuple[int, int]:
    """Return the first body that holds a state of a force, and their number.

    The number is 0 if only the mechanism is packed.
    """
    names = holding_names(force)
    return (number[names[0]], len(names)) if names and names[0] in number else (0, 0)


def with_states(packed: Packed) -> Packed:
    """Return the mechanism with a body for each state of its forces; itself where no force has any."""
    names = [name for force in packed.forces for name in holding_names(force)]
    if packed.states or not names:
        return packed
    count, system = len(names), packed.system
    system = system.changed(
        mass=np.concatenate([system.mass, np.ones(count)]), inertia=np.concatenate([system.inertia, np.ones(count)])
    )
    return replace(
        packed,
        body_names=[*packed.body_names, *names],
        com=np.concatenate([packed.com, np.zeros((count, 2))]),
        system=system,
        ws=_scratch_for(packed.ws, len(system.mass)),
        constant=None,
        states=count,
    )


def without_states(packed: Packed) -> Packed:
    """Return the mechanism without the bodies that hold states."""
    if not packed.states:
        return packed
    end, system = len(packed.body_names) - packed.states, packed.system
    system = system.changed(mass=system.mass[:end].copy(), inertia=system.inertia[:end].copy())
    return replace(
        packed,
        body_names=packed.body_names[:end],
        com=packed.com[:end],
        system=system,
        ws=_scratch_for(packed.ws, len(system.mass)),
        states=0,
    )


def _scratch_for(ws: Workspace, bodies: int) -> Workspace:
    """Return the scratch for another number of bodies; what equations remember stays."""
    cos_sin = np.zeros((bodies, 2))
    cos_sin[:, 0] = 1.0
    return ws._replace(cos_sin=cos_sin, pose=np.zeros(3 * bodies), delta=np.zeros((2, 3 * bodies)))


def ones_of(packed: Packed) -> np.ndarray:
    """Return (n,) what a speed of 1 m/s of each body that holds a state stands for (SI)."""
    return np.array(
        [
            force.kind.states.one(force) / packed.size
            for force in packed.forces
            if force.kind.states is not None
            for _ in force.kind.states.names
        ]
    )


def columns_of(packed: Packed) -> np.ndarray:
    """Return (n,) columns of the states in q, v of a mechanism packed with them."""
    return 3 * np.arange(len(packed.body_names) - packed.states, len(packed.body_names))


def states_of(packed: Packed, v: np.ndarray) -> np.ndarray:
    """Return (..., n) states (SI) from velocities (..., 3 nb) of a mechanism packed with them."""
    return v[..., columns_of(packed)] * ones_of(packed)


def widened(packed: Packed, part: np.ndarray, states: np.ndarray | None = None) -> np.ndarray:
    """Return q, v or a (..., 3 nb) with columns for the bodies of states (..., n) (SI).

    The columns are zero if ``states`` is None.
    """
    out = np.zeros((*part.shape[:-1], 3 * len(packed.body_names)))
    out[..., : part.shape[-1]] = part
    if states is not None:
        out[..., columns_of(packed)] = states / ones_of(packed)
    return out


def own_states(forces: Sequence[Force], name: str) -> slice:
    """Return which of all states belong to the force ``name``."""
    at = 0
    for force in forces:
        count = len(holding_names(force))
        if force.name == name:
            return slice(at, at + count)
        at += count
    raise KeyError(name)
