"""Steps in independent coordinates that end where the pin of a Geneva enters or leaves its slot.

The wheel's acceleration jumps there. In reference coordinates what a step across the jump gets wrong is an impulse of
the joint, which the projection takes off again; in independent ones it is the speed of the crank, so that each index
would change the energy by about the tolerance. So a step ends right before the jump, and the next one begins right
after it with new derivatives, as at jumps of laws (prepare/stops.py).

    x - r = 0      x: the wheel's centre along the crank's axis, r: radius of the pin
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from mbsd.compiling.alternatives import alternatives
from mbsd.compiling.jit import inlined, internal, kernel, lazy
from mbsd.dynamics.independent.arrays import Embedding, EmbeddingScratch
from mbsd.dynamics.independent.equations import write_alone
from mbsd.dynamics.integrators.advance import USUAL, advance_past_jumps, copy_state
from mbsd.dynamics.state import ACCEPTED, ERROR, NEXT, PAUSED, REACHED, STARTED, STEP, TIME, WORK, State, output_for

if TYPE_CHECKING:
    from mbsd.arrays.packing import Packed

CRANK, WHEEL = range(2)
"""Columns of Genevas.body."""
ARM_X, ARM_Y, AXIS_X, AXIS_Y, TO_X, TO_Y, RADIUS = range(7)
"""Columns of Genevas.number: the crank's marker and its x axis in the axes of its body, the wheel's marker in those of
its own, radius of the pin (m)."""


class Memory(NamedTuple):
    """Arrays of Embedding and EmbeddingScratch, by their names there, from which the next poses are predicted."""

    number: Any
    base: Any
    coordinate: Any
    block_work: Any
    body: Any
    watch: Any


class Genevas(NamedTuple):
    """g Genevas of a run with f coordinates and nb bodies."""

    body: Any
    """(g, 2) int"""
    number: Any
    """(g, 7)"""
    gap: Any
    """(2, g) x - r (m) of where steps begin, and of where they lead."""
    here: Any
    """mbsd.dynamics.state.Output of one time."""
    state: Any
    """(2, 3 + f)"""
    stage: Any
    """(2, 3 + f)"""
    before: Any
    """mbsd.dynamics.state.State: a point to return to."""
    kept: Memory
    """As it was there."""


_NOTHING = tuple(np.zeros((0,) * dimensions) for dimensions in (2, 2, 2, 1, 2, 1))
"""In place of what steps in independent coordinates predict from."""


def genevas_of(packed: Packed, state: State, arrays: Embedding, scratch: EmbeddingScratch) -> Genevas | None:
    """Return the Genevas of a run in independent coordinates at its start, or None without any."""
    rows = _rows(packed)
    if not rows:
        return None
    memory = arrays.number, scratch.base, scratch.coordinate, scratch.block_work, scratch.body, scratch.watch
    width = state.y.shape[1]
    return _genevas(rows, 3 * len(packed.body_names), width, State(*(np.zeros_like(part) for part in state)), memory)


def no_genevas(state: State) -> Genevas:
    """Return empty arrays, as for runs in reference coordinates, where steps end anywhere."""
    return _genevas([], 0, 0, State(*(np.zeros((0,) * part.ndim, part.dtype) for part in state)), _NOTHING)


def _genevas(
    rows: list[tuple[float, ...]], coordinates: int, width: int, before: State, memory: tuple[np.ndarray, ...]
) -> Genevas:
    return Genevas(
        np.array([row[:2] for row in rows], np.int64).reshape(-1, 2),
        np.array([row[2:] for row in rows], float).reshape(-1, RADIUS + 1),
        np.zeros((2, len(rows))),
        output_for(np.zeros(min(len(rows), 1)), coordinates, 0),
        np.zeros((2, width)),
        np.zeros((2, width)),
        before,
        Memory(*(np.zeros_like(part) for part in memory)),
    )


def _rows(packed: Packed) -> list[tuple[float, ...]]:
    """Return the numbers of Genevas.body and Genevas.number of each."""
    specials, system = packed.specials, packed.system
    return [
        (
            *(int(system.marker_body[marker]) for marker in place[:2]),
            *system.marker_arm[place[0]].tolist(),
            *system.marker_axis[place[0]].tolist(),
            *system.marker_arm[place[1]].tolist(),
            float(joint.params["radius"]),
        )
        for name, joint, place in zip(specials.names, specials.joints, specials.places, strict=True)
        if name == "geneva"
    ]


SHORT = 1e-3
"""Part of the way to the jump that is left, so that Newton's steps do not go beyond it."""
MOST = 60
SIDE = 1e-300
"""A gap (m) that has a sign, and no size."""
NEAR = 3.0
"""Steps from which on a jump is gone for."""
MOST_UNSEEN = 10
"""Steps that are taken before it is asked again how far the next jump is."""
ROUNDING = 8
"""Rounding of the time, in neighbouring numbers: a jump is not found closer than this."""


