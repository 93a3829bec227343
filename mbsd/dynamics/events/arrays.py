"""Rows of J that events switch, as arrays that the compiled loop reads and overwrites; empty where there are none.

A row is the gap of a contact, its way if it has friction, the angle of a one-way clutch, or the way of a joint that
sticks.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from mbsd.dynamics.reference.sliding import Sliding
from mbsd.dynamics.repeated_rows import Repeated

ROW, BLOCK, SIDE, KIND, RELATIVE, FRICTION = range(6)
"""Columns of Contacts.place: the row in J, its block and its place there in Schur.rows; GAP, CLUTCH, WAY or SLIDE; its
row in Workspace.relative; the joint's row in Loads.friction, -1 of what is no joint that sticks."""
GAP, CLUTCH, WAY, SLIDE = range(4)
NEAR, REST, SETTLE, RESTITUTION, SCALE, CLOSED, HELD, SIGN, RELEASED = range(9)
"""Columns of Contacts.number: gap (rate of a clutch, way or slide) and rate that count as zero, slowest rebound,
coefficient of restitution, what makes the gap dimensionless; whether it is closed (way, slide: sticks) now, and whether
its row holds; direction in which a way or slide goes, 0 where it does not; whether an event released the joint."""
ARGUMENTS = {"restitution": RESTITUTION}
"""Columns of Contacts.number by the arguments of contacts."""
VALUE, RATE, NORMAL, GIVEN, FREE, ALONE, PUSH, SHIFT = range(8)
"""Rows of Contacts.vector."""
SKIPPED, TOUCHING, STAYING, TAKING, KEPT, RESTING, STRUCK = range(7)
"""Rows of Contacts.chosen; STRUCK: how often a gap was struck in an impact without rebound."""
(
    BEGUN, WHEN, AT_ONCE, MET, LOAD, START, LENGTH, WHERE, BEYOND, FAILURE, SHARING, PENDING, ACTED, PAUSES, LOGGED,
    ENERGY, WHICH, METHOD, TRYING, DIVIDES,
) = range(20)  # fmt: skip
"""Entries of Contacts.clock: NOT_BEGUN, BEGUN_NOW or RESUMED; time of the last event (s), events at that time, events
so far; the largest load; the step's start and length (s); where in it something was met, and a part where it is beyond;
the status with which a step to some time within it failed; whether what is at rest shares its forces: APART, JOINTS
among themselves, or joints and contacts TOGETHER; 1 + the row or event that is to happen at the state, 0 where none is;
1 once a Python action has changed the state there; NEVER, AFTER or BEFORE_AND_AFTER, when the loop returns at events;
rows of Contacts.log in use; kinetic energy (J) that the last impacts added; 1 + the row or event that happened last, 0
where it passed zero the other way; the number of the integrator, OUTSIDE for one in Python; 1 while a step to some time
is tried; 1 where what is at rest may always share its forces: with friction of joints, or of contacts that lose some
once they slide."""
NOT_BEGUN, BEGUN_NOW, RESUMED = 0.0, 1.0, 2.0
NEVER, AFTER, BEFORE_AND_AFTER = 0.0, 1.0, 2.0
OUTSIDE = -1.0
APART, JOINTS, TOGETHER = 0.0, 1.0, 2.0
PARTS = np.array([0.0, 0.2, 0.4, 0.6, 0.8, 1.0])
"""Parts of a step at which gaps and normal forces are looked at."""
MOST_LOOKS = 80
KINETIC, STATIC, FORCED, BROKEN, GUESS, NEXT_SIGN, BESIDE, HOLDING = range(8)
"""Columns of Friction.number: coefficients while it slides and while it sticks; the direction in which what was met
lets it leave its place, 0 where it came to rest, NO_SIGN else; the same once static friction has broken; that in which
it is taken to slide, and what comes out; friction that may act beside that of the normal force; STATIC, or a hair less
where all that is at rest has come to its limit."""
FRICTION_ARGUMENTS = {"friction": KINETIC, "static_friction": STATIC}
"""Columns of Friction.number by the arguments of contacts."""
NO_SIGN = 2.0


class Friction(NamedTuple):
    """f contacts with friction; their ways are the f rows of Contacts behind the gaps."""

    gap: Any
    """(f,) int, the row of Contacts that is its gap."""
    number: Any
    """(f, 8)"""
    compliance: Any
    """(c, c) of rows of Contacts, where contacts that slide push with their friction; scratch of sharing, too;
    empty without any friction."""
    order: Any
    """(c,) int, rows of Contacts in the order of the search: each contact's gap, then its way; joints last."""
    none: Sliding
    """No contact with friction, as while all are open."""


HALF, SHORTEST, LAST_STEP = range(3)
"""Entries of Wheels.bounds: the part of their way to each other that centres may go in a step, the part of the longest
step below which no step is divided, and the last step (s)."""


class Wheels(NamedTuple):
    """Pairs of wheels that may run into each other; see kinematics/limits/free_wheels.py."""

    markers: Any
    """(k, 2) int, at their centres."""
    near: Any
    """(k,) distance below which the centres have met (m)."""
    bounds: Any
    """(3,)"""
    before: Any
    """mbsd.dynamics.state.State: where a step began."""


