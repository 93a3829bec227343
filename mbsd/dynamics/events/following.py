"""Steps while wheels or outlines may run into each other, and points follow curves that cross themselves.

A step takes two centres at most half their way to each other, and a foot no farther than its curve allows; where wheels
meet, the run ends and driver.py names them. A step moves outlines on each other by no more than their gap and a part of
their size, so that neither goes through the other unseen, however thin or fast it is.
"""

from __future__ import annotations

import math

from mbsd.compiling.callback import call
from mbsd.compiling.jit import internal, lazy
from mbsd.dynamics.events.arrays import HALF, LAST_STEP, METHOD, ROW, SHORTEST, TRYING
from mbsd.dynamics.formulation import measure_gaps
from mbsd.dynamics.integrators.advance import advance_past_jumps, copy_state
from mbsd.dynamics.state import ACCEPTED, PAUSED, REACHED, STEP_TOO_SMALL, TIME
from mbsd.equations.relative.curve_pieces import CLOSED, FARTHEST, SPAN, U, X, Y, find_foot
from mbsd.equations.system import LAST


@internal
def _line(system, y, i, j):
    """Return the vector (m) from marker i to marker j in the world at y (2, 3 nb), and its rate (m/s)."""
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
    """Return how far centres approached each other in a step of h (s) between two y, over what is allowed."""
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
    """Return True if the centres of two wheels have met at y (2, 3 nb)."""
    met = False
    for k in range(wheels.markers.shape[0]):
        x0, x1, _, _ = _line(system, y, wheels.markers[k, 0], wheels.markers[k, 1])
        met = met or math.sqrt(x0 * x0 + x1 * x1) < wheels.near[k]
    return met


@internal
def _find_feet(system, ws, curves, q):
    """Fill curves.feet at q (3 nb,); returns the farthest that one of them goes, as part of how far it may."""
    most = 0.0
    for k in range(curves.place.shape[0]):
        i = curves.place[k, 1]
        j = curves.place[k, 2]
        relative = ws.relative[curves.place[k, 0]]
        numbers = curves.numbers[curves.place[k, 3] :]
        b = 3 * system.marker_body[i]
        d = 3 * system.marker_body[j]
        c = math.cos(q[b + 2])
        s = math.sin(q[b + 2])
        e = math.cos(q[d + 2])
        f = math.sin(q[d + 2])
        px = q[b] + (c * system.marker_arm[i, 0] - s * system.marker_arm[i, 1])
        py = q[b + 1] + (s * system.marker_arm[i, 0] + c * system.marker_arm[i, 1])
        dx = q[d] + (e * system.marker_arm[j, 0] - f * system.marker_arm[j, 1]) - px
        dy = q[d + 1] + (f * system.marker_arm[j, 0] + e * system.marker_arm[j, 1]) - py
        ux = c * system.marker_axis[i, 0] - s * system.marker_axis[i, 1]
        uy = s * system.marker_axis[i, 0] + c * system.marker_axis[i, 1]
        relative[X] = ux * dx + uy * dy
        relative[Y] = ux * dy - uy * dx
        find_foot(numbers, relative)
        curves.feet[k] = relative[U]
        way = abs(curves.feet[k] - relative[LAST])
        if numbers[CLOSED] != 0.0:
            way = min(way, abs(numbers[SPAN] - way))
        most = max(most, way / numbers[FARTHEST])
    return most


@internal
def _circle_at(y, b, x, z):
    """Return the place of a point (x, z) of body b's axes in the world at y (2, 3 nb)."""
    c = math.cos(y[0, b + 2])
    s = math.sin(y[0, b + 2])
    return y[0, b] + c * x - s * z, y[0, b + 1] + s * x + c * z


@internal
def _travel(y, i, j, swept, apart):
    """Return the speed (m/s) at y (2, 3 nb) with which places of the outline of body j move on body i at most."""
    ax = y[0, j] - y[0, i]
    ay = y[0, j + 1] - y[0, i + 1]
    vx = y[1, j] - y[1, i] + y[1, i + 2] * ay
    vy = y[1, j + 1] - y[1, i + 1] - y[1, i + 2] * ax
    around = math.sqrt(swept[3] * swept[3] + swept[4] * swept[4]) + swept[5]
    if not around < math.inf:
        around = apart + math.sqrt(swept[0] * swept[0] + swept[1] * swept[1]) + swept[2]
    return math.sqrt(vx * vx + vy * vy) + abs(y[1, j + 2] - y[1, i + 2]) * around