@internal
def _ulp(t):
    """Return the distance to the next larger number."""
    return math.nextafter(abs(t), math.inf) - abs(t)


@internal
def _copy_table(target, source):
    for row in range(target.shape[0]):
        for column in range(target.shape[1]):
            target[row, column] = source[row, column]


@internal
def _copy_line(target, source):
    for k in range(target.shape[0]):
        target[k] = source[k]


@internal
def _keep(dyn, scratch, state, genevas):
    """Make this a point to return to."""
    copy_state(genevas.before, state)
    kept = genevas.kept
    _copy_table(kept.number, dyn.number)
    _copy_table(kept.base, scratch.base)
    _copy_table(kept.coordinate, scratch.coordinate)
    _copy_line(kept.block_work, scratch.block_work)
    _copy_table(kept.body, scratch.body)
    _copy_line(kept.watch, scratch.watch)


@internal
def _return(dyn, scratch, state, genevas):
    """Return to where the state was kept."""
    copy_state(state, genevas.before)
    kept = genevas.kept
    _copy_table(dyn.number, kept.number)
    _copy_table(scratch.base, kept.base)
    _copy_table(scratch.coordinate, kept.coordinate)
    _copy_line(scratch.block_work, kept.block_work)
    _copy_table(scratch.body, kept.body)
    _copy_line(scratch.watch, kept.watch)


@internal
def _look(dyn, scratch, genevas, state, gap):
    """Fill ``gap`` (g,), x - r of each (m); the time until the first is zero if they go on as they go (s)."""
    own = genevas.state
    for part in range(2):
        for c in range(own.shape[1]):
            own[part, c] = state.y[part, c]
            genevas.stage[part, c] = 0.0
    write_alone(dyn, scratch, state.clock[TIME], own, genevas.stage, genevas.here, 0)
    q = genevas.here.y[0, 0]
    v = genevas.here.y[0, 1]
    wait = math.inf
    for k in range(genevas.body.shape[0]):
        i = 3 * genevas.body[k, CRANK]
        j = 3 * genevas.body[k, WHEEL]
        number = genevas.number[k]
        c = math.cos(q[i + 2])
        s = math.sin(q[i + 2])
        d = math.cos(q[j + 2])
        e = math.sin(q[j + 2])
        ux = c * number[AXIS_X] - s * number[AXIS_Y]
        uy = s * number[AXIS_X] + c * number[AXIS_Y]
        ax = c * number[ARM_X] - s * number[ARM_Y]
        ay = s * number[ARM_X] + c * number[ARM_Y]
        bx = d * number[TO_X] - e * number[TO_Y]
        by = e * number[TO_X] + d * number[TO_Y]
        dx = q[j] + bx - q[i] - ax
        dy = q[j + 1] + by - q[i + 1] - ay
        turn = v[i + 2]
        other = v[j + 2]
        vx = v[j] - other * by - v[i] + turn * ay
        vy = v[j + 1] + other * bx - v[i + 1] - turn * ax
        gap[k] = ux * dx + uy * dy - number[RADIUS]
        rate = ux * vx + uy * vy + turn * (ux * dy - uy * dx)
        if gap[k] * rate < 0.0:
            wait = min(wait, -gap[k] / rate)
    return wait


@internal
def _crossed(before, after):
    """Return True if a jump lies between them."""
    crossed = False
    for k in range(before.shape[0]):
        crossed = crossed or before[k] * after[k] < 0.0
    return crossed


@internal
def _stand(gap, after):
    """Make ``gap`` those ``after``; one of exactly zero counts to the side it came from."""
    for k in range(gap.shape[0]):
        if after[k] != 0.0:
            gap[k] = after[k]
        elif gap[k] != 0.0:
            gap[k] = math.copysign(SIDE, gap[k])


@internal
def _finish(dyn, scratch, state, out):
    """Write outputs that the hop over a jump left behind."""
    k = state.count[NEXT]
    while k < out.t.shape[0] and out.t[k] <= state.clock[TIME]:
        write_alone(dyn, scratch, state.clock[TIME], state.y, scratch.stages[0], out, k)
        out.work[k] = state.clock[WORK]
        k += 1
    state.count[NEXT] = k


