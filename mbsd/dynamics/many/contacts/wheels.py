"""Steps while wheels that no body carries may run into each other: kinematics/limits/free_wheels.py, compiled.

A step takes two centres at most half their way to each other; where they meet, a single simulation says so.
"""

from __future__ import annotations

import math

from mbsd.compiling.jit import internal, lazy
from mbsd.dynamics.many.contacts.arrays import HALF, SHORTEST
from mbsd.dynamics.many.methods import USUAL
from mbsd.dynamics.many.through import copy_state, through
from mbsd.dynamics.state import ACCEPTED, PAUSED, REACHED, STEP_TOO_SMALL, TIME


@internal
def _line(system, y, i, j):
    """From marker i to marker j (m) in the world at y (2, 3 nb), and how that changes (m/s)."""
    x0 = 0.0
    x1 = 0.0
    v0 = 0.0
    v1 = 0.0
    for side in range(2):
        marker = j if side == 0 else i
        sign = 1.0 if side == 0 else -1.0
        b = 3 * system.marker_body[marker]
        c = math.cos(y[0, b + 2])
        s = math.sin(y[0, b + 2])
        px = c * system.marker_arm[marker, 0] - s * system.marker_arm[marker, 1]
        py = s * system.marker_arm[marker, 0] + c * system.marker_arm[marker, 1]
        x0 += sign * (y[0, b] + px)
        x1 += sign * (y[0, b + 1] + py)
        v0 += sign * (y[1, b] - y[1, b + 2] * py)
        v1 += sign * (y[1, b + 1] + y[1, b + 2] * px)
    return x0, x1, v0, v1


@internal
def _approach(system, wheels, before, after, h):
    """How far centres came nearer to each other in a step of h (s) between two y, over how far they may."""
    most = 0.0
    for k in range(wheels.markers.shape[0]):
        x0, x1, v0, v1 = _line(system, before, wheels.markers[k, 0], wheels.markers[k, 1])
        z0, z1, _, _ = _line(system, after, wheels.markers[k, 0], wheels.markers[k, 1])
        w0 = z0 - x0
        w1 = z1 - x1
        apart = math.sqrt(x0 * x0 + x1 * x1)
        part = min(max(-(x0 * w0 + x1 * w1) / max(w0 * w0 + w1 * w1, 1e-300), 0.0), 1.0)
        n0 = x0 + part * w0
        n1 = x1 + part * w1
        nearer = max(apart - math.sqrt(n0 * n0 + n1 * n1), -h * (x0 * v0 + x1 * v1) / apart)
        most = max(most, nearer / (wheels.bounds[HALF] * apart))
    return most


@internal
def _met(system, wheels, y):
    """Whether the centres of two wheels have met at y (2, 3 nb)."""
    met = False
    for k in range(wheels.markers.shape[0]):
        x0, x1, _, _ = _line(system, y, wheels.markers[k, 0], wheels.markers[k, 1])
        met = met or math.sqrt(x0 * x0 + x1 * x1) < wheels.near[k]
    return met


@lazy(int)
def _step_by_step(dyn, scratch, state, out, settings, wheels, end, steps, before, after):
    kept = wheels.before
    while True:
        copy_state(kept, state)
        target = end
        while True:
            status = through(dyn, scratch, state, out, settings, target, 1, before, after, USUAL)
            if status != REACHED and status != PAUSED:
                return status
            taken = state.clock[TIME] - kept.clock[TIME]
            farthest = _approach(dyn.system, wheels, kept.y, state.y, taken)
            if farthest <= 1.0 or taken <= wheels.bounds[SHORTEST] * settings.longest:
                break
            copy_state(state, kept)
            target = kept.clock[TIME] + taken / (2.0 * farthest)
        if _met(dyn.system, wheels, state.y):
            return STEP_TOO_SMALL
        steps -= state.count[ACCEPTED] - kept.count[ACCEPTED]
        if state.clock[TIME] >= end:
            return REACHED
        if steps <= 0:
            return PAUSED


@internal
def advance_to(dyn, scratch, state, out, settings, contacts, end, steps, before, after):
    """``through`` by the usual integrator, a step at a time where wheels may meet."""
    if contacts.wheels.markers.shape[0] > 0:
        return _step_by_step(dyn, scratch, state, out, settings, contacts.wheels, end, steps, before, after)
    return through(dyn, scratch, state, out, settings, end, steps, before, after, USUAL)
