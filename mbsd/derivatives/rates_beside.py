"""Compiled: accelerations of independent coordinates at states beside a motion."""

from __future__ import annotations

from mbsd.compiling.jit import kernel
from mbsd.dynamics.embedding.equations import accelerate, settle

FIRST = 3
"""Entries of a state before its coordinates."""


@kernel
def rates_beside(dyn, scratch, t, states, sensitivity, out):
    """Fill out (T, S, f) with z'' at states (T, S, 2, 3 + f) and t (T,), the first of each time that of the motion.

    Poses are predicted from there, time by time. sensitivity (1,) takes the largest rate of a body for one unit of a
    coordinate. Returns at how many times all states had a clear pose.
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
                settle(dyn, scratch, t[k], states[k, s], True)
                sensitivity[0] = max(sensitivity[0], scratch.watch[0])
    return states.shape[0]
