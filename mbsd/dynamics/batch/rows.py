"""The compiled loop over simulations: each from its numbers to its last output, by the steps of a single one.

Between steps it does what Python does for a single simulation (prepare/stops.py, runs/): it ends steps where loads or
laws jump, meets events (events/loop.py), and goes on after. What it cannot go on with it leaves to Python, by the
status of the row. A second loop finds multipliers and Jacobians of states that are known.
"""

from __future__ import annotations

from typing import Any, NamedTuple

from mbsd.compiling.jit import inlined, internal, threaded
from mbsd.dynamics.events.loop import NOT_SOLVED, OVER, go_on
from mbsd.dynamics.formulation import derivative, observe
from mbsd.dynamics.genevas import index
from mbsd.dynamics.integrators.advance import advance_past_jumps
from mbsd.dynamics.repeated_rows import again, opens
from mbsd.dynamics.state import ACCEPTED, NEXT, PAUSED, REACHED, TIME, Output
from mbsd.equations.assembly import position

STOPPED, NEARLY_SINGULAR = -1, -3
"""Status of rows that were not computed because all was stopped, and of those that came near a singular pose."""
WAITING, UNDERWAY, KNOWN = -5, -6, -12
"""Status of rows that have not begun, of those that wait to be gone on with, and of those of which all is known."""

LOOKED_AT = 4000
"""Steps between two looks at the pace."""


class Numbers(NamedTuple):
    """Numbers of R rows: what makes the run in ``block`` that of a row."""

    block: Any
    """(N,) all arrays of numbers of a run."""
    fresh: Any
    """(R or 1, N) blocks of rows before their first step."""
    place: Any
    """(k,) int, places in the block where rows differ from these."""
    value: Any
    """(R, k)"""


class Course(NamedTuple):
    """How rows are stepped."""

    method: int
    """Number of the integrator (integrators/advance.py)."""
    before: Any
    """(n,) s: steps end there, and go on from ``after``."""
    after: Any
    at_once: int
    """Steps between two looks at ``stop``."""
    most: int
    """Steps altogether."""
    near: float
    """Where above 0, a row ends where its margin falls below this part of the largest so far (runs/motion.py)."""
    stop: Any
    """(1,) int, not zero where all is to stop."""


class Target(NamedTuple):
    """How far rows go, and where those are kept that wait to be gone on with."""

    upto: int
    """Outputs; with less than all, rows are then UNDERWAY."""
    passed: Any
    """(k, 4) part of the state, coordinate, value, and 1 where outputs are to come below it, not above."""
    least: int
    """Outputs that a row has at least: one that has met all of ``passed`` is then KNOWN."""
    kept: Any
    """(R, N + 1)"""
    counts: Any
    """(R, 8) int"""


@internal
def begin_row(numbers, r):
    """Make the run in the block that of row r before its first step."""
    block = numbers.block
    own = min(r, numbers.fresh.shape[0] - 1)
    for i in range(block.shape[0]):
        block[i] = numbers.fresh[own, i]
    for i in range(numbers.place.shape[0]):
        block[numbers.place[i]] = numbers.value[r, i]


@internal
def put_away(state, block, widest, kept, counts):
    """Keep a row that is underway, to be taken up again."""
    for i in range(block.shape[0]):
        kept[i] = block[i]
    kept[block.shape[0]] = widest
    for i in range(state.count.shape[0]):
        counts[i] = state.count[i]


@internal
def take_up(state, block, kept, counts):
    """Go on with a row that was put away; returns its widest margin."""
    for i in range(block.shape[0]):
        block[i] = kept[i]
    for i in range(state.count.shape[0]):
        state.count[i] = counts[i]
    return kept[block.shape[0]]


@inlined
def still_open(dyn, passed, y, since, count, unmet):
    """Bits of thresholds ``passed`` (k, 4) that outputs ``since`` to ``count`` (left out) of y leave unmet."""
    for at in range(since, count):
        if unmet == 0:
            break
        for k in range(passed.shape[0]):
            value = observe(dyn, y[at], int(passed[k, 0]), int(passed[k, 1]))
            if (value < passed[k, 2]) if passed[k, 3] > 0.0 else (value > passed[k, 2]):
                unmet &= ~(1 << k)
    return unmet


@internal
def _begin_or_take_up(dyn, scratch, state, numbers, course, target, r, is_underway):
    """Stand at the begin of row r, or where it was put away; returns its largest margin so far."""
    if is_underway:
        return take_up(state, numbers.block, target.kept[r], target.counts[r])
    begin_row(numbers, r)
    for i in range(state.count.shape[0]):
        state.count[i] = 0
    if course.near > 0.0:
        derivative(dyn, scratch, state.clock[TIME], state.y, scratch.stages[0], scratch.multipliers)
        return scratch.report[0]
    return 0.0