@internal
def _sweep(dyn, scratch, contacts, before, after, h):
    """Return how deep a step of h (s) between two y may take outlines into each other, over what is allowed.

    Circles around outlines that stay apart say enough; else the gaps do at the begin of the step.
    """
    most = 0.0
    measured = False
    for p in range(contacts.swept_place.shape[0]):
        i = 3 * contacts.swept_place[p, 0]
        j = 3 * contacts.swept_place[p, 1]
        swept = contacts.swept[p]
        ix, iy = _circle_at(before, i, swept[0], swept[1])
        jx, jy = _circle_at(before, j, swept[3], swept[4])
        apart = math.sqrt((jx - ix) ** 2 + (jy - iy) ** 2)
        way = h * max(_travel(before, i, j, swept, apart), _travel(after, i, j, swept, apart))
        if way <= max(apart - swept[2] - swept[5], 0.0) + swept[6]:
            continue
        if not measured:
            measure_gaps(dyn, scratch, 0.0, before[0])
            measured = True
        least = math.inf
        for o in range(contacts.swept_place[p, 2], contacts.swept_place[p, 3]):
            least = min(least, scratch.ws.phi[contacts.place[contacts.outlines[o, 0], ROW]])
        most = max(most, way / (max(least, 0.0) + swept[6]))
    return most


@internal
def _advance(dyn, scratch, state, contacts, stepping, end, steps):
    """Call ``advance_past_jumps`` with the integrator of the run."""
    method = int(contacts.clock[METHOD])
    return advance_past_jumps(
        dyn, scratch, state, stepping.out, stepping.settings, end, steps, stepping.before, stepping.after, method
    )


@lazy(int)
def _step_by_step(dyn, scratch, state, contacts, stepping, end, steps):
    wheels = contacts.wheels
    curves = contacts.curves
    kept = wheels.before
    while True:
        copy_state(kept, state)
        target = end
        while True:
            status = _advance(dyn, scratch, state, contacts, stepping, target, 1)
            if status != REACHED and status != PAUSED:
                return status
            taken = state.clock[TIME] - kept.clock[TIME]
            farthest = _approach(dyn.system, wheels, kept.y, state.y, taken)
            farthest = max(farthest, _find_feet(dyn.system, scratch.ws, curves, state.y[0]))
            if contacts.swept_place.shape[0] > 0:
                farthest = max(farthest, _sweep(dyn, scratch, contacts, kept.y, state.y, taken))
            if farthest <= 1.0 or taken <= wheels.bounds[SHORTEST] * stepping.settings.longest:
                break
            copy_state(state, kept)
            target = kept.clock[TIME] + taken / (2.0 * farthest)
        for k in range(curves.place.shape[0]):
            scratch.ws.relative[curves.place[k, 0], LAST] = curves.feet[k]
        wheels.bounds[LAST_STEP] = taken
        if _met(dyn.system, wheels, state.y):
            return STEP_TOO_SMALL
        steps -= state.count[ACCEPTED] - kept.count[ACCEPTED]
        if state.clock[TIME] >= end:
            return REACHED
        if steps <= 0:
            return PAUSED


@lazy(int)
def _advance_outside(contacts, end, steps):
    """Advance by an integrator in Python."""
    outside = contacts.outside
    outside.asked[0] = steps
    outside.asked[1] = contacts.clock[TRYING]
    call(outside.address[0], end, outside.asked, outside.answer)  # pyright: ignore[reportCallIssue]
    return int(outside.answer[0])


@internal
def advance_to(dyn, scratch, state, contacts, stepping, end, steps):
    """Advance to ``end`` (s), a step at a time where wheels may meet or points follow curves; returns a status."""
    if contacts.clock[METHOD] < 0.0:
        return _advance_outside(contacts, end, steps)
    watched = contacts.wheels.markers.shape[0] + contacts.curves.place.shape[0] + contacts.swept_place.shape[0]
    if watched > 0:
        return _step_by_step(dyn, scratch, state, contacts, stepping, end, steps)
    return _advance(dyn, scratch, state, contacts, stepping, end, steps)
