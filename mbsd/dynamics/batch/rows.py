"""The compiled loop over simulations: each from its numbers to its last output, by the steps of a single one.

Between steps it does what Python does for a single simulation (prepare/stops.py, runs/): it ends steps where loads or
laws jump, meets events (events/loop.py), and goes on after. What it cannot go on with it leaves to Python, by the
status of the row. A second loop finds multipliers and Jacobians of states that are known.
"""

from __future__ import annotations

from mbsd.compiling.jit import internal, threaded
from mbsd.dynamics.events.loop import NOT_SOLVED, OVER, go_on
from mbsd.dynamics.genevas.steps import index
from mbsd.dynamics.integrators.advance import through
from mbsd.dynamics.integrators.formulation import derivative
from mbsd.dynamics.repeated_rows.exchange import again, opens
from mbsd.dynamics.state import ACCEPTED, NEXT, PAUSED, REACHED, TIME, Output
from mbsd.equations.assembly import position

STOPPED, NEARLY_SINGULAR = -1, -3
"""Status of rows that were not computed because all was stopped, and of those that came near a singular pose."""
WAITING, UNDERWAY, KNOWN = -5, -6, -12
"""Status of rows that have not begun, of those that wait to be gone on with, and of those of which all is known."""

LOOKED_AT = 4000
"""Steps between two looks at the pace."""


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


@internal
def still_open(passed, y, since, count, unmet):
    """Bits of thresholds ``passed`` (k, 4) that outputs ``since`` to ``count`` (left out) of y leave unmet."""
    for at in range(since, count):
        if unmet == 0:
            break
        for k in range(passed.shape[0]):
            value = y[at, int(passed[k, 0]), int(passed[k, 1])]
            if (value < passed[k, 2]) if passed[k, 3] > 0.0 else (value > passed[k, 2]):
                unmet &= ~(1 << k)
    return unmet