@internal
def _meet(dyn, scratch, state, out, settings, genevas, wait, late, before, after):
    """Go on to right after the next jump, which is before ``late`` (s); if it moves away, only towards it.

    ``wait`` and gap[0] are what ``_look`` says of the state.
    """
    here = genevas.gap[0]
    there = genevas.gap[1]
    near = False
    nears = wait < math.inf
    for _ in range(MOST):
        now = state.clock[TIME]
        least = ROUNDING * _ulp(now)
        if wait * SHORT <= least or late - now <= 4 * least:
            near = True
            break
        if wait == math.inf and late == math.inf:
            return PAUSED
        target = now + wait * (1.0 - SHORT)
        if not target < late - least:
            target = now + 0.5 * (late - now)
        _keep(dyn, scratch, state, genevas)
        status = advance_past_jumps(dyn, scratch, state, out, settings, target, MOST, before, after, USUAL)
        if status != REACHED and status != PAUSED:
            return status
        later = _look(dyn, scratch, genevas, state, there)
        zero = False
        for k in range(there.shape[0]):
            zero = zero or there[k] == 0.0
        if _crossed(here, there):
            late = state.clock[TIME]
            _return(dyn, scratch, state, genevas)
            share = 0.5  # it may have left one jump and come to the next
            if nears:
                share = math.inf
                for k in range(here.shape[0]):
                    if here[k] * there[k] < 0.0:
                        share = min(share, here[k] / (here[k] - there[k]))
            wait = share * (late - state.clock[TIME])
        elif zero:
            wait = 0.0
            near = True
            break
        else:
            for k in range(here.shape[0]):
                here[k] = there[k]
            wait = later
            nears = wait < math.inf
    if not near:
        return PAUSED
    hop = min(wait, late - state.clock[TIME]) + ROUNDING * _ulp(state.clock[TIME])
    _keep(dyn, scratch, state, genevas)
    while True:  # rates are those before the jump, over a time that does not matter
        if hop > SHORT * settings.longest:
            _return(dyn, scratch, state, genevas)
            return PAUSED
        state.clock[TIME] += hop
        for c in range(state.y.shape[1]):
            state.y[0, c] += hop * state.y[1, c]
        _look(dyn, scratch, genevas, state, there)
        if _crossed(here, there):
            break
        hop *= 2.0  # the angles may round to what they were
    state.count[STARTED] = 0
    return PAUSED


@lazy(int)
def _index(dyn, scratch, state, out, settings, genevas, end, steps, before, after):
    here = genevas.gap[0]
    there = genevas.gap[1]
    wait = _look(dyn, scratch, genevas, state, here)
    while True:
        step = state.clock[STEP] if state.clock[STEP] != 0.0 else settings.longest
        accepted = state.count[ACCEPTED]
        late = math.inf
        now = state.clock[TIME]
        meets = wait < min(NEAR * step, end - now)
        status = PAUSED
        if not meets:
            _keep(dyn, scratch, state, genevas)
            ahead = int(min(max(wait / (4.0 * step), 1.0), MOST_UNSEEN))
            status = advance_past_jumps(
                dyn, scratch, state, out, settings, end, min(ahead, steps), before, after, USUAL
            )
            later = _look(dyn, scratch, genevas, state, there)
            meets = _crossed(here, there)
            if meets:
                late = state.clock[TIME]
                _return(dyn, scratch, state, genevas)
            else:
                _stand(here, there)
                wait = later
        if meets:
            status = _meet(dyn, scratch, state, out, settings, genevas, wait, late, before, after)
            wait = _look(dyn, scratch, genevas, state, here)
        if status == PAUSED and state.clock[TIME] == now:  # it cannot be met: a step goes over it
            status = advance_past_jumps(dyn, scratch, state, out, settings, end, 1, before, after, USUAL)
            wait = _look(dyn, scratch, genevas, state, here)
        if state.count[STARTED] == 0:
            state.clock[STEP] = step
            state.clock[ERROR] = 0.0
        steps -= state.count[ACCEPTED] - accepted
        if status != REACHED and status != PAUSED:
            return status
        if state.clock[TIME] >= end:
            _finish(dyn, scratch, state, out)
            return REACHED
        if steps <= 0:
            return PAUSED


@inlined
def _never(dyn, scratch, state, out, settings, genevas, end, steps, before, after):
    return PAUSED


index = alternatives({Embedding: _index}, _never)
"""``advance_past_jumps`` by the usual integrator, from jump to jump of Genevas; never in reference coordinates."""


@kernel
def run_indexed(dyn, scratch, state, out, settings, genevas, end, steps, before, after):
    """Call ``index`` in independent coordinates, from Python."""
    return _index(dyn, scratch, state, out, settings, genevas, end, steps, before, after)