class Curves(NamedTuple):
    """Points on curves that cross themselves or their continuations; see arrays/curve_branches.py."""

    place: Any
    """(k, 4) int: the row in Workspace.relative, markers i and j, and where its numbers begin."""
    numbers: Any
    """Those of their equations."""
    feet: Any
    """(k,) parameters of feet after a step."""


LIMIT, FORCE, UNSHARED, SHARED, LEFT, GIVES = range(6)
"""Rows of Sticks.vector: limits of friction; normal forces and friction; friction before it is shared, and after;
accelerations that friction leaves, and friction that would hold joints alone; signs of ways that give way, and 1 of
gaps that push then (sticking/deciding.py)."""
NO_AGREEMENT = 20.0
"""Value of FAILURE where normal forces of joints and the friction that they cause do not agree."""
NOW, LAST, FOUND, BASIS = range(4)
"""Rows of Sticks.normal: normal forces used now, their last error, those that the multipliers give, those of the motion
where joints slide beside others at rest."""


class Sticks(NamedTuple):
    """Arrays of f joints with friction, for c rows; contacts that lose friction once they slide
    share with others, too. No rows where there is none of them."""

    joint: Any
    """(k,) int, rows of Contacts that are ways of joints that stick: the last k."""
    vector: Any
    """(6, c)"""
    normal: Any
    """(4, f)"""
    borne: Any
    """(c, m) multipliers of joints and drivers by a unit impulse of each row."""
    lam: Any
    """(2, m)"""
    load: Any
    """(2, 3 nb) without and with friction of joints."""
    beside: Any
    """(f, 3 nb) accelerations by the friction of each joint that slides, under a unit normal force."""
    beside_lam: Any
    """(f, m) multipliers of joints and drivers by it."""
    change: Any
    """(c, f) what it changes of forces of rows that hold."""
    division: Any
    """mbsd.dynamics.events.laws.division.Division, of c rows."""
    together: Any
    """mbsd.dynamics.events.laws.least_part.Together, of c rows."""


class Stepping(NamedTuple):
    """Inputs of a step beside the state: tolerances, outputs, and the times of jumps."""

    settings: Any
    """mbsd.dynamics.state.Settings"""
    out: Any
    """mbsd.dynamics.state.Output"""
    before: Any
    """(j,) times (s) right before loads or laws jump, rising."""
    after: Any
    """(j,) times right after."""


class Outside(NamedTuple):
    """An integrator in Python, which the loop calls where METHOD is OUTSIDE."""

    address: Any
    """(1,) int"""
    asked: Any
    """(2,) steps at most, and TRYING."""
    answer: Any
    """(1,) status."""


class Contacts(NamedTuple):
    """c rows: gaps of contacts and clutches, ways of contacts with friction, then ways of joints that stick."""

    place: Any
    """(c, 6) int"""
    number: Any
    """(c, 9)"""
    clock: Any
    """(20,)"""
    before: Any
    """mbsd.dynamics.state.State: where the step began."""
    trial: Any
    """The same, somewhere within it."""
    quintic: Any
    """(6, 3 nb) of the step; see guards.py."""
    pose: Any
    """(2, 3 nb) coordinates and velocities on it."""
    rates: Any
    """(2, 3 nb) their derivative."""
    lam: Any
    """(m,)"""
    force: Any
    """(3 nb,)"""
    parts: Any
    """(6,) PARTS."""
    samples: Any
    """(c, 6) guards along a step, at PARTS; see guards.py."""
    answer: Any
    """(c, 3 nb) change of velocities by a unit impulse along each row."""
    compliance: Any
    """(c, c)"""
    factor: Any
    """(c, c) Cholesky factor of some of it."""
    tableau: Any
    """(n, 2 n + 2) of Lemke's method; n: gaps, and three times the ways."""
    vector: Any
    """(8, c)"""
    intervals: Any
    """(MOST_LOOKS + 2, 6) that are still to be looked at for a dip."""
    chosen: Any
    """(7, c) int, flags of rows."""
    schur: Any
    """mbsd.dynamics.reference.schur.Schur without the rows of contacts, while all are open."""
    special: Any
    """Constraints of relative pose that are no contacts."""
    basis: Any
    """(2, n) int: of the tableau, and the rows of J that its first rows are of."""
    sticks: Any
    """Sticks; empty without friction of joints."""
    friction: Friction
    """The contacts with friction."""
    wheels: Wheels
    curves: Curves
    events: Any
    """mbsd.dynamics.events.users.Events, of the user; e-th of them is met as row c + e."""
    repeated: Repeated
    """Rows of joints that repeat others."""
    log: Any
    """(n, 2) gap and impulse (N s, N m s) of each impact of the last event, in order; no rows where none is kept."""
    outside: Outside
    outlines: Any
    """(o, 4) int, rows of outlines; see outlines.py."""
    pairs: Any
    """(o,) scratch: codes of their pairs."""
    swept_place: Any
    """(p, 4) int, pairs of outlines; see following.py."""
    swept: Any
    """(p, 7)"""