@threaded
def run_rows(dyn, scratch, state, settings, contacts, genevas, numbers, course, target, rows):
    """Simulate R rows of a run, which stands in ``numbers.block`` (SingleRun.parts); ``rows``: Outputs (outputs.py).

    Rows whose status is WAITING begin, those UNDERWAY go on. With lam (R, 0, m) neither multipliers nor accelerations
    are found. Where an event of the user ends a row, ``over`` tells when, and the outputs behind are that moment.
    """
    block = numbers.block
    t = rows.t
    status = rows.status
    before = course.before
    after = course.after
    stop = course.stop
    upto = target.upto
    passed = target.passed
    kept = target.kept
    end = t[t.shape[0] - 1]
    whole = upto == t.shape[0]
    steps = course.at_once
    repeating = contacts.repeated.place.shape[0] > 0
    meeting = (
        contacts.place.shape[0] > 0
        or contacts.wheels.markers.shape[0] > 0
        or contacts.curves.place.shape[0] > 0
        or contacts.events.table.shape[0] > 0
    )
    for r in range(status.shape[0]):
        if status[r] != WAITING and status[r] != UNDERWAY:
            continue
        if stop[0] != 0:
            status[r] = STOPPED
            continue
        out = Output(t, rows.y[r], rows.a[r], rows.lam[r], rows.work[r], rows.margin[r])
        ended = PAUSED
        widest = _begin_or_take_up(dyn, scratch, state, numbers, course, target, r, status[r] == UNDERWAY)
        since = state.clock[TIME]
        counted = state.count[ACCEPTED]
        unmet = (1 << passed.shape[0]) - 1
        while ended == PAUSED and stop[0] == 0 and state.count[ACCEPTED] < course.most:
            gone = state.count[ACCEPTED] - counted
            if gone >= LOOKED_AT:  # at this pace it would take more than is allowed
                if (end - state.clock[TIME]) * gone > course.most * (state.clock[TIME] - since):
                    break
                since = state.clock[TIME]
                counted = state.count[ACCEPTED]
            if not whole and state.count[NEXT] >= upto:
                break
            written = state.count[NEXT]
            if meeting:
                ended = go_on(dyn, scratch, state, settings, contacts, out, end, steps, before, after)
            elif repeating:
                rows_held = contacts.repeated
                ended = again(dyn, scratch, state, out, settings, rows_held, end, steps, before, after, course.method)
            elif genevas.body.shape[0] > 0:
                ended = index(dyn, scratch, state, out, settings, genevas, end, steps, before, after)
            else:
                ended = advance_past_jumps(
                    dyn, scratch, state, out, settings, end, steps, before, after, course.method
                )  # fmt: skip
            if repeating and opens(dyn, scratch, contacts.repeated, out, written, state.count[NEXT]):
                ended = NOT_SOLVED
            if course.near > 0.0 and ended != REACHED:
                widest = max(widest, scratch.report[0])
                if not scratch.report[0] > course.near * widest:
                    ended = NEARLY_SINGULAR
            if passed.shape[0] > 0 and ended == PAUSED:
                unmet = still_open(dyn, passed, out.y, written, state.count[NEXT], unmet)
                if unmet == 0 and state.count[NEXT] >= target.least:
                    ended = KNOWN
        if ended == OVER:
            ended = REACHED
            rows.over[r] = state.clock[TIME]
        for e in range(rows.released.shape[1]):
            rows.released[r, e] = contacts.events.gone[e]
        status[r] = STOPPED if stop[0] != 0 else ended
        if status[r] == KNOWN:
            put_away(state, block, widest, kept[r], target.counts[r])
        elif not whole and status[r] == PAUSED and state.count[NEXT] >= upto:
            put_away(state, block, widest, kept[r], target.counts[r])
            status[r] = UNDERWAY
        rows.steps[r] = state.count[ACCEPTED]


@threaded
def tabulate_reactions(dyn, scratch, numbers, out, rows, jacobians, known):
    """Fill ``rows`` (k,) of J into compact jacobians (R, T, k, 6) of outputs ``out`` that were REACHED.

    Dynamics and its scratch stand in ``numbers.block``. Unless ``known``, fill out.lam and out.margin, too.
    """
    t = out.t
    for r in range(out.status.shape[0]):
        if out.status[r] != REACHED:
            continue
        begin_row(numbers, r)
        for k in range(t.shape[0]):
            if not known:
                now = min(t[k], out.over[r])
                derivative(dyn, scratch, now, out.y[r, k], scratch.stages[0], out.lam[r, k])
                out.margin[r, k] = scratch.report[0]
            if rows.shape[0] == 0:
                continue
            position(dyn.system, out.y[r, k, 0], scratch.drive, scratch.ws)
            for i in range(rows.shape[0]):
                for c in range(6):
                    jacobians[r, k, i, c] = scratch.ws.jac[rows[i], c]
