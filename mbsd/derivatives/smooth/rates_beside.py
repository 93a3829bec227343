"""Compiled: accelerations of independent coordinates at states beside a motion, and motions of the bodies there."""

from __future__ import annotations

from typing import Any, NamedTuple

from mbsd.compiling.jit import internal, kernel
from mbsd.dynamics.independent.equations import accelerate, evaluate, place_all, settle
from mbsd.kinematics.groups.carried import BASE, NEAR, THETA

FIRST = 3
"""Entries of a state before its coordinates."""


class Held(NamedTuple):
    """A motion at T times as its forces see it."""

    rate: Any
    """(T, nb, 3 (C + 1)) as EmbeddingScratch has it; so is cos_sin."""
    cos_sin: Any
    pose: Any
    """(T, 2, 3 nb) places and velocities."""


@internal
def hold(scratch, rates, held, k):
    """Keep what was evaluated last."""
    place_all(scratch, rates, False, held.pose[k], scratch.force)
    for b in range(scratch.rate.shape[0]):
        for c in range(scratch.rate.shape[1]):
            held.rate[k, b, c] = scratch.rate[b, c]
        for c in range(2):
            held.cos_sin[k, b, c] = scratch.cos_sin[b, c]


@kernel
def rates_beside(dyn, scratch, t, states, held, sensitivity, out):
    """Fill out (T, S, f) with z'' at states (T, S, 2, 3 + f) and t (T,), the first of each time that of the motion.

    Poses are predicted from there, time by time; ``held`` keeps them. sensitivity (1,) takes the largest rate of a body
    for one unit of a coordinate. Returns at how many times all states had a clear pose.
    """
    rates = scratch.stages[0, 1]
    for k in range(states.shape[0]):
        for s in range(states.shape[1]):
            power = accelerate(dyn, scratch, t[k], states[k, s], rates, scratch.multipliers)
            if power != power:
                return k
            for i in range(out.shape[2]):
                out[k, s, i] = rates[FIRST + i]
            if s == 0:
                hold(scratch, rates, held, k)
                settle(dyn, scratch, t[k], states[k, s], True)
                sensitivity[0] = max(sensitivity[0], scratch.watch[0])
    return states.shape[0]


@kernel
def motions_beside(dyn, scratch, t, q, z, states, forces, y, a):
    """Fill y (R, 2, 3 nb), and with ``forces`` a (R, 3 nb), with motions of bodies at states (R, 2, 3 + f) and t (R,).

    They are near poses q (R, 3 nb) of the motion, whose coordinates are z (R, 3 + f). Returns at how many times they
    had a clear pose.
    """
    rates = scratch.stages[0, 1]
    last = scratch.coordinate.shape[0] - 1
    for k in range(states.shape[0]):
        for b in range(scratch.base.shape[0]):
            for c in range(scratch.base.shape[1]):
                scratch.base[b, c] = 0.0
            scratch.base[b, THETA] = q[k, 3 * b + 2]
        for j in range(last + 1):
            scratch.coordinate[j, BASE] = z[k, FIRST + j] if j < z.shape[1] - FIRST else t[k]
        for e in range(dyn.number.shape[0]):
            dyn.number[e, NEAR] = 1.0
        power = evaluate(dyn, scratch, t[k], states[k], rates, forces)
        if power != power:
            return k
        place_all(scratch, rates, forces, y[k], a[k])
    return states.shape[0]