@threaded
def run_rows(
    dyn, scratch, state, settings, contacts, genevas, method, block, fresh, place, value, t, before, after, at_once,
    most, near, stop, upto, passed, least, kept, counts, y, a, lam, work, margin, status, steps, over, released,
):  # fmt: skip
    """Simulate R rows; outputs y (R, T, 2, 3 nb), a (R, T, 3 nb), lam, work and margin as those of Output by rows.

    With lam (R, 0, m) neither multipliers nor accelerations are found. ``method`` is the number of the integrator
    (advance.py). All arrays of numbers of the arguments before it stand in ``block`` (N,). Row r begins with row r of
    ``fresh`` (R or 1, N) there, with ``value`` (R, k) at ``place`` (k,). Steps end at ``before`` (s) and go on from
    ``after``. ``at_once`` steps are taken between two looks at ``stop`` (1,), ``most`` altogether. Where ``near`` is
    above 0, a row ends where its margin falls below this part of the largest so far (runs/motion.py). Rows whose
    status (R,) is WAITING begin, those UNDERWAY go on. With ``upto`` outputs, less than T, they are put away in
    ``kept`` (R, N + 1) and ``counts`` and are UNDERWAY. Each row of ``passed`` (k, 4) is the part of the state, the
    coordinate, a value and whether (1) outputs are to come below it, not above; where each was met by some output and
    at least ``least`` of these are made, a row is put away in the same way and is KNOWN. ``over`` (R,) is when (s) an
    event of the user ended a row, infinite where none did; the outputs behind are then that moment. ``released`` (R, e)
    is when (s) each of them released its joints, infinite where it did not.
    """
    end = t[t.shape[0] - 1]
    whole = upto == t.shape[0]
    repeating = contacts.repeated.place.shape[0] > 0
    for r in range(y.shape[0]):
        if status[r] != WAITING and status[r] != UNDERWAY:
            continue
        if stop[0] != 0:
            status[r] = STOPPED
            continue
        out = Output(t, y[r], a[r], lam[r], work[r], margin[r])
        ended = PAUSED
        widest = 0.0
        if status[r] == UNDERWAY:
            widest = take_up(state, block, kept[r], counts[r])
        else:
            own = min(r, fresh.shape[0] - 1)
            for i in range(block.shape[0]):
                block[i] = fresh[own, i]
            for i in range(place.shape[0]):
                block[place[i]] = value[r, i]
            for i in range(state.count.shape[0]):
                state.count[i] = 0
            if near > 0.0:
                derivative(dyn, scratch, state.clock[TIME], state.y, scratch.stages[0], scratch.multipliers)
                widest = scratch.report[0]
        since = state.clock[TIME]
        counted = state.count[ACCEPTED]
        unmet = (1 << passed.shape[0]) - 1
        while ended == PAUSED and stop[0] == 0 and state.count[ACCEPTED] < most:
            gone = state.count[ACCEPTED] - counted
            if gone >= LOOKED_AT:  # at this pace it would take more than is allowed
                if (end - state.clock[TIME]) * gone > most * (state.clock[TIME] - since):
                    break
                since = state.clock[TIME]
                counted = state.count[ACCEPTED]
            if not whole and state.count[NEXT] >= upto:
                break
            written = state.count[NEXT]
            if (
                contacts.place.shape[0] > 0
                or contacts.wheels.markers.shape[0] > 0
                or contacts.curves.place.shape[0] > 0
                or contacts.events.table.shape[0] > 0
            ):
                ended = go_on(dyn, scratch, state, settings, contacts, out, end, at_once, before, after)
            elif repeating:
                ended = again(
                    dyn, scratch, state, out, settings, contacts.repeated, end, at_once, before, after, method
                )
            elif genevas.body.shape[0] > 0:
                ended = index(dyn, scratch, state, out, settings, genevas, end, at_once, before, after)
            else:
                ended = through(dyn, scratch, state, out, settings, end, at_once, before, after, method)
            if repeating and opens(dyn, scratch, contacts.repeated, out, written, state.count[NEXT]):
                ended = NOT_SOLVED
            if near > 0.0 and ended != REACHED:
                widest = max(widest, scratch.report[0])
                if not scratch.report[0] > near * widest:
                    ended = NEARLY_SINGULAR
            if passed.shape[0] > 0 and ended == PAUSED:
                unmet = still_open(passed, out.y, written, state.count[NEXT], unmet)
                if unmet == 0 and state.count[NEXT] >= least:
                    ended = KNOWN
        if ended == OVER:
            ended = REACHED
            over[r] = state.clock[TIME]
        for e in range(released.shape[1]):
            released[r, e] = contacts.events.gone[e]
        status[r] = STOPPED if stop[0] != 0 else ended
        if status[r] == KNOWN:
            put_away(state, block, widest, kept[r], counts[r])
        elif not whole and status[r] == PAUSED and state.count[NEXT] >= upto:
            put_away(state, block, widest, kept[r], counts[r])
            status[r] = UNDERWAY
        steps[r] = state.count[ACCEPTED]


@threaded
def tabulate_reactions(
    dyn, scratch, block, fresh, place, value, t, over, y, status, rows, jacobians, lam, margin, known
):
    """Fill ``rows`` (k,) of J into compact jacobians (R, T, k, 6) and, unless ``known``, lam (R, T, m), margin (R, T).

    States are y (R, T, 2, 3 nb), at t (T,) (s) or, where that is earlier, at ``over`` (R,).

    Rows of ``block``, ``fresh``, ``place`` and ``value`` are those of run_rows, for Dynamics and its scratch alone.
    """
    for r in range(y.shape[0]):
        if status[r] != REACHED:
            continue
        own = min(r, fresh.shape[0] - 1)
        for i in range(block.shape[0]):
            block[i] = fresh[own, i]
        for i in range(place.shape[0]):
            block[place[i]] = value[r, i]
        for k in range(t.shape[0]):
            if not known:
                derivative(dyn, scratch, min(t[k], over[r]), y[r, k], scratch.stages[0], lam[r, k])
                margin[r, k] = scratch.report[0]
            if rows.shape[0] == 0:
                continue
            position(dyn.system, y[r, k, 0], scratch.drive, scratch.ws)
            for i in range(rows.shape[0]):
                for c in range(6):
                    jacobians[r, k, i, c] = scratch.ws.jac[rows[i], c]
